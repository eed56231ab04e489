/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "builders/crash_library.h"
#include "suite_text.h"

#include "calibrate/scorecard.h"

// ---- judging -----------------------------------------------------------------------------------

static const cp_suite_bar NO_BAR = {.inside_1 = NAN,
                                    .mean_abs = NAN,
                                    .median_abs = NAN,
                                    .p90_abs = NAN,
                                    .max_abs = NAN,
                                    .max_step = NAN};

static cp_scorecard_verdict judge(cp_suite_comparison *comparison, cp_scorecard_case *cases,
                                  size_t count, cp_scorecard_row *row)
{
    cp_error error = {0};
    *row = (cp_scorecard_row){.comparison = comparison, .cases = cases, .case_count = count};
    assert_int_equal(cp_scorecard_judge(row, &error), CP_OK);
    return row->verdict;
}

static void figures_are_those_of_the_errors(void **state)
{
    (void)state;
    cp_scorecard_case cases[] = {{.reference = 10, .low = 8, .high = 12, .model = 11},
                                 {.reference = 20, .low = 18, .high = NAN, .model = 17},
                                 {.reference = 40, .low = NAN, .high = 45, .model = 44}};
    cp_suite_comparison comparison = {.bar = NO_BAR};
    cp_scorecard_row row;
    assert_int_equal(judge(&comparison, cases, 3, &row), CP_SCORECARD_NO_BAR);
    assert_near(row.bias, 2.0 / 3.0, 1e-12);
    assert_near(row.mean_abs, 8.0 / 3.0, 1e-12);
    assert_near(row.median_abs, 3.0, 1e-12);
    assert_near(row.p90_abs, 3.8, 1e-12);
    assert_near(row.max_abs, 4.0, 1e-12);
    assert_near(row.max_step, 27.0, 1e-12);
    assert_near(row.inside_1, 2.0 / 3.0, 1e-12);
    assert_near(row.reference, 70.0 / 3.0, 1e-12);

    // In per cent of the reference: 10, 15, 10.
    comparison.relative = true;
    judge(&comparison, cases, 3, &row);
    assert_near(row.max_abs, 15.0, 1e-12);
    assert_near(row.bias, 5.0 / 3.0, 1e-12);
}

static void every_part_of_a_bar_can_break_it(void **state)
{
    (void)state;
    cp_scorecard_case cases[] = {{.reference = 10, .low = 8, .high = 12, .model = 11},
                                 {.reference = 20, .low = 18, .high = 22, .model = 17},
                                 {.reference = 40, .low = 38, .high = 45, .model = 44}};
    cp_scorecard_row row;
    static const struct {
        size_t offset;
        double keeps;
        double breaks;
    } PARTS[] = {{offsetof(cp_suite_bar, mean_abs), 2.7, 2.6},
                 {offsetof(cp_suite_bar, median_abs), 3.0, 2.9},
                 {offsetof(cp_suite_bar, p90_abs), 3.81, 3.79},
                 {offsetof(cp_suite_bar, max_abs), 4.0, 3.9},
                 {offsetof(cp_suite_bar, max_step), 27.0, 26.9},
                 {offsetof(cp_suite_bar, inside_1), 0.66, 0.67}};
    for (size_t k = 0; k < sizeof PARTS / sizeof *PARTS; k++) {
        cp_suite_comparison comparison = {.bar = NO_BAR, .population = "p"};
        double *part = (double *)((char *)&comparison.bar + PARTS[k].offset);
        *part = PARTS[k].keeps;
        assert_int_equal(judge(&comparison, cases, 3, &row), CP_SCORECARD_KEPT);
        *part = PARTS[k].breaks;
        assert_int_equal(judge(&comparison, cases, 3, &row), CP_SCORECARD_MISSED);
        assert_true(row.bar[0] != '\0');
    }
    cp_suite_comparison falling = {.bar = NO_BAR}, last = {.bar = NO_BAR};
    falling.bar.falling = true;
    last.bar.last_is_highest = true;
    assert_int_equal(judge(&falling, cases, 3, &row), CP_SCORECARD_MISSED);
    assert_int_equal(judge(&last, cases, 3, &row), CP_SCORECARD_KEPT);
    cp_scorecard_case reversed[] = {cases[2], cases[1], cases[0]};
    assert_int_equal(judge(&falling, reversed, 3, &row), CP_SCORECARD_KEPT);
    assert_int_equal(judge(&last, reversed, 3, &row), CP_SCORECARD_MISSED);
}

static void a_case_that_failed_keeps_no_bar(void **state)
{
    (void)state;
    cp_scorecard_case cases[] = {{.reference = 10, .low = 8, .high = 12, .model = 10},
                                 {.reference = 20, .low = 8, .high = 22, .model = NAN}};
    cp_suite_comparison comparison = {.bar = NO_BAR};
    comparison.bar.mean_abs = 1.0;
    cp_scorecard_row row;
    assert_int_equal(judge(&comparison, cases, 2, &row), CP_SCORECARD_MISSED);
    assert_int_equal(row.failed_count, 1);
    assert_near(row.inside_1, 0.5, 0.0);
}

static void a_range_of_the_model_holds_the_test(void **state)
{
    (void)state;
    cp_scorecard_case cases[] = {
        {.reference = 10, .low = 9, .high = 14, .model = 12, .is_range = true},
        {.reference = 10, .low = 11, .high = 14, .model = 12, .is_range = true}};
    cp_suite_comparison comparison = {.bar = NO_BAR};
    cp_scorecard_row row;
    judge(&comparison, cases, 2, &row);
    assert_true(cases[0].inside && !cases[1].inside);
}

// ---- running -----------------------------------------------------------------------------------

#define HEAD "suite: s\nvehicles: [mid_size]\nclasses:\n"

static cp_status make(const char *text, const char *vehicle, int threads, cp_suite *suite,
                      cp_scorecard *scorecard, cp_error *error)
{
    *scorecard = (cp_scorecard){0};
    cp_status status = suite_text_load(text, suite, error);
    if (status != CP_OK)
        return status;
    const cp_scorecard_request request = {.suite = suite,
                                          .vehicles = &vehicle,
                                          .vehicle_count = vehicle != NULL ? 1 : 0,
                                          .references = "/nowhere",
                                          .threads = threads};
    return cp_scorecard_make(&request, scorecard, error);
}

static void expect(cp_status status, const cp_error *error)
{
    if (status != CP_OK)
        fail_msg("%s", error->text);
}

// Closed forms: equal cars head on share their momentum, and are each other's wall.
static const char EQUAL_CARS[] = HEAD
    "  - class: equal\n    title: t\n    speeds_km_h: [40]\n    against: [same]\n"
    "    barrier: {width_m: 4, depth_m: 1, corner_radius_m: 0.01}\n"
    "    compare:\n      - {quantity: momentum_ratio_1, reference: [1], bar: {max_abs: 1e-6}}\n"
    "      - {quantity: delta_v_m_s, low: [11.2], high: [20], bar: {inside_1: 1}}\n"
    "      - {quantity: yaw_rate_deg_s, reference: [0], bar: {max_abs: 1e-3}}\n"
    "      - {quantity: wall_difference_pct, high: [10], bar: {inside_1: 1}}\n";

static void equal_cars_keep_closed_forms(void **state)
{
    (void)state;
    cp_suite suite;
    cp_scorecard scorecard;
    cp_error error = {0};
    expect(make(EQUAL_CARS, NULL, 1, &suite, &scorecard, &error), &error);
    assert_int_equal(scorecard.count, 4);
    for (size_t k = 0; k < scorecard.count; k++)
        if (scorecard.row[k].verdict != CP_SCORECARD_KEPT)
            fail_msg("%s = %.9g: %s", scorecard.row[k].quantity, scorecard.row[k].model,
                     scorecard.row[k].bar);
    assert_string_equal(scorecard.row[0].vehicle, "mid_size");
    cp_scorecard_destroy(&scorecard);
    cp_suite_destroy(&suite);
}

static const char BOTH_SIDES[] =
    HEAD "  - class: small\n    title: t\n    speeds_km_h: [64.4]\n    overlaps_1: [0.25]\n"
         "    angles_deg: [10]\n    sides: [left, right]\n"
         "    barrier: {width_m: 2, depth_m: 1.5, corner_radius_m: 0.15}\n"
         "    compare:\n      - {quantity: dvx_m_s, times_ms: [40, 80]}\n"
         "      - {quantity: dvy_away_m_s, times_ms: [40, 80]}\n      - {quantity: olc_g}\n"
         "      - {quantity: yaw_rate_deg_s}\n      - {quantity: separation_dvy_m_s}\n";

static void sides_are_mirrored_whatever_the_threads(void **state)
{
    (void)state;
    for (int threads = 1; threads <= 3; threads += 2) {
        cp_suite suite;
        cp_scorecard scorecard;
        cp_error error = {0};
        expect(make(BOTH_SIDES, "honda_accord_2014", threads, &suite, &scorecard, &error), &error);
        for (size_t k = 0; k < scorecard.count; k++) {
            const cp_scorecard_row *row = &scorecard.row[k];
            size_t half = row->case_count / 2;
            assert_int_equal(row->failed_count, 0);
            for (size_t c = 0; c < half; c++)
                assert_near(row->cases[half + c].model, row->cases[c].model, 1e-6);
        }
        // Turned towards the barrier and pushed away from it.
        assert_true(scorecard.row[3].cases[0].model > 10.0);
        assert_true(scorecard.row[1].cases[1].model > 0.5);
        cp_scorecard_destroy(&scorecard);
        cp_suite_destroy(&suite);
    }
}

static void a_pole_is_a_barrier(void **state)
{
    (void)state;
    cp_suite suite;
    cp_scorecard scorecard;
    cp_error error = {0};
    const char *text =
        HEAD "  - class: pole\n    title: t\n    speeds_km_h: [40]\n"
             "    barrier: {width_m: 0.254, depth_m: 0.254, corner_radius_m: 0.127}\n"
             "    compare: [{quantity: separation_dvx_m_s, low: [11.1], bar: {inside_1: 1}}]\n";
    expect(make(text, NULL, 1, &suite, &scorecard, &error), &error);
    assert_int_equal(scorecard.row[0].verdict, CP_SCORECARD_KEPT);
    cp_scorecard_destroy(&scorecard);
    cp_suite_destroy(&suite);
}

static void what_has_no_reference_is_skipped_with_a_word(void **state)
{
    (void)state;
    cp_suite suite;
    cp_scorecard scorecard;
    cp_error error = {0};
    const char *text =
        HEAD "  - class: absent\n    title: t\n"
             "    table: {form: separation, references_file: a/b.csv, rows_with: [pole]}\n"
             "    barrier: {width_m: 2, depth_m: 1, corner_radius_m: 0.1}\n"
             "    compare: [{quantity: separation_dvx_m_s}]\n"
             "  - class: foreign\n    title: t\n    vehicles: [small_car]\n    speeds_km_h: [40]\n"
             "    barrier: {width_m: 2, depth_m: 1, corner_radius_m: 0.1}\n"
             "    compare: [{quantity: peak_g}]\n";
    expect(make(text, "mid_size", 1, &suite, &scorecard, &error), &error);
    assert_int_equal(scorecard.count, 2);
    for (size_t k = 0; k < 2; k++)
        assert_int_equal(scorecard.row[k].verdict, CP_SCORECARD_SKIPPED);
    assert_string_equal(scorecard.row[0].note, "a/b.csv is not among the references");
    assert_string_equal(scorecard.row[1].note, "the reference is of small_car");
    cp_scorecard_destroy(&scorecard);
    cp_suite_destroy(&suite);
}

static void what_does_not_fit_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *vehicle;
        const char *body;
        const char *words;
    } CASES[] = {
        {"racer", "    speeds_km_h: [40]\n    against: [same]\n    compare: [{quantity: olc_g}]\n",
         "no vehicle 'racer' is shipped; a name must be one of bus"},
        {"mid_size",
         "    speeds_km_h: [40]\n    against: [racer]\n    compare: [{quantity: olc_g}]\n",
         "no vehicle 'racer' is shipped"},
        {"/nowhere/car.yaml",
         "    speeds_km_h: [40]\n    against: [same]\n    compare: [{quantity: olc_g}]\n",
         "/nowhere/car.yaml"},
        {"mid_size",
         "    table: {form: oblique, file: absent.csv}\n    compare: [{quantity: olc_g}]\n",
         "absent.csv"},
        {"mid_size",
         "    speeds_km_h: [40, 50, 60]\n    against: [same]\n"
         "    compare: [{quantity: olc_g, low: [1, 2]}]\n",
         "class c: low must have one value, or one for each of its 3 cases, found 2"},
        {"mid_size",
         "    speeds_km_h: [40]\n    against: [same]\n    compare: [{quantity: olc_g, population: "
         "q}]\n",
         "no olc_g of population q"},
    };
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        char text[1024];
        snprintf(text, sizeof text, HEAD "  - class: c\n    title: t\n%s", CASES[k].body);
        cp_suite suite;
        cp_scorecard scorecard;
        cp_error error = {0};
        assert_int_equal(make(text, CASES[k].vehicle, 1, &suite, &scorecard, &error), CP_BAD_INPUT);
        if (strstr(error.text, CASES[k].words) == NULL)
            fail_msg("expected '%s' in: %s", CASES[k].words, error.text);
        cp_scorecard_destroy(&scorecard);
        cp_suite_destroy(&suite);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figures_are_those_of_the_errors),
        cmocka_unit_test(every_part_of_a_bar_can_break_it),
        cmocka_unit_test(a_case_that_failed_keeps_no_bar),
        cmocka_unit_test(a_range_of_the_model_holds_the_test),
        cmocka_unit_test(equal_cars_keep_closed_forms),
        cmocka_unit_test(sides_are_mirrored_whatever_the_threads),
        cmocka_unit_test(a_pole_is_a_barrier),
        cmocka_unit_test(what_has_no_reference_is_skipped_with_a_word),
        cmocka_unit_test(what_does_not_fit_is_refused),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
