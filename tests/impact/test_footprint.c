/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/footprint.h"

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

static void the_rectangle_hangs_behind_the_front_bumper(void **state)
{
    (void)state;
    cp_vehicle_state car = {.front_x_m = 10.0,
                            .front_y_m = 20.0,
                            .yaw_rad = CP_PI / 2.0,
                            .length_m = 4.0,
                            .width_m = 1.8};
    cp_rectangle r = cp_vehicle_rectangle(&car);
    assert_near(r.centre_m.x, 10.0, 1e-12);
    assert_near(r.centre_m.y, 18.0, 1e-12);
    assert_near(r.length_m, 4.0, 0.0);
    assert_near(r.width_m, 1.8, 0.0);
}

static void braking_inside_the_step_follows_the_closed_form(void **state)
{
    (void)state;
    drive car = {.x_m = 3.0, .yaw_rad = 0.4, .speed_m_s = 12.0, .acceleration_m_s2 = -8.0};
    for (double dt_s = 0.01; dt_s < 1.0; dt_s *= 3.0) {
        cp_vehicle_motion motion = drive_motion(&car, 1, 0.3 + dt_s, dt_s);
        for (double fraction = 0.0; fraction <= 1.0; fraction += 0.125) {
            cp_vehicle_state inside = cp_motion_at(&motion, dt_s, fraction);
            cp_vehicle_state exact = drive_state(&car, 1, 0.3 + fraction * dt_s);
            assert_near(inside.front_x_m, exact.front_x_m, 1e-11);
            assert_near(inside.front_y_m, exact.front_y_m, 1e-11);
            assert_near(inside.speed_m_s, exact.speed_m_s, 1e-11);
            cp_vec2 velocity = cp_motion_front_velocity(&motion, dt_s, fraction);
            assert_near(velocity.x, exact.speed_m_s * cos(0.4), 1e-9);
            assert_near(velocity.y, exact.speed_m_s * sin(0.4), 1e-9);
        }
    }
}

static void a_car_that_stops_inside_the_step_stands_from_there_on(void **state)
{
    (void)state;
    drive car = {.speed_m_s = 2.0, .acceleration_m_s2 = -8.0}; // at rest after 0.25 s and 0.25 m
    cp_vehicle_motion motion = drive_motion(&car, 1, 1.0, 1.0);
    for (double fraction = 0.0; fraction <= 1.0; fraction += 0.05) {
        cp_vehicle_state inside = cp_motion_at(&motion, 1.0, fraction);
        cp_vehicle_state exact = drive_state(&car, 1, fraction);
        assert_near(inside.front_x_m, exact.front_x_m, 1e-12);
        assert_near(inside.speed_m_s, exact.speed_m_s, 1e-12);
    }
}

static void the_ends_are_the_states_to_the_bit(void **state)
{
    (void)state;
    drive car = {
        .x_m = 1234.567, .y_m = -0.1, .yaw_rad = 3.0, .speed_m_s = 11.1, .yaw_rate_rad_s = 0.7};
    cp_vehicle_motion motion = drive_motion(&car, 1, 0.7, 0.1);
    cp_vehicle_state first = cp_motion_at(&motion, 0.1, 0.0),
                     last = cp_motion_at(&motion, 0.1, 1.0);
    assert_memory_equal(&first, &motion.before, sizeof first);
    assert_memory_equal(&last, &motion.after, sizeof last);
}

static void headings_turn_the_short_way_round(void **state)
{
    (void)state;
    cp_vehicle_motion motion = {.was_present = true};
    motion.before.yaw_rad = CP_PI - 0.1;
    motion.after.yaw_rad = -CP_PI + 0.3;
    assert_near(cp_motion_at(&motion, 0.1, 0.5).yaw_rad, -CP_PI + 0.1, 1e-12);
}

static void a_vehicle_just_inserted_is_where_it_is(void **state)
{
    (void)state;
    cp_vehicle_motion motion = {.after = {.front_x_m = 5.0, .yaw_rad = 1.0, .speed_m_s = 3.0}};
    assert_near(cp_motion_at(&motion, 0.1, 0.2).front_x_m, 5.0, 0.0);
    assert_near(cp_motion_front_velocity(&motion, 0.1, 0.2).y, 3.0 * sin(1.0), 1e-12);
    assert_true(cp_motion_is_jump(&motion, 0.1));
}

static void lane_changes_show_in_the_velocity_but_instant_ones_are_jumps(void **state)
{
    (void)state;
    // 1 m/s to the left at 20 m/s ahead.
    drive car = {.speed_m_s = 20.0};
    cp_vehicle_motion motion = drive_motion(&car, 1, 0.1, 0.1);
    motion.after.front_y_m += 0.1;
    assert_false(cp_motion_is_jump(&motion, 0.1));
    assert_near(cp_motion_front_velocity(&motion, 0.1, 0.5).y, 1.0, 1e-9);
    assert_near(cp_motion_front_velocity(&motion, 0.1, 0.5).x, 20.0, 1e-9);

    // A whole lane in one step was set down there.
    motion.after.front_y_m += 3.2;
    assert_true(cp_motion_is_jump(&motion, 0.1));
    assert_near(cp_motion_front_velocity(&motion, 0.1, 0.5).y, 0.0, 1e-9);

    // A car in a tight turn was driven.
    drive turning = {.speed_m_s = 8.0, .yaw_rate_rad_s = 1.2};
    motion = drive_motion(&turning, 1, 0.1, 0.1);
    assert_false(cp_motion_is_jump(&motion, 0.1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rectangle_hangs_behind_the_front_bumper),
        cmocka_unit_test(braking_inside_the_step_follows_the_closed_form),
        cmocka_unit_test(a_car_that_stops_inside_the_step_stands_from_there_on),
        cmocka_unit_test(the_ends_are_the_states_to_the_bit),
        cmocka_unit_test(headings_turn_the_short_way_round),
        cmocka_unit_test(a_vehicle_just_inserted_is_where_it_is),
        cmocka_unit_test(lane_changes_show_in_the_velocity_but_instant_ones_are_jumps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
