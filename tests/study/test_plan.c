/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/fixture.h"

static const cp_vehicle_model_row MODELS[2] = {{.name = "car", .hash = "aa", .yaml = "name: car"},
                                               {.name = "van", .hash = "bb", .yaml = "name: van"}};

static void load(const fixture *f, const char *text, cp_study *study, cp_plan_rows *rows)
{
    cp_error error = {0};
    write_text(f, "study.yaml", text);
    assert_ok(cp_study_load(f->study, study, &error), &error);
    assert_ok(cp_plan_create(study, MODELS, 2, rows, &error), &error);
}

static void unload(cp_study *study, cp_plan_rows *rows)
{
    cp_plan_destroy(rows);
    cp_study_destroy(study);
}

static const cp_replication_row *row_of(const cp_plan_rows *rows, size_t variant, size_t number)
{
    for (size_t k = 0; k < rows->replication_count; k++)
        if (rows->replication[k].variant == variant && rows->replication[k].number == number)
            return &rows->replication[k];
    fail();
    return NULL;
}

static void paired_seeds_are_shared_by_the_variants(void **state)
{
    cp_study study;
    cp_plan_rows rows;
    load(*state, GOOD_STUDY, &study, &rows);
    assert_int_equal(rows.replication_count, 6);
    for (size_t number = 0; number < 3; number++) {
        const cp_replication_row *baseline = row_of(&rows, 0, number);
        const cp_replication_row *aeb = row_of(&rows, 1, number);
        assert_int_equal(baseline->seed, aeb->seed);
        assert_true(baseline->id != aeb->id);
        assert_ptr_equal(cp_plan_find(&rows, aeb->id), aeb);
        for (size_t other = 0; other < number; other++)
            assert_int_not_equal(baseline->seed, row_of(&rows, 0, other)->seed);
    }
    unload(&study, &rows);
}

static void independent_seeds_are_not(void **state)
{
    cp_study study;
    cp_plan_rows rows;
    char *text = study_with("paired_seeds", "independent");
    load(*state, text, &study, &rows);
    free(text);
    for (size_t a = 0; a < 3; a++)
        for (size_t b = 0; b < 3; b++)
            assert_int_not_equal(row_of(&rows, 0, a)->seed, row_of(&rows, 1, b)->seed);
    unload(&study, &rows);
}

// More replications and other variants leave the seeds of those there were alone.
static void seeds_depend_on_the_study_seed_alone(void **state)
{
    cp_study study, larger, other;
    cp_plan_rows rows, larger_rows, other_rows;
    load(*state, GOOD_STUDY, &study, &rows);
    char *text = study_with("replications: 3", "replications: 50");
    load(*state, text, &larger, &larger_rows);
    free(text);
    text = study_with("20261122", "20261123");
    load(*state, text, &other, &other_rows);
    free(text);
    for (size_t number = 0; number < 3; number++) {
        assert_int_equal(row_of(&rows, 1, number)->seed, row_of(&larger_rows, 1, number)->seed);
        assert_true(row_of(&rows, 1, number)->id == row_of(&larger_rows, 1, number)->id);
        assert_string_equal(row_of(&rows, 1, number)->configuration_hash,
                            row_of(&larger_rows, 1, number)->configuration_hash);
        assert_int_not_equal(row_of(&rows, 1, number)->seed, row_of(&other_rows, 1, number)->seed);
    }
    unload(&study, &rows);
    unload(&larger, &larger_rows);
    unload(&other, &other_rows);
}

static void configuration_of(const fixture *f, const char *text, const char *file,
                             const char *content, char hash[CP_HASH_TEXT_SIZE])
{
    cp_study study;
    cp_plan_rows rows;
    if (file != NULL)
        write_text(f, file, content);
    load(f, text, &study, &rows);
    strcpy(hash, row_of(&rows, 1, 0)->configuration_hash);
    unload(&study, &rows);
}

static void configuration_hash_follows_what_matters(void **state)
{
    const fixture *f = *state;
    char before[CP_HASH_TEXT_SIZE], after[CP_HASH_TEXT_SIZE];
    static const char *const MATTERS[][2] = {{"duration_s: 900", "duration_s: 901"},
                                             {"warmup_s: 60", "warmup_s: 61"},
                                             {"ttc_s: 1.5", "ttc_s: 1.6"},
                                             {"probability_1: 0.25", "probability_1: 0.26"},
                                             {"\"0.5\"", "\"0.6\""},
                                             {"type: van", "type: truck"}};
    configuration_of(f, GOOD_STUDY, NULL, NULL, before);
    for (size_t k = 0; k < sizeof MATTERS / sizeof MATTERS[0]; k++) {
        char *text = study_with(MATTERS[k][0], MATTERS[k][1]);
        configuration_of(f, text, NULL, NULL, after);
        free(text);
        assert_string_not_equal(before, after);
    }

    // Words about the study, comments and outputs do not matter; networks and routes do.
    char *text = study_with("Does it help?", "How much?");
    configuration_of(f, text, NULL, NULL, after);
    free(text);
    assert_string_equal(before, after);
    configuration_of(f, GOOD_STUDY, "a.net.xml", "<!-- generated on Tuesday --><net/>\n", after);
    assert_string_equal(before, after);
    configuration_of(f, GOOD_STUDY, "trip.xml", "<trips>1</trips>\n", after);
    assert_string_equal(before, after);
    configuration_of(f, GOOD_STUDY, "b.rou.xml", "<routes/>\n", after);
    assert_string_not_equal(before, after);
}

static void files_of_a_scenario_are_listed(void **state)
{
    cp_study study;
    cp_plan_rows rows;
    load(*state, GOOD_STUDY, &study, &rows);
    const char *files = rows.scenario[0].files;
    assert_non_null(strstr(files, "\"a.sumocfg\":\""));
    assert_non_null(strstr(files, "\"a.net.xml\":\""));
    assert_non_null(strstr(files, "\"a.rou.xml\":\""));
    assert_non_null(strstr(files, "\"b.rou.xml\":\""));
    assert_null(strstr(files, "trip.xml"));
    assert_null(strstr(files, "missing"));
    assert_string_equal(rows.scenario[0].driver_errors,
                        "[{\"model\":\"failed_to_see\",\"parameters\":{\"probability_1\":0.25}}]");
    assert_string_equal(rows.study.vehicles, "{\"default\":\"car\",\"types\":{\"van\":\"van\"}}");
    assert_int_equal(rows.vehicle_model_count, 2);
    unload(&study, &rows);
}

static void two_cars_of_one_name_are_refused(void **state)
{
    const fixture *f = *state;
    cp_study study;
    cp_plan_rows rows;
    cp_error error = {0};
    cp_vehicle_model_row twins[2] = {MODELS[0], MODELS[0]};
    assert_ok(cp_study_load(f->study, &study, &error), &error);
    assert_ok(cp_plan_create(&study, twins, 2, &rows, &error), &error);
    assert_int_equal(rows.vehicle_model_count, 1);
    cp_plan_destroy(&rows);
    strcpy(twins[1].hash, "cc");
    assert_int_equal(cp_plan_create(&study, twins, 2, &rows, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "van.yaml"));
    cp_study_destroy(&study);
}

static void a_counterfactual_study_runs_its_baseline_only(void **state)
{
    const fixture *f = *state;
    cp_study study;
    cp_plan_rows rows;
    char before[CP_HASH_TEXT_SIZE];
    char *text = study_with("design: paired_seeds", "design: counterfactual");
    load(f, text, &study, &rows);
    assert_int_equal(rows.variant_count, 2);
    assert_int_equal(rows.replication_count, 3);
    for (size_t k = 0; k < 3; k++) {
        assert_int_equal(rows.replication[k].variant, 0);
        assert_int_equal(rows.replication[k].number, k);
    }
    strcpy(before, rows.replication[0].configuration_hash);
    unload(&study, &rows);

    // The outcome of a baseline replication depends on its treatments.
    char *place = strstr(text, "ttc_s: 1.5");
    assert_non_null(place);
    memcpy(place, "ttc_s: 1.6", 10);
    load(f, text, &study, &rows);
    assert_string_not_equal(before, rows.replication[0].configuration_hash);
    unload(&study, &rows);
    free(text);
}

// What a worker makes of the plan agrees with what the runner planned.
static void one_replication_is_planned_as_among_all(void **state)
{
    cp_study study;
    cp_plan_rows all, one;
    cp_error error = {0};
    load(*state, GOOD_STUDY, &study, &all);
    int64_t id = all.replication[3].id;
    assert_ok(cp_plan_create_for(&study, MODELS, 2, id, &one, &error), &error);
    assert_int_equal(one.replication_count, all.replication_count);
    assert_string_equal(cp_plan_find(&one, id)->configuration_hash,
                        all.replication[3].configuration_hash);
    assert_string_equal(one.replication[0].configuration_hash, "");
    cp_plan_destroy(&one);
    unload(&study, &all);
}

// One background for every way to start SUMO, whatever the errors of the drivers.
static void a_network_has_one_background(void **state)
{
    const fixture *f = *state;
    static const struct {
        const char *sweep;
        size_t scenarios, backgrounds;
    } CASE[] = {
        {"", 1, 1},
        {"sweep: [{parameter: scenarios.left_turn.failed_to_see.probability_1, values: [0.1, 0.2, "
         "0.3]}]\n",
         3, 1},
        {"sweep: [{parameter: scenarios.left_turn.sumo_options.scale, values: [0.5, 1]}, "
         "{parameter: scenarios.left_turn.failed_to_see.probability_1, values: [0.1, 0.2]}]\n",
         4, 2},
        {"background: {duration_s: 0}\n", 1, 0},
    };
    for (size_t k = 0; k < sizeof CASE / sizeof *CASE; k++) {
        cp_study study;
        cp_plan_rows rows;
        char longer[4096];
        snprintf(longer, sizeof longer, "%s%s", GOOD_STUDY, CASE[k].sweep);
        load(f, longer, &study, &rows);
        assert_int_equal(rows.scenario_count, CASE[k].scenarios);
        size_t seeds = study.background_seeds;
        assert_int_equal(rows.background_count, seeds * CASE[k].backgrounds);
        for (size_t b = 0; b < rows.background_count; b++) {
            cp_background_plan_row alone;
            cp_error error = {0};
            size_t scenario = rows.background[b].scenario;
            assert_ok(cp_plan_background(&study, scenario, b % seeds, &alone, &error), &error);
            assert_string_equal(alone.configuration_hash, rows.background[b].configuration_hash);
            assert_int_equal(alone.seed, cp_plan_seed(&study, scenario, 0, b % seeds));
            assert_true(b == 0 || strcmp(rows.background[0].configuration_hash,
                                         rows.background[b].configuration_hash) != 0);
        }
        unload(&study, &rows);
    }
}

static void hash_of_background(const fixture *f, const char *old, const char *replacement,
                               char hash[CP_HASH_TEXT_SIZE])
{
    cp_study study;
    cp_plan_rows rows;
    char *text = study_with(old, replacement);
    load(f, text, &study, &rows);
    free(text);
    strcpy(hash, rows.background[0].configuration_hash);
    unload(&study, &rows);
}

static void a_background_depends_on_its_network_alone(void **state)
{
    const fixture *f = *state;
    char plain[CP_HASH_TEXT_SIZE], other[CP_HASH_TEXT_SIZE];
    hash_of_background(f, "replications: 3", "replications: 3", plain);
    static const char *const SAME[][2] = {{"probability_1: 0.25", "probability_1: 0.5"},
                                          {"ttc_s: 1.5", "ttc_s: 1.6"},
                                          {"replications: 3", "replications: 30"},
                                          {"default: car.yaml", "default: van.yaml"}};
    for (size_t k = 0; k < sizeof SAME / sizeof *SAME; k++) {
        hash_of_background(f, SAME[k][0], SAME[k][1], other);
        assert_string_equal(other, plain);
    }
    static const char *const CHANGED[][2] = {
        {"seed: 20261122", "seed: 20261123"},
        {"warmup_s: 60", "warmup_s: 61"},
        {"warmup_s: 60", "warmup_s: 60\nbackground: {duration_s: 300}"},
        {"warmup_s: 60", "warmup_s: 60\nstep_length_s: 0.1"},
        {"warmup_s: 60", "warmup_s: 60\nafter_crash: {stay_s: 5}"},
        {"\"0.5\"", "\"0.6\""}};
    for (size_t k = 0; k < sizeof CHANGED / sizeof *CHANGED; k++) {
        hash_of_background(f, CHANGED[k][0], CHANGED[k][1], other);
        assert_string_not_equal(other, plain);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(paired_seeds_are_shared_by_the_variants, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(independent_seeds_are_not, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(seeds_depend_on_the_study_seed_alone, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(configuration_hash_follows_what_matters, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(files_of_a_scenario_are_listed, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(two_cars_of_one_name_are_refused, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(a_network_has_one_background, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(a_background_depends_on_its_network_alone, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(one_replication_is_planned_as_among_all, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(a_counterfactual_study_runs_its_baseline_only,
                                        fixture_begin, fixture_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
