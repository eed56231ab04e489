/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/brake.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void loss_is_the_integral_of_ramp_and_plateau(void **unused)
{
    (void)unused;
    const cp_brake brake = {2.0, 40.0, 8.0, 0.0}; // ramp of 0.2 s
    assert_true(cp_brake_speed_loss_m_s(&brake, 1.0) == 0.0);
    assert_true(cp_brake_speed_loss_m_s(&brake, 2.0) == 0.0);
    assert_true(fabs(cp_brake_speed_loss_m_s(&brake, 2.1) - 0.2) < 1e-12);
    assert_true(fabs(cp_brake_speed_loss_m_s(&brake, 2.2) - 0.8) < 1e-12);
    assert_true(fabs(cp_brake_speed_loss_m_s(&brake, 3.2) - 8.8) < 1e-12);
}

// Speed taken away by summing up the deceleration.
static double summed_m_s(const cp_brake *brake, double until_s)
{
    const int pieces = 100000;
    double sum_m_s = 0.0, step_s = (until_s - brake->start_s) / pieces;
    for (int k = 0; k < pieces; k++)
        sum_m_s += step_s * cp_brake_deceleration_m_s2(brake, brake->start_s + (k + 0.5) * step_s);
    return sum_m_s;
}

static void another_level_is_gone_to_with_the_same_jerk(void **unused)
{
    (void)unused;
    const double levels_m_s2[] = {2.0, 8.0, 3.0, 3.5};
    cp_braking braking;
    cp_brake brake = {1.0, 20.0, 5.0, 0.0};
    double now_s = 1.1; // on the ramp, at 2 m/s^2
    cp_braking_begin(&braking, &brake);
    for (size_t k = 0; k < sizeof levels_m_s2 / sizeof *levels_m_s2; k++) {
        double before_m_s2 = cp_brake_deceleration_m_s2(&braking.brake, now_s);
        cp_braking_change(&braking, now_s, levels_m_s2[k]);
        // It goes on where it was, and to the new level no faster than the jerk.
        double rise_s = fabs(levels_m_s2[k] - before_m_s2) / 20.0;
        assert_true(fabs(cp_brake_deceleration_m_s2(&braking.brake, now_s) - before_m_s2) < 1e-12);
        assert_true(fabs(cp_brake_deceleration_m_s2(&braking.brake, now_s + 0.5 * rise_s) -
                         0.5 * (before_m_s2 + levels_m_s2[k])) < 1e-12);
        assert_true(fabs(cp_brake_deceleration_m_s2(&braking.brake, now_s + rise_s) -
                         levels_m_s2[k]) < 1e-12);
        double loss_m_s = cp_brake_speed_loss_m_s(&braking.brake, now_s + 0.7);
        assert_true(fabs(loss_m_s - summed_m_s(&braking.brake, now_s + 0.7)) < 1e-6);
        now_s += 0.5;
    }
    // Before it has begun only the level is another.
    cp_braking_begin(&braking, &brake);
    cp_braking_change(&braking, 0.5, 3.0);
    assert_true(braking.brake.start_s == 1.0 && braking.brake.from_m_s2 == 0.0 &&
                braking.brake.deceleration_m_s2 == 3.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loss_is_the_integral_of_ramp_and_plateau),
        cmocka_unit_test(another_level_is_gone_to_with_the_same_jerk)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
