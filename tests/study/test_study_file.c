/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/controls_text.h"
#include "study/fixture.h"

static void reads_everything(void **state)
{
    const fixture *f = *state;
    cp_study study;
    cp_error error = {0};
    char path[192];
    assert_ok(cp_study_load(f->study, &study, &error), &error);
    assert_string_equal(study.name, "demo");
    assert_string_equal(study.question, "Does it help?");
    assert_int_equal(study.design, CP_DESIGN_PAIRED_SEEDS);
    assert_int_equal(study.seed, 20261122);
    assert_int_equal(study.replications, 3);
    assert_true(study.duration_s == 900 && study.warmup_s == 60 && study.step_length_s == 0.05);

    assert_int_equal(study.scenario_count, 1);
    const cp_study_scenario *scenario = cp_study_find_scenario(&study, "left_turn");
    assert_ptr_equal(scenario, &study.scenarios[0]);
    snprintf(path, sizeof path, "%s/a.sumocfg", f->folder);
    assert_string_equal(scenario->sumocfg_path, path);
    assert_int_equal(scenario->sumo_option_count, 2);
    assert_string_equal(scenario->sumo_options[1], "0.5");
    assert_int_equal(scenario->driver_error_count, 1);
    assert_string_equal(scenario->driver_errors[0].type->name, "failed_to_see");
    assert_true(scenario->driver_errors[0].parameter[0] == 0.25);

    assert_int_equal(study.variant_count, 2);
    assert_true(study.variants[0].is_baseline && !study.variants[1].is_baseline);
    assert_int_equal(study.variants[0].function_count, 0);
    const cp_control_settings *aeb = &study.variants[1].functions[0];
    for (size_t k = 0; k < aeb->type->parameter_count; k++) {
        const cp_control_parameter *parameter = &aeb->type->parameters[k];
        double expected = parameter->standard;
        if (strcmp(parameter->name, "ttc_s") == 0)
            expected = 1.5;
        if (strcmp(parameter->name, "deceleration_m_s2") == 0)
            expected = 7;
        assert_true(aeb->parameter[k] == expected);
    }

    assert_true(study.stay_s == 0.0 && study.history_s == 0.0 && study.background_s == 900.0);
    assert_int_equal(study.vehicle_count, 2);
    assert_null(study.vehicles[0].type);
    assert_string_equal(study.vehicles[1].type, "van");
    cp_study_destroy(&study);
}

// Everything the study reads by key path, aliased: what is run must be what stands at the anchor.
static void aliases_stand_for_what_they_name(void **state)
{
    const fixture *f = *state;
    cp_study study;
    cp_error error = {0};
    char *text = study_with("variants:\n  - name: baseline\n    functions: []\n",
                            "  - name: again\n"
                            "    sumocfg: a.sumocfg\n"
                            "    driver_errors: &errors\n"
                            "      - model: failed_to_see\n"
                            "        parameters: &p {probability_1: &number 0.125}\n"
                            "  - {name: third, sumocfg: a.sumocfg, driver_errors: *errors}\n"
                            "variants:\n"
                            "  - {name: baseline, functions: []}\n"
                            "  - name: one\n"
                            "    functions: &functions\n"
                            "      - function: aeb\n"
                            "        parameters: &aeb {ttc_s: 4.5, deceleration_m_s2: 2}\n"
                            "        equipment: &cars [{type: car, penetration_1: 0.5}]\n"
                            "  - {name: two, functions: *functions}\n"
                            "  - name: three\n"
                            "    functions:\n"
                            "      - {function: aeb, parameters: *aeb, equipment: *cars}\n"
                            "  - name: four\n"
                            "    functions: [{function: aeb, parameters: {ttc_s: *number}}]\n");
    write_text(f, "study.yaml", text);
    free(text);
    assert_ok(cp_study_load(f->study, &study, &error), &error);
    for (size_t k = 1; k < 3; k++)
        assert_true(study.scenarios[k].driver_errors[0].parameter[0] == 0.125);
    for (size_t k = 1; k < 4; k++) {
        const cp_control_settings *aeb = &study.variants[k].functions[0];
        for (size_t p = 0; p < aeb->type->parameter_count; p++) {
            if (strcmp(aeb->type->parameters[p].name, "ttc_s") == 0)
                assert_true(aeb->parameter[p] == 4.5);
            if (strcmp(aeb->type->parameters[p].name, "deceleration_m_s2") == 0)
                assert_true(aeb->parameter[p] == 2.0);
        }
        assert_int_equal(aeb->share_count, 1);
        assert_true(aeb->shares[0].penetration_1 == 0.5);
    }
    char *said = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&said, &size);
    assert_non_null(out);
    cp_controls_text_variant(&study, 4, out);
    fclose(out);
    assert_non_null(strstr(said, "variant four: functions aeb ("));
    assert_non_null(strstr(said, "ttc_s 0.125"));
    free(said);
    cp_study_destroy(&study);
}

static void after_a_crash_and_before_it(void **state)
{
    const fixture *f = *state;
    cp_study study;
    cp_error error = {0};
    char *text =
        study_with("warmup_s: 60\n", "warmup_s: 60\nhistory_s: 4.5\nafter_crash: {stay_s: 1800}\n");
    write_text(f, "study.yaml", text);
    free(text);
    assert_ok(cp_study_load(f->study, &study, &error), &error);
    assert_true(study.stay_s == 1800.0 && study.history_s == 4.5);
    cp_study_destroy(&study);
}

static void background_has_a_length_of_its_own_or_none(void **state)
{
    const fixture *f = *state;
    static const struct {
        const char *section;
        double background_s;
        size_t seeds;
    } CASE[] = {{"background: {duration_s: 300}\n", 300.0, 3},
                {"background: {duration_s: 0}\n", 0.0, 3},
                {"background: {seeds: 7}\n", 900.0, 7},
                {"background: {duration_s: 3600, seeds: 1}\n", 3600.0, 1}};
    for (size_t k = 0; k < sizeof CASE / sizeof *CASE; k++) {
        cp_study study;
        cp_error error = {0};
        char section[128];
        snprintf(section, sizeof section, "warmup_s: 60\n%s", CASE[k].section);
        char *text = study_with("warmup_s: 60\n", section);
        write_text(f, "study.yaml", text);
        free(text);
        assert_ok(cp_study_load(f->study, &study, &error), &error);
        assert_true(study.background_s == CASE[k].background_s);
        assert_int_equal(study.background_seeds, CASE[k].seeds);
        cp_study_destroy(&study);
    }
}

static void baseline_can_be_named(void **state)
{
    const fixture *f = *state;
    cp_study study;
    cp_error error = {0};
    char *text = study_with("seed: 20261122\n", "seed: 1\nbaseline: aeb\n");
    write_text(f, "study.yaml", text);
    free(text);
    assert_ok(cp_study_load(f->study, &study, &error), &error);
    assert_true(!study.variants[0].is_baseline && study.variants[1].is_baseline);
    cp_study_destroy(&study);
}

/* What is wrong, and what the message must hold: line and key. */
static const struct {
    const char *old;
    const char *replacement;
    const char *message;
} BAD[] = {
    {"ttc_s: 1.5", "ttc_s: -1",
     "study.yaml:22: variants[1].functions[0].parameters.ttc_s must be between 0.1 and 5, found "
     "-1"},
    {"ttc_s: 1.5", "ttc_s: nan", "study.yaml:22: variants[1].functions[0].parameters.ttc_s"},
    {"ttc_s: 1.5", "ttc_s: 1.5garbage", "must be a number from 0.1 to 5, found '1.5garbage'"},
    {"ttc_s: 1.5", "ttc_s: [1, 2]", "study.yaml:22: variants[1].functions[0].parameters.ttc_s"},
    {"ttc_s: 1.5", "ttcs: 1.5", "parameters.ttcs is not a parameter of aeb; it has"},
    {"deceleration_m_s2: 7", "ttc_s: 2", "parameters.ttc_s is given twice"},
    {"parameters: {probability_1: 0.25}", "parameters: 3",
     "study.yaml:14: scenarios[0].driver_errors[0].parameters must be a mapping"},
    {"parameters: {probability_1: 0.25}", "parameters: [3]", "must be a mapping"},
    {"function: aeb", "function: abs",
     "study.yaml:20: variants[1].functions[0].function must be one of"},
    {"model: failed_to_see", "model: aeb", "study.yaml:13: scenarios[0].driver_errors[0].model"},
    {"duration_s: 900", "duration_s: 0", "study.yaml:6: duration_s must be > 0, found 0"},
    {"duration_s: 900", "duration_s: inf", "study.yaml:6: duration_s"},
    {"duration_s: 900", "duration_s: 15 min", "study.yaml:6: duration_s must be a number"},
    {"warmup_s: 60", "warmup_s: 900", "study.yaml:7: warmup_s must be less than duration_s"},
    {"warmup_s: 60", "step_length_s: 0.0125",
     "study.yaml:7: step_length_s must be whole milliseconds, as SUMO counts them, found 0.0125"},
    {"warmup_s: 60", "history_s: 61", "study.yaml:7: history_s must be between 0 and 60, found 61"},
    {"warmup_s: 60", "after_crash: {stay_s: -1}",
     "study.yaml:7: after_crash.stay_s must be between 0 and 86400, found -1"},
    {"warmup_s: 60", "after_crash: {}", "Missing required mapping field: stay_s"},
    {"warmup_s: 60", "after_crash: {stays_s: 1}", "Unexpected key: stays_s"},
    {"warmup_s: 60", "warmup_s: 60\nbackground: {duration_s: 60}",
     "study.yaml:8: background.duration_s must be 0 (none) or more than warmup_s, found 60"},
    {"warmup_s: 60", "background: {seeds: 0}", "study.yaml:7: background.seeds must be"},
    {"warmup_s: 60", "background: {duration_s: -1}",
     "study.yaml:7: background.duration_s must be between 0 and 1e+06, found -1"},
    {"warmup_s: 60", "background: {}",
     "study.yaml:7: background must have duration_s or seeds, found neither"},
    {"replications: 3", "replications: 2.5", "study.yaml:5: replications must be a whole number"},
    {"replications: 3", "replications: 0", "study.yaml:5: replications"},
    {"seed: 20261122", "seed: -1", "study.yaml:4: seed"},
    {"design: paired_seeds", "design: crossover",
     "study.yaml:3: design must be paired_seeds, independent or counterfactual, found 'crossover'"},
    {"name: left_turn", "name: left turn", "study.yaml:9: scenarios[0].name must be"},
    {"- name: aeb", "- name: baseline", "study.yaml:18: variants[1].name 'baseline' is taken"},
    {"sumocfg: a.sumocfg", "sumocfg: b.sumocfg",
     "study.yaml:10: scenarios[0].sumocfg must be a readable file, found 'b.sumocfg'"},
    {"default: car.yaml", "default: lorry.yaml",
     "study.yaml:25: vehicles.default must be a readable file"},
    {"seed: 20261122", "seed: 1\nbaseline: none", "study.yaml:5: baseline must be the name of"},
    {"      - function: aeb\n",
     "      - function: aeb\n        equipment: [{type: van, penetration_1: 1.5}]\n",
     "variants[1].functions[0].equipment[0].penetration_1 must be between 0 and 1, found 1.5"},
    {"      - function: aeb\n",
     "      - function: aeb\n        equipment:\n"
     "          - {type: van, penetration_1: 1}\n          - {type: van, penetration_1: 0}\n",
     "study.yaml:23: variants[1].functions[0].equipment[1].type repeats 'van'"},
    {"design: paired_seeds", "design: paired_seeds\ncounterfactual: {checkpoints: 4}",
     "study.yaml:4: counterfactual belongs to the design counterfactual, found the design "
     "paired_seeds"},
    {"design: paired_seeds", "design: counterfactual\ncounterfactual: {checkpoints: 0}",
     "study.yaml:4: counterfactual.checkpoints must be between 1 and 200, found 0"},
    {"design: paired_seeds", "design: counterfactual\nbaseline: aeb",
     "variants[1].functions must be empty: the baseline of a counterfactual study drives without "
     "functions, found 1"},
    {"[--scale, \"0.5\"]", "[--load-state, state.xml]",
     "study.yaml:11: scenarios[0].sumo_options load-state must not be set, found 'state.xml'"},
    {"[--scale, \"0.5\"]", "[--load-state=state.xml]",
     "scenarios[0].sumo_options load-state must not be set"},
    // Structure: libcyaml's part.
    {"warmup_s: 60", "warmup: 60", "study.yaml:7: Unexpected key: warmup"},
    {"seed: 20261122\n", "", "Missing required mapping field: seed"},
    {"warmup_s: 60", "duration_s: 60", "study.yaml:7:"},
    {"design: paired_seeds", "design: [paired_seeds", "study.yaml:"},
    {"scenarios:\n", "scenarios: []\nother:\n", "study.yaml:8:"},
};

static void counterfactual_section_and_equipment(void **state)
{
    const fixture *f = *state;
    cp_study study;
    cp_error error = {0};
    char *text = study_with("      - function: aeb\n",
                            "      - function: aeb\n"
                            "        equipment: [{type: van, penetration_1: 0.25}]\n");
    write_text(f, "study.yaml", text);
    free(text);
    assert_ok(cp_study_load(f->study, &study, &error), &error);
    const cp_control_settings *aeb = &study.variants[1].functions[0];
    assert_int_equal(aeb->share_count, 1);
    assert_string_equal(aeb->shares[0].type, "van");
    assert_true(aeb->shares[0].penetration_1 == 0.25 && aeb->parameter[0] == 1.0);
    cp_study_destroy(&study);

    text = study_with("design: paired_seeds",
                      "design: counterfactual\n"
                      "counterfactual: {checkpoint_interval_s: 4, time_series_s: 5, horizon_s: 3}");
    write_text(f, "study.yaml", text);
    free(text);
    assert_ok(cp_study_load(f->study, &study, &error), &error);
    assert_int_equal(study.design, CP_DESIGN_COUNTERFACTUAL);
    assert_true(study.counterfactual.checkpoint_interval_s == 4.0);
    assert_int_equal(study.counterfactual.checkpoints, 20);
    assert_true(study.counterfactual.time_series_s == 5.0);
    assert_true(study.counterfactual.horizon_s == 3.0);
    assert_int_equal(cp_study_baseline(&study), 0);
    cp_study_destroy(&study);
}

static void bad_studies_are_told_by_line(void **state)
{
    const fixture *f = *state;
    for (size_t k = 0; k < sizeof BAD / sizeof BAD[0]; k++) {
        cp_study study;
        cp_error error = {0};
        char *text = study_with(BAD[k].old, BAD[k].replacement);
        write_text(f, "study.yaml", text);
        free(text);
        cp_status status = cp_study_load(f->study, &study, &error);
        if (status != CP_BAD_INPUT || strstr(error.text, BAD[k].message) == NULL)
            fail_msg("'%s': expected '%s', got %s '%s'", BAD[k].replacement, BAD[k].message,
                     cp_status_text(status), error.text);
        assert_null(study.name);
    }
}

static void no_scenario_begins_with_a_saved_state(void **state)
{
    static const struct {
        const char *sumocfg;
        cp_status status;
    } CASES[] = {
        {"<input><load-state value=\"s.xml.gz\"/></input>", CP_BAD_INPUT},
        {"<input>\n<load-state\n v='s.xml.gz'></load-state></input>", CP_BAD_INPUT},
        {"<input><load-state value=\"\"/></input>", CP_OK},
        {"<input><!-- <load-state value=\"s.xml.gz\"/> --></input>", CP_OK},
        {"<input><load-state.offset value=\"60\"/></input>", CP_OK},
    };
    const fixture *f = *state;
    for (size_t k = 0; k < sizeof CASES / sizeof CASES[0]; k++) {
        cp_study study;
        cp_error error = {0};
        write_text(f, "a.sumocfg", CASES[k].sumocfg);
        assert_int_equal(cp_study_load(f->study, &study, &error), CASES[k].status);
        if (CASES[k].status != CP_OK)
            assert_non_null(strstr(error.text, "load-state must not be set, found 's.xml.gz'"));
        cp_study_destroy(&study);
    }
}

static void missing_and_empty_files(void **state)
{
    const fixture *f = *state;
    cp_study study;
    cp_error error = {0};
    assert_int_equal(cp_study_load("no/such/study.yaml", &study, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "no/such/study.yaml"));
    write_text(f, "study.yaml", "");
    assert_int_equal(cp_study_load(f->study, &study, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "empty"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(reads_everything, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(aliases_stand_for_what_they_name, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(after_a_crash_and_before_it, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(background_has_a_length_of_its_own_or_none, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(baseline_can_be_named, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(counterfactual_section_and_equipment, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(bad_studies_are_told_by_line, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(no_scenario_begins_with_a_saved_state, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(missing_and_empty_files, fixture_begin, fixture_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
