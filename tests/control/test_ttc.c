/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/ttc.h"

#include "core/rng.h"
#include "core/units.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

// A car 4 m by 2 m about its centre.
static cp_moving_rectangle car(double x_m, double y_m, double yaw_rad, double speed_m_s,
                               double yaw_rate_rad_s)
{
    return (cp_moving_rectangle){{{x_m, y_m}, yaw_rad, 4.0, 2.0},
                                 cp_vec2_scale(cp_vec2_heading(yaw_rad), speed_m_s),
                                 yaw_rate_rad_s};
}

static void assert_close(double found, double expected, double tolerance)
{
    if (!(fabs(found - expected) <= tolerance))
        fail_msg("%.12g is not %.12g", found, expected);
}

static void head_on_is_gap_by_closing_speed(void **unused)
{
    (void)unused;
    cp_moving_rectangle a = car(0.0, 0.0, 0.0, 20.0, 0.0);
    cp_moving_rectangle b = car(54.0, 0.0, CP_PI, 15.0, 0.0);
    assert_close(cp_ttc_s(&a, &b, 5.0), 50.0 / 35.0, 1e-12);
    assert_close(cp_ttc_s(&b, &a, 5.0), 50.0 / 35.0, 1e-12);
    assert_true(cp_ttc_s(&a, &b, 1.0) == INFINITY);

    // Offset: any overlap of the fronts counts, none does not.
    b.rectangle.centre_m.y = 1.99;
    assert_close(cp_ttc_s(&a, &b, 5.0), 50.0 / 35.0, 1e-9);
    b.rectangle.centre_m.y = 2.01;
    assert_true(cp_ttc_s(&a, &b, 5.0) == INFINITY);
}

static void following_is_gap_by_difference_of_speeds(void **unused)
{
    (void)unused;
    cp_moving_rectangle a = car(0.0, 0.0, 0.5, 15.0, 0.0), b = a;
    b.rectangle.centre_m = cp_vec2_scale(cp_vec2_heading(0.5), 14.0);
    b.velocity_m_s = cp_vec2_scale(cp_vec2_heading(0.5), 10.0);
    assert_close(cp_ttc_s(&a, &b, 5.0), 2.0, 1e-9);
    b.velocity_m_s = a.velocity_m_s;
    assert_true(cp_ttc_s(&a, &b, 5.0) == INFINITY);
    b.velocity_m_s = cp_vec2_scale(a.velocity_m_s, 2.0);
    assert_true(cp_ttc_s(&a, &b, 5.0) == INFINITY);
}

static void crossing_is_when_the_later_reaches_the_other_path(void **unused)
{
    (void)unused;
    // a's front reaches b's flank x = -1 after 20 m; b's body is across y = 0 from 1.5 to 2.5 s.
    cp_moving_rectangle a = car(-23.0, 0.0, 0.0, 10.0, 0.0);
    cp_moving_rectangle b = car(0.0, -12.0, CP_PI / 2, 6.0, 0.0);
    assert_close(cp_ttc_s(&a, &b, 5.0), 2.0, 1e-9);
    // b later: its front runs into a's side, y = -1, with a between 1.8 and 2.6 s.
    b = car(0.0, -3.0 - 6.0 * 2.2, CP_PI / 2, 6.0, 0.0);
    assert_close(cp_ttc_s(&a, &b, 5.0), 2.2, 1e-9);
    // b so late that a is through, or so early that it is through itself.
    b = car(0.0, -3.0 - 6.0 * 2.7, CP_PI / 2, 6.0, 0.0);
    assert_true(cp_ttc_s(&a, &b, 5.0) == INFINITY);
    b = car(0.0, 3.1 - 6.0 * 2.0, CP_PI / 2, 6.0, 0.0);
    assert_true(cp_ttc_s(&a, &b, 5.0) == INFINITY);
}

static void overlap_now_is_zero(void **unused)
{
    (void)unused;
    cp_moving_rectangle a = car(0.0, 0.0, 0.3, 0.0, 0.0), b = car(1.0, 1.0, -1.0, 0.0, 0.0);
    assert_true(cp_ttc_s(&a, &b, 5.0) == 0.0);
    b.yaw_rate_rad_s = 0.1;
    assert_true(cp_ttc_s(&a, &b, 5.0) == 0.0);
}

static void a_turn_is_followed_round(void **unused)
{
    (void)unused;
    // A speck on a circle of 20 m meets one that stands a radian ahead, after 1 rad / 0.5 rad/s.
    cp_moving_rectangle a = {{{20.0, 0.0}, CP_PI / 2, 2e-3, 2e-3}, {0.0, 10.0}, 0.5};
    cp_moving_rectangle b = {
        {{20.0 * cos(1.0), 20.0 * sin(1.0)}, 1.0 + CP_PI / 2, 2e-3, 2e-3}, {0.0, 0.0}, 0.0};
    assert_close(cp_ttc_s(&a, &b, 5.0), 2.0, 5e-4);
    a.yaw_rate_rad_s = 0.0;
    assert_true(cp_ttc_s(&a, &b, 5.0) == INFINITY);
    a.yaw_rate_rad_s = -0.5;
    assert_true(cp_ttc_s(&a, &b, 5.0) == INFINITY);

    cp_rectangle round = cp_moving_rectangle_at(
        &(cp_moving_rectangle){{{20.0, 0.0}, CP_PI / 2, 4.0, 2.0}, {0.0, 10.0}, 0.5}, CP_PI);
    assert_close(round.centre_m.x, 0.0, 1e-12);
    assert_close(round.centre_m.y, 20.0, 1e-12);
    assert_close(cp_wrap_angle(round.yaw_rad - CP_PI), 0.0, 1e-12);
}

static void oncoming_traffic_in_its_lane_is_no_danger(void **unused)
{
    (void)unused;
    cp_moving_rectangle a = car(0.0, -1.75, 0.0, 25.0, 0.0);
    cp_moving_rectangle b = car(60.0, 1.75, CP_PI, 25.0, 0.0);
    assert_true(cp_ttc_s(&a, &b, 5.0) == INFINITY);
    // Nor in a bend of 100 m: concentric circles.
    a = car(98.25, 0.0, CP_PI / 2, 15.0, 15.0 / 98.25);
    b = car(101.75 * cos(0.6), 101.75 * sin(0.6), 0.6 - CP_PI / 2, 15.0, -15.0 / 101.75);
    assert_true(cp_ttc_s(&a, &b, 3.0) == INFINITY);
}

// Straight-forward oracle: look every millisecond.
static double watched_ttc_s(const cp_moving_rectangle *a, const cp_moving_rectangle *b,
                            double horizon_s)
{
    for (int k = 0; k <= (int)(horizon_s * 1000.0); k++) {
        cp_rectangle there_a = cp_moving_rectangle_at(a, k / 1000.0);
        cp_rectangle there_b = cp_moving_rectangle_at(b, k / 1000.0);
        if (cp_rectangle_separation(&there_a, &there_b) < 0.0)
            return k / 1000.0;
    }
    return INFINITY;
}

static void random_meetings_agree_with_watching(void **unused)
{
    (void)unused;
    cp_rng_key key = cp_rng_key_seed(7);
    int met = 0;
    for (uint64_t k = 0; k < 400; k++) {
        double u[8];
        for (uint64_t i = 0; i < 8; i++)
            u[i] = cp_rng_uniform(key, 8 * k + i);
        double rate = k % 2 ? 0.0 : 1.2;
        cp_moving_rectangle a = car(0.0, 0.0, 7.0 * u[0], 20.0 * u[1], rate * (u[2] - 0.5));
        cp_moving_rectangle b = car(40.0 * u[3] - 20.0, 40.0 * u[4] - 20.0, 7.0 * u[5], 20.0 * u[6],
                                    rate * (u[7] - 0.5));
        double found_s = cp_ttc_s(&a, &b, 3.0), watched_s = watched_ttc_s(&a, &b, 3.0);
        // Never late; early by no more than a millisecond, or by what 1 mm of gap is worth.
        if (watched_s == INFINITY && found_s == INFINITY)
            continue;
        met++;
        assert_true(found_s <= watched_s);
        cp_rectangle there_a = cp_moving_rectangle_at(&a, found_s);
        cp_rectangle there_b = cp_moving_rectangle_at(&b, found_s);
        assert_true(cp_rectangle_separation(&there_a, &there_b) <= 1.1e-3);
    }
    assert_in_range(met, 40, 360);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(head_on_is_gap_by_closing_speed),
        cmocka_unit_test(following_is_gap_by_difference_of_speeds),
        cmocka_unit_test(crossing_is_when_the_later_reaches_the_other_path),
        cmocka_unit_test(overlap_now_is_zero),
        cmocka_unit_test(a_turn_is_followed_round),
        cmocka_unit_test(oncoming_traffic_in_its_lane_is_no_danger),
        cmocka_unit_test(random_meetings_agree_with_watching),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
