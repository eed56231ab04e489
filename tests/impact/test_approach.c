/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/approach.h"

#include "core/rng.h"
#include "core/units.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "builders/assert_near.h"
#include "builders/drive.h"

static bool touch(const drive *one, const drive *other, double end_s, double dt_s, double *time_s)
{
    cp_vehicle_motion a = drive_motion(one, 1, end_s, dt_s),
                      b = drive_motion(other, 2, end_s, dt_s);
    double fraction;
    if (!cp_first_contact(&a, &b, dt_s, &fraction))
        return false;
    assert_true(fraction >= 0.0 && fraction <= 1.0);
    *time_s = end_s - dt_s + fraction * dt_s;
    return true;
}

static void oncoming_cars_touch_at_the_exact_moment(void **state)
{
    (void)state;
    drive a = {.speed_m_s = 15.0};
    drive b = {.x_m = 31.0, .y_m = 0.6, .yaw_rad = CP_PI, .speed_m_s = 10.0};
    double time_s;
    assert_true(touch(&a, &b, 1.3, 0.1, &time_s));
    assert_near(time_s, 31.0 / 25.0, 1e-12);
    assert_false(touch(&a, &b, 1.2, 0.1, &time_s));
}

static void a_braking_car_touches_at_the_exact_moment(void **state)
{
    (void)state;
    // Standing car's rear at 14 m: reached at 1 m/s, 1.75 s after braking from 15 m/s.
    drive a = {.speed_m_s = 15.0, .acceleration_m_s2 = -8.0};
    drive b = {.x_m = 14.0 + 4.5};
    double time_s;
    assert_true(touch(&a, &b, 1.85, 0.2, &time_s)); // and stops inside this step
    assert_near(time_s, 1.75, 1e-12);
}

static void nothing_tunnels_at_60_m_s_and_a_tenth_of_a_second(void **state)
{
    (void)state;
    // Motorcycles pass through each other within one step, clipped by 2 cm.
    for (double start_m = 0.5; start_m < 2.0; start_m += 0.1) {
        drive a = {.speed_m_s = 30.0, .length_m = 2.0, .width_m = 0.6};
        drive b = {.x_m = start_m,
                   .y_m = 0.58,
                   .yaw_rad = CP_PI,
                   .speed_m_s = 30.0,
                   .length_m = 2.0,
                   .width_m = 0.6};
        double time_s;
        assert_true(touch(&a, &b, 0.1, 0.1, &time_s));
        assert_near(time_s, start_m / 60.0, 1e-12);
        b.y_m = 0.62; // and pass by with 2 cm to spare
        assert_false(touch(&a, &b, 0.1, 0.1, &time_s));
    }
}

static void overlap_from_the_beginning_is_fraction_zero(void **state)
{
    (void)state;
    drive a = {.speed_m_s = 15.0}, b = {.x_m = 2.0, .y_m = 0.5, .yaw_rad = 0.3, .speed_m_s = 15.0};
    double time_s;
    assert_true(touch(&a, &b, 0.1, 0.1, &time_s));
    assert_near(time_s, 0.0, 0.0);
}

static void standing_cars_and_platoons_do_not_touch(void **state)
{
    (void)state;
    drive a = {0}, b = {.x_m = 4.6}, c = {.y_m = 1.9};
    double time_s;
    assert_false(touch(&a, &b, 0.1, 0.1, &time_s));
    assert_false(touch(&a, &c, 0.1, 0.1, &time_s));
    a.speed_m_s = b.speed_m_s = 40.0;
    assert_false(touch(&a, &b, 0.1, 0.1, &time_s));
}

static void a_tail_that_swings_out_touches(void **state)
{
    (void)state;
    // A bus turns about its front; its tail, 12 m behind, sweeps sideways into a standing car.
    drive bus = {.yaw_rate_rad_s = -1.0, .length_m = 12.0, .width_m = 2.4};
    drive car = {.x_m = -8.0, .y_m = 1.2 + 0.5 + 0.9};
    double time_s;
    assert_true(touch(&bus, &car, 0.1, 0.1, &time_s));
    // Its left rear corner (-12, 1.2) reaches the side of the car, 0.5 m on, at this angle.
    double lever_m = hypot(12.0, 1.2), reached_rad = asin(1.7 / lever_m) - asin(1.2 / lever_m);
    assert_near(time_s, reached_rad, 1e-9);
}

static void what_is_not_a_number_does_not_touch(void **state)
{
    (void)state;
    drive a = {.x_m = NAN}, b = {0};
    double time_s;
    assert_false(touch(&a, &b, 0.1, 0.1, &time_s));
}

/* Separation in the step by looking at many moments: first moment of touch, or none, and the
 * deepest overlap. */
static bool look_closely(const cp_vehicle_motion *a, const cp_vehicle_motion *b, double dt_s,
                         double *first, double *depth_m)
{
    bool touched = false;
    *depth_m = -INFINITY;
    for (int k = 0; k <= 4000; k++) {
        cp_vehicle_state at_a = cp_motion_at(a, dt_s, k / 4000.0);
        cp_vehicle_state at_b = cp_motion_at(b, dt_s, k / 4000.0);
        cp_rectangle one = cp_vehicle_rectangle(&at_a), other = cp_vehicle_rectangle(&at_b);
        double separation_m = cp_rectangle_separation(&one, &other);
        *depth_m = fmax(*depth_m, -separation_m);
        if (separation_m <= 0.0 && !touched) {
            touched = true;
            *first = k / 4000.0;
        }
    }
    return touched;
}

static void random_encounters_agree_with_looking_closely(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_seed(5);
    int touched = 0, clipped = 0;
    for (uint64_t run = 0; run < 600; run++) {
        double u[12];
        for (uint64_t k = 0; k < 12; k++)
            u[k] = cp_rng_uniform(key, 12 * run + k);
        drive one = {.yaw_rad = 6.28 * u[0],
                     .speed_m_s = 35.0 * u[1],
                     .yaw_rate_rad_s = run % 2 ? 2.0 * u[2] - 1.0 : 0.0,
                     .acceleration_m_s2 = run % 2 ? 0.0 : -9.0 * u[2]};
        drive other = {.x_m = 12.0 * u[3] - 6.0,
                       .y_m = 12.0 * u[4] - 6.0,
                       .yaw_rad = 6.28 * u[5],
                       .speed_m_s = 35.0 * u[6],
                       .yaw_rate_rad_s = run % 2 ? 2.0 * u[7] - 1.0 : 0.0,
                       .length_m = 1.0 + 4.0 * u[8],
                       .width_m = 0.5 + 1.5 * u[9]};
        cp_vehicle_motion a = drive_motion(&one, 1, 0.1, 0.1);
        cp_vehicle_motion b = drive_motion(&other, 2, 0.1, 0.1);
        double fraction = -1.0, first = -1.0, depth_m;
        bool found = cp_first_contact(&a, &b, 0.1, &fraction);
        bool seen = look_closely(&a, &b, 0.1, &first, &depth_m);
        if (seen && depth_m > 0.0005)
            assert_true(found);
        if (found && fraction > 0.0) {
            // Just touching there, apart shortly before, and no later than seen.
            cp_vehicle_state at_a = cp_motion_at(&a, 0.1, fraction);
            cp_vehicle_state at_b = cp_motion_at(&b, 0.1, fraction);
            cp_rectangle ra = cp_vehicle_rectangle(&at_a), rb = cp_vehicle_rectangle(&at_b);
            assert_near(cp_rectangle_separation(&ra, &rb), 0.0, 1e-12);
            clipped++;
        }
        if (found && seen && depth_m > 0.01)
            assert_near(fraction, first, 0.01);
        touched += found;
    }
    // The draw holds both kinds.
    assert_true(touched > 100 && touched < 500 && clipped > 50);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(oncoming_cars_touch_at_the_exact_moment),
        cmocka_unit_test(a_braking_car_touches_at_the_exact_moment),
        cmocka_unit_test(nothing_tunnels_at_60_m_s_and_a_tenth_of_a_second),
        cmocka_unit_test(overlap_from_the_beginning_is_fraction_zero),
        cmocka_unit_test(standing_cars_and_platoons_do_not_touch),
        cmocka_unit_test(a_tail_that_swings_out_touches),
        cmocka_unit_test(what_is_not_a_number_does_not_touch),
        cmocka_unit_test(random_encounters_agree_with_looking_closely),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
