/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "suite_text.h"

#define HEAD "suite: s\nvehicles: [mid_size]\nclasses:\n"
#define WALL "    barrier: {width_m: 4, depth_m: 1, corner_radius_m: 0.1}\n"
#define PEAK "    compare: [{quantity: peak_g}]\n"
#define CLASS(body) HEAD "  - class: c\n    title: t\n" body

static void a_class_is_read(void **state)
{
    (void)state;
    cp_suite suite;
    cp_error error = {0};
    const char *text = CLASS("    speeds_km_h: [40, 56]\n"
                             "    overlap_sweep: {from_1: 0.25, to_1: 1, count: 4}\n"
                             "    sides: [right]\n" WALL "    compare:\n"
                             "      - {quantity: dvx_m_s, times_ms: [60], population: p,\n"
                             "         bar: {inside_1: 0.9}}\n"
                             "      - {quantity: olc_g, relative: yes, reference: [17],\n"
                             "         bar: {max_abs: 5, falling: yes}}\n");
    if (suite_text_load(text, &suite, &error) != CP_OK)
        fail_msg("%s", error.text);
    const cp_suite_class *class = &suite.class[0];
    assert_int_equal(class->form, CP_SUITE_LISTS);
    assert_int_equal(class->overlaps_1.count, 4);
    assert_near(class->overlaps_1.value[1], 0.5, 1e-15);
    assert_near(class->sides_1.value[0], -1.0, 0.0);
    assert_near(class->barrier.width_m, 4.0, 0.0);
    assert_int_equal(class->comparison[0].quantity, CP_SUITE_dvx_m_s);
    assert_near(class->comparison[0].bar.inside_1, 0.9, 0.0);
    assert_true(isnan(class->comparison[0].bar.max_abs));
    assert_true(class->comparison[1].relative && class->comparison[1].bar.falling);
    cp_suite_destroy(&suite);
}

static void what_is_wrong_is_named(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        const char *words;
    } CASES[] = {
        {"suite: s\nvehicles: [mid_size]\n", "classes"},
        {CLASS("    speeds: [40]\n" WALL PEAK), ":6: Unexpected key: speeds"},
        {CLASS("    speeds_km_h: [fast]\n" WALL PEAK),
         ":6: classes[0].speeds_km_h[0] must be a number from 0.5 to 300, found 'fast'"},
        {CLASS(WALL PEAK), "classes[0].speeds_km_h is missing"},
        {CLASS("    speeds_km_h: [40]\n" PEAK), "classes[0].barrier is missing"},
        {CLASS("    speeds_km_h: [40]\n"
               "    barrier: {width_m: 0.1, depth_m: 1, corner_radius_m: 0}\n" PEAK),
         "classes[0].barrier.width_m must be between 0.2 and 20, found 0.1"},
        {CLASS("    speeds_km_h: [40]\n"
               "    barrier: {width_m: 0.3, depth_m: 1, corner_radius_m: 0.2}\n" PEAK),
         "classes[0].barrier.corner_radius_m must be between 0 and 0.15"},
        {CLASS("    speeds_km_h: [40]\n    sides: [middle]\n" WALL PEAK),
         "classes[0].sides must be left or right, found 'middle'"},
        {CLASS("    speeds_km_h: [40]\n" WALL "    compare: [{quantity: speed}]\n"),
         "classes[0].compare[0].quantity is none that a suite compares, found 'speed'"},
        {CLASS("    speeds_km_h: [40]\n" WALL "    compare: [{quantity: dvx_m_s}]\n"),
         "times_ms is missing"},
        {CLASS("    speeds_km_h: [40]\n" WALL
               "    compare: [{quantity: olc_g, bar: {inside_1: 1}}]\n"),
         "bar.inside_1 needs a population"},
        {CLASS("    speeds_km_h: [40]\n" WALL
               "    compare: [{quantity: olc_g, population: p, low: [1]}]\n"),
         "population does not go with"},
        {CLASS("    speeds_km_h: [40]\n" WALL "    compare: [{quantity: olc_g, relative: ja}]\n"),
         "relative must be yes or no, found 'ja'"},
        {CLASS("    speeds_km_h: [40]\n" WALL "    compare: [{quantity: momentum_ratio_1}]\n"),
         "needs a second car"},
        {CLASS("    speeds_km_h: [40]\n" WALL "    compare: [{quantity: olc_g, car: 2}]\n"),
         "of one car goes with struck or a table of pairs"},
        {CLASS("    table: {form: odd, file: x.csv}\n" PEAK),
         "table.form must be olc, separation, oblique, reconstructed or reconstructed_struck, "
         "found 'odd'"},
        {CLASS("    table: {form: olc}\n" PEAK), "table needs either file or references_file"},
        {CLASS("    table: {form: olc, file: x.csv}\n    speeds_km_h: [40]\n" PEAK),
         "table does not go with lists"},
        {CLASS("    table: {form: separation, file: x.csv}\n" WALL PEAK), "table.rows_with names"},
        {CLASS("    speeds_km_h: [40]\n    opponent_speeds_km_h: [0]\n" WALL PEAK),
         "opponent_speeds_km_h needs against"},
        {CLASS("    struck: top\n    speeds_km_h: [40]\n    against: [same]\n" PEAK),
         "classes[0].struck must be side or rear, found 'top'"},
        {CLASS("    struck: side\n    speeds_km_h: [40]\n" PEAK),
         "struck needs against or barrier"},
        {CLASS("    speeds_km_h: [40]\n    at_mm: [0]\n" WALL PEAK), "struck is missing"},
        {CLASS("    struck: rear\n    speeds_km_h: [40]\n    struck_speeds_km_h: [0, 1]\n"
               "    against: [same]\n" PEAK),
         "struck_speeds_km_h needs one for each"},
        {CLASS("    struck: side\n    speeds_km_h: [40]\n    at_mm: [0]\n    against: [same]\n"
               "    at_sweep: {from_mm: 0, to_mm: 10, count: 3}\n" PEAK),
         "at_sweep does not go with"},
        {CLASS("    speeds_km_h: [40]\n    barrier: {width_m: 1, depth_m: 2, corner_radius_m: 0, "
               "mass_kg: 100}\n" PEAK),
         "barrier mass_kg must be 0 (fixed) or between 200"},
        {CLASS("    speeds_km_h: [40]\n    against: [same]\n    barrier: {width_m: 1, depth_m: 2, "
               "corner_radius_m: 0, mass_kg: 1000}\n" PEAK),
         "does not go with against"},
        {CLASS("    speeds_km_h: [40]\n" WALL PEAK
               "  - class: c\n    title: u\n    speeds_km_h: [40]\n" WALL PEAK),
         "classes[1].class is given twice"},
    };
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        cp_suite suite;
        cp_error error = {0};
        assert_int_equal(suite_text_load(CASES[k].text, &suite, &error), CP_BAD_INPUT);
        if (strstr(error.text, CASES[k].words) == NULL)
            fail_msg("expected '%s' in: %s", CASES[k].words, error.text);
        cp_suite_destroy(&suite);
    }
}

static void a_missing_file_is_said(void **state)
{
    (void)state;
    cp_suite suite;
    cp_error error = {0};
    assert_int_equal(cp_suite_load("/nowhere/suite.yaml", &suite, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "/nowhere/suite.yaml"));
    cp_suite_destroy(&suite);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_class_is_read),
        cmocka_unit_test(what_is_wrong_is_named),
        cmocka_unit_test(a_missing_file_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
