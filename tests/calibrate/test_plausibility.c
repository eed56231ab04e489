/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "builders/crash_library.h"

#include "calibrate/plausibility.h"

#include <math.h>

static void excess_counts_widths_outside(void **state)
{
    (void)state;
    cp_plausibility guard = {.given = true,
                             .bounded = {true, true, true, false},
                             .min = {0.06, 0.5, 30.0, 0.0},
                             .max = {0.08, 0.7, 50.0, 0.0}};
    const double mark[CP_MARK_COUNT] = {0.09, 0.45, 40.0, 99.0};
    double excess_1[CP_MARK_COUNT];
    cp_plausibility_excess(&guard, mark, excess_1);
    assert_near(excess_1[CP_MARK_T_V0], 0.5, 1e-12);
    assert_near(excess_1[CP_MARK_CRUSH], -0.25, 1e-12);
    assert_near(excess_1[CP_MARK_PEAK], 0.0, 0.0);
    assert_near(excess_1[CP_MARK_REBOUND], 0.0, 0.0);

    // No mark at all is far outside.
    const double none[CP_MARK_COUNT] = {NAN, 0.6, 40.0, 0.0};
    cp_plausibility_excess(&guard, none, excess_1);
    assert_true(excess_1[CP_MARK_T_V0] >= 1.0);
}

static void marks_are_those_of_the_pulse(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_plausibility guard = {.given = true, .speed_km_h = 56.0};
    double mark[CP_MARK_COUNT];
    cp_error error = {0};
    if (cp_plausibility_marks(&guard, &car, 0.0005, mark, &error) != CP_OK)
        fail_msg("%s", error.text);

    // A car stopped from V within the crush C at a peak a obeys V^2 / 2 C < a and C < V t.
    double v = 56.0 / 3.6, mean_g = 0.5 * v * v / mark[CP_MARK_CRUSH] / 9.80665;
    assert_true(mark[CP_MARK_PEAK] > mean_g);
    assert_true(mark[CP_MARK_CRUSH] < v * mark[CP_MARK_T_V0]);
    assert_true(mark[CP_MARK_CRUSH] > 0.5 * v * mark[CP_MARK_T_V0] * 0.8);
    assert_true(mark[CP_MARK_REBOUND] > 0.0 && mark[CP_MARK_REBOUND] < 0.3 * v);

    // Faster is deeper.
    guard.speed_km_h = 64.0;
    double faster[CP_MARK_COUNT];
    assert_int_equal(cp_plausibility_marks(&guard, &car, 0.0005, faster, &error), CP_OK);
    assert_true(faster[CP_MARK_CRUSH] > mark[CP_MARK_CRUSH]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(excess_counts_widths_outside),
        cmocka_unit_test(marks_are_those_of_the_pulse),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
