/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "calibrate/validation.h"

#include <string.h>

static void errors_are_summed_up_by_hand(void **state)
{
    (void)state;
    const cp_reference_case cases[] = {
        {25, 0, 0, 8.0}, {25, 350, 10, 8.0}, {56, 0, 10, 24.0}, {56, 350, 0, 20.0}};
    const double olc_g[] = {9.0, 8.5, 20.0, 20.0};
    cp_validation v;
    cp_error error = {0};
    assert_int_equal(cp_validate_olc(cases, olc_g, 4, &v, &error), CP_OK);
    assert_near(v.mean_abs_error_g, 5.5 / 4.0, 1e-12);
    assert_near(v.max_abs_error_g, 4.0, 1e-12);
    assert_near(v.lowest_error_g, -4.0, 1e-12);
    assert_near(v.highest_error_g, 1.0, 1e-12);
    assert_near(v.quartile_g[1], 0.75, 1e-12);
    assert_int_equal(v.group_count[0], 2);
    assert_near(v.group[0][0].value, 25.0, 0.0);
    assert_near(v.group[0][0].mean_abs_error_g, 0.75, 1e-12);
    assert_near(v.group[0][1].mean_abs_error_g, 2.0, 1e-12);
    assert_near(v.group[1][1].mean_abs_error_g, 0.25, 1e-12);
    assert_near(v.group[2][1].mean_abs_error_g, 2.25, 1e-12);
}

static void a_case_that_failed_is_named(void **state)
{
    (void)state;
    const cp_reference_case cases[] = {{25, 0, 0, 8.0}, {45, -700, 20, 8.0}};
    const double olc_g[] = {9.0, NAN};
    cp_validation v;
    cp_error error = {0};
    assert_int_equal(cp_validate_olc(cases, olc_g, 2, &v, &error), CP_RUN_FAILED);
    assert_non_null(strstr(error.text, "45 km/h, offset -700 mm, angle 20 deg"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_summed_up_by_hand),
        cmocka_unit_test(a_case_that_failed_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
