/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/assessment_section.h"

#include "study/fixture.h"

// Load the good study with a section in front of its vehicles.
static cp_status load_with(const fixture *f, const char *section, cp_study *study, cp_error *error)
{
    char *text = study_with("vehicles:\n  default: car.yaml\n", section);
    assert_ok(cp_file_write(f->study, text, strlen(text), error), error);
    free(text);
    return cp_study_load(f->study, study, error);
}

static void what_is_said_is_marked(void **state)
{
    const fixture *f = *state;
    cp_study study;
    cp_error error = {0};
    assert_ok(load_with(f,
                        "assessment:\n"
                        "  target_population: drivers of cars\n"
                        "  limitations: |\n"
                        "    Two lines:\n"
                        "    no rates of real traffic.\n"
                        "vehicles:\n  default: car.yaml\n",
                        &study, &error),
              &error);
    for (size_t k = 0; k < CP_ASSESSMENT_ITEM_COUNT; k++)
        assert_int_equal(study.said[k],
                         k == CP_ASSESSED_POPULATION || k == CP_ASSESSED_LIMITATIONS);
    cp_study_destroy(&study);
}

// Without the section, or with an empty one, nothing is said and nothing is wrong.
static void all_of_it_may_be_left_out(void **state)
{
    const fixture *f = *state;
    cp_error error = {0};
    static const char *const SECTION[] = {"vehicles:\n  default: car.yaml\n",
                                          "assessment: {}\nvehicles:\n  default: car.yaml\n"};
    for (size_t n = 0; n < 2; n++) {
        cp_study study;
        assert_ok(load_with(f, SECTION[n], &study, &error), &error);
        for (size_t k = 0; k < CP_ASSESSMENT_ITEM_COUNT; k++)
            assert_false(study.said[k]);
        cp_study_destroy(&study);
    }
}

static void wrong_items_are_named(void **state)
{
    const fixture *f = *state;
    char large[CP_ASSESSMENT_CHARACTERS_MAX + 200];
    snprintf(large, sizeof large, "assessment:\n  metrics: %0*d\nvehicles:\n  default: car.yaml\n",
             CP_ASSESSMENT_CHARACTERS_MAX + 1, 7);
    const struct {
        const char *section, *message;
    } wrong[] = {
        {"assessment:\n  target_people: all\nvehicles:\n  default: car.yaml\n",
         "study.yaml:25: Unexpected key: target_people"},
        {"assessment:\n  metrics: \"  \"\nvehicles:\n  default: car.yaml\n",
         "study.yaml:25: assessment.metrics must say something, or be left out"},
        {"assessment:\n  metrics: OLC\n  metrics: rates\nvehicles:\n  default: car.yaml\n",
         "study.yaml:26: "},
        {large, "study.yaml:25: assessment.metrics must have at most 4000 characters, found 4001"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        cp_study study;
        cp_error error = {0};
        assert_int_equal(load_with(f, wrong[k].section, &study, &error), CP_BAD_INPUT);
        if (strstr(error.text, wrong[k].message) == NULL)
            fail_msg("found: %s", error.text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(what_is_said_is_marked, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(all_of_it_may_be_left_out, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(wrong_items_are_named, fixture_begin, fixture_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
