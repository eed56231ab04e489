/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/fixture.h"

#include "study/sweep_section.h"

static const cp_vehicle_model_row MODELS[2] = {{.name = "car", .hash = "aa", .yaml = "name: car"},
                                               {.name = "van", .hash = "bb", .yaml = "name: van"}};

static cp_status load_with(const fixture *f, const char *sweep, cp_study *study, cp_error *error)
{
    char *text = malloc(sizeof GOOD_STUDY + strlen(sweep));
    assert_non_null(text);
    sprintf(text, "%s%s", GOOD_STUDY, sweep);
    write_text(f, "study.yaml", text);
    free(text);
    return cp_study_load(f->study, study, error);
}

static double parameter_of(const cp_control_settings *settings, const char *name)
{
    for (size_t k = 0; k < settings->type->parameter_count; k++)
        if (strcmp(settings->type->parameters[k].name, name) == 0)
            return settings->parameter[k];
    fail_msg("no parameter %s", name);
    return 0;
}

static void every_combination_is_a_variant(void **state)
{
    static const char *const NAME[] = {"baseline",
                                       "aeb@ttc_s=0.8@deceleration_m_s2=6",
                                       "aeb@ttc_s=0.8@deceleration_m_s2=7.5",
                                       "aeb@ttc_s=0.8@deceleration_m_s2=9",
                                       "aeb@ttc_s=1.2@deceleration_m_s2=6",
                                       "aeb@ttc_s=1.2@deceleration_m_s2=7.5",
                                       "aeb@ttc_s=1.2@deceleration_m_s2=9"};
    cp_study study;
    cp_error error = {0};
    assert_ok(
        load_with(*state,
                  "sweep:\n"
                  "  - {parameter: variants.aeb.aeb.ttc_s, values: [0.8, 1.2]}\n"
                  "  - {parameter: variants.aeb.deceleration_m_s2, from: 6, to: 9, steps: 3}\n",
                  &study, &error),
        &error);
    assert_int_equal(study.variant_count, 7);
    for (size_t k = 0; k < 7; k++)
        assert_string_equal(study.variants[k].name, NAME[k]);
    assert_true(study.variants[0].is_baseline && !study.variants[1].is_baseline);
    assert_int_equal(study.variants[0].swept_count, 0);
    const cp_study_variant *fifth = &study.variants[5];
    assert_string_equal(fifth->base, "aeb");
    assert_true(parameter_of(&fifth->functions[0], "ttc_s") == 1.2);
    assert_true(parameter_of(&fifth->functions[0], "deceleration_m_s2") == 7.5);
    assert_int_equal(fifth->swept_count, 2);
    assert_string_equal(fifth->swept[1].parameter, "variants.aeb.aeb.deceleration_m_s2");
    assert_true(fifth->swept[1].value == 7.5);
    cp_study_destroy(&study);
}

static void ranges_hit_the_numbers_people_mean(void **state)
{
    cp_study study;
    cp_error error = {0};
    assert_ok(load_with(*state,
                        "sweep:\n  - {parameter: scenarios.left_turn.probability_1, from: 0.1, to: "
                        "0.5, steps: 5}\n",
                        &study, &error),
              &error);
    assert_int_equal(study.scenario_count, 5);
    assert_string_equal(study.scenarios[2].name, "left_turn@probability_1=0.3");
    assert_true(study.scenarios[2].driver_errors[0].parameter[0] == 0.3);
    cp_study_destroy(&study);
}

static void options_of_sumo_can_be_swept(void **state)
{
    cp_study study;
    cp_error error = {0};
    assert_ok(
        load_with(*state,
                  "sweep:\n"
                  "  - {parameter: scenarios.left_turn.sumo_options.scale, values: [0.5, 2]}\n"
                  "  - {parameter: scenarios.left_turn.sumo_options.--max-num-vehicles, "
                  "values: [10]}\n",
                  &study, &error),
        &error);
    assert_int_equal(study.scenario_count, 2);
    const cp_study_scenario *scenario = &study.scenarios[1];
    assert_string_equal(scenario->name, "left_turn@scale=2@max-num-vehicles=10");
    assert_int_equal(scenario->sumo_option_count, 4);
    assert_string_equal(scenario->sumo_options[0], "--scale");
    assert_string_equal(scenario->sumo_options[1], "2");
    assert_string_equal(scenario->sumo_options[2], "--max-num-vehicles");
    assert_string_equal(scenario->sumo_options[3], "10");
    assert_false(cp_study_scenarios_start_alike(&study.scenarios[0], scenario));
    assert_true(cp_study_scenarios_start_alike(scenario, scenario));
    cp_study_destroy(&study);
}

static void penetration_by_type_can_be_swept(void **state)
{
    const fixture *f = *state;
    cp_study study;
    cp_error error = {0};
    char *text = study_with("deceleration_m_s2: 7\n",
                            "deceleration_m_s2: 7\n        equipment: [{type: van, penetration_1: "
                            "1}, {type: 'big bus', penetration_1: 0}]\n");
    char sweep[4096];
    snprintf(sweep, sizeof sweep,
             "%ssweep: [{parameter: variants.aeb.aeb.equipment.van, values: [0, "
             "0.5]}]\n",
             text);
    write_text(f, "study.yaml", sweep);
    assert_ok(cp_study_load(f->study, &study, &error), &error);
    assert_int_equal(study.variant_count, 3);
    assert_string_equal(study.variants[2].name, "aeb@equipment.van=0.5");
    assert_string_equal(study.variants[2].swept[0].parameter, "variants.aeb.aeb.equipment.van");
    assert_true(study.variants[2].functions[0].shares[0].penetration_1 == 0.5);
    assert_true(study.variants[1].functions[0].shares[0].penetration_1 == 0);
    cp_study_destroy(&study);

    snprintf(sweep, sizeof sweep,
             "%ssweep: [{parameter: variants.aeb.equipment.van, values: [2]}]\n", text);
    write_text(f, "study.yaml", sweep);
    assert_int_equal(cp_study_load(f->study, &study, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "sweep[0].values[0] must be between 0 and 1, found 2"));
    snprintf(sweep, sizeof sweep,
             "%ssweep: [{parameter: variants.aeb.equipment.big bus, values: [1]}]\n", text);
    write_text(f, "study.yaml", sweep);
    assert_int_equal(cp_study_load(f->study, &study, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "names a vehicle type with other characters"));
    free(text);
}

// Paired: what differs between two values of a sweep is the parameter alone.
static void values_share_seeds_unless_independent(void **state)
{
    static const char SWEEP[] =
        "sweep:\n  - {parameter: scenarios.left_turn.probability_1, values: [0.1, 0.2]}\n";
    const fixture *f = *state;
    cp_study study, plain;
    cp_error error = {0};
    cp_plan_rows rows;
    assert_ok(cp_study_load(f->study, &plain, &error), &error);
    assert_ok(load_with(f, SWEEP, &study, &error), &error);
    for (size_t number = 0; number < 3; number++) {
        assert_int_equal(cp_plan_seed(&study, 0, 0, number), cp_plan_seed(&study, 1, 1, number));
        assert_int_equal(cp_plan_seed(&study, 0, 0, number), cp_plan_seed(&plain, 0, 0, number));
    }
    study.design = CP_DESIGN_INDEPENDENT;
    assert_int_not_equal(cp_plan_seed(&study, 0, 0, 0), cp_plan_seed(&study, 1, 0, 0));
    study.design = CP_DESIGN_PAIRED_SEEDS;

    // Rows: ids of their own, and the values to join with.
    assert_ok(cp_plan_create(&study, MODELS, 2, &rows, &error), &error);
    assert_int_equal(rows.replication_count, 12);
    for (size_t k = 0; k < 12; k++)
        for (size_t other = 0; other < k; other++) {
            assert_true(rows.replication[k].id != rows.replication[other].id);
            assert_string_not_equal(rows.replication[k].configuration_hash,
                                    rows.replication[other].configuration_hash);
        }
    assert_int_equal(rows.sweep_count, 2);
    assert_true(rows.sweep[1].of_scenario && rows.sweep[1].owner == 1);
    assert_string_equal(rows.sweep[1].parameter, "scenarios.left_turn.failed_to_see.probability_1");
    cp_plan_destroy(&rows);
    cp_study_destroy(&plain);
    cp_study_destroy(&study);
}

static void mistakes_are_named(void **state)
{
    static const struct {
        const char *entry;
        const char *says;
    } CASE[] = {
        {"{parameter: aeb.ttc_s, values: [1]}",
         "study.yaml:30: sweep[0].parameter must be variants.NAME.FUNCTION.PARAMETER"},
        {"{parameter: variants.fcw.ttc_s, values: [1]}",
         "study.yaml:30: sweep[0].parameter names no parameter of a variant of this study; they "
         "are "
         "baseline, aeb"},
        {"{parameter: variants.baseline.ttc_s, values: [1]}", "belongs to the baseline"},
        {"{parameter: variants.aeb.tcc_s, values: [1]}",
         "ends in no parameter, found 'tcc_s'; there are aeb.penetration_1, aeb.ttc_s"},
        {"{parameter: variants.aeb.ttc_s, values: [1, 1.5garbage]}",
         "sweep[0].values[1] must be a number from 0.1 to 5, found '1.5garbage'"},
        {"{parameter: variants.aeb.ttc_s, values: [1, -3]}",
         "study.yaml:30: sweep[0].values[1] must be between"},
        {"{parameter: variants.aeb.ttc_s, values: [1, 2, 1.0]}", "sweep[0].values[2] repeats 1.0"},
        {"{parameter: variants.aeb.ttc_s}", "must have either values, or from, to and steps"},
        {"{parameter: variants.aeb.ttc_s, values: [1], from: 1, to: 2, steps: 2}",
         "must have either values, or from, to and steps"},
        {"{parameter: variants.aeb.ttc_s, from: 1, to: 2}",
         "must have either values, or from, to and steps"},
        {"{parameter: variants.aeb.ttc_s, from: 1, to: 2, steps: 1}",
         "sweep[0].steps must be between 2 and 1000, found 1"},
        {"{parameter: variants.aeb.ttc_s, from: 1, to: 2, steps: 2.5}",
         "sweep[0].steps must be a whole number, found 2.5"},
        {"{parameter: variants.aeb.ttc_s, from: 1, to: 1, steps: 2}", "nothing to sweep"},
        {"{parameter: variants.aeb.ttc_s, from: 1, to: 900, steps: 2}",
         "study.yaml:30: sweep[0].to must be between"},
        {"{parameter: variants.aeb.ttc_s, values: [1]}\n  - {parameter: variants.aeb.aeb.ttc_s, "
         "values: [2]}",
         "study.yaml:31: sweep[1].parameter is swept by sweep[0] already"},
        {"{parameter: variants.aeb.ttc_s, from: 0.5, to: 2, steps: 50}\n  - {parameter: "
         "variants.aeb.deceleration_m_s2, from: 5, to: 9, steps: 50}",
         "gives aeb 2500 combinations of values; at most 1000"},
        {"{parameter: scenarios.left_turn.sumo_options.a b, values: [1]}",
         "must end in the long name of an option of SUMO, found 'a b'"},
        {"{parameter: variants.aeb.ttc_s, value: [1]}", "Unexpected key: value"},
    };
    const fixture *f = *state;
    for (size_t k = 0; k < sizeof CASE / sizeof *CASE; k++) {
        cp_study study;
        cp_error error = {0};
        char sweep[512];
        snprintf(sweep, sizeof sweep, "sweep:\n  - %s\n", CASE[k].entry);
        assert_int_equal(load_with(f, sweep, &study, &error), CP_BAD_INPUT);
        if (strstr(error.text, CASE[k].says) == NULL)
            fail_msg("'%s' does not say '%s'", error.text, CASE[k].says);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_combination_is_a_variant, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(ranges_hit_the_numbers_people_mean, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(options_of_sumo_can_be_swept, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(penetration_by_type_can_be_swept, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(values_share_seeds_unless_independent, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(mistakes_are_named, fixture_begin, fixture_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
