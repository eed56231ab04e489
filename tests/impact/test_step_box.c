/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/step_box.h"

#include "core/rng.h"
#include "core/units.h"
#include "impact/footprint.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "builders/drive.h"

#define STEP_S 0.1

static const cp_kept_heading EAST = {.yaw_rad = 0.0, .unit = {1.0, 0.0}};

// All four corners of the rectangle of a state lie in the box.
static void assert_holds(const cp_box *box, const cp_vehicle_state *state)
{
    cp_rectangle rectangle = cp_vehicle_rectangle(state);
    cp_pose pose = {rectangle.centre_m, rectangle.yaw_rad};
    for (int corner = 0; corner < 4; corner++) {
        cp_vec2 local = {(corner < 2 ? 0.5 : -0.5) * rectangle.length_m,
                         (corner % 2 == 0 ? 0.5 : -0.5) * rectangle.width_m};
        cp_vec2 at = cp_pose_to_world(pose, local);
        assert_true(at.x >= box->min_x_m - 1e-9 && at.x <= box->max_x_m + 1e-9);
        assert_true(at.y >= box->min_y_m - 1e-9 && at.y <= box->max_y_m + 1e-9);
    }
}

static drive random_drive(cp_rng_key key, uint64_t index)
{
    double draw[6];
    for (uint64_t k = 0; k < 6; k++)
        draw[k] = cp_rng_uniform(key, 6 * index + k);
    bool turns = draw[5] < 0.5;
    return (drive){.x_m = 100.0 * draw[0],
                   .y_m = 100.0 * draw[1],
                   .yaw_rad = 2.0 * CP_PI * draw[2],
                   .speed_m_s = 30.0 * draw[3],
                   .acceleration_m_s2 = turns ? 0.0 : -9.0 * draw[4],
                   .yaw_rate_rad_s = turns ? 4.0 * (draw[4] - 0.5) : 0.0,
                   .length_m = 3.0 + 15.0 * draw[1]};
}

static void a_box_holds_the_whole_way_through_the_step(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_seed(3);
    cp_kept_heading kept = EAST;
    for (uint32_t car = 0; car < 500; car++) {
        drive way = random_drive(key, car);
        // Two steps: the second begins with the heading the first one kept.
        for (int step = 1; step <= 2; step++) {
            cp_vehicle_motion motion = drive_motion(&way, car, step * STEP_S, STEP_S);
            cp_box box = cp_step_box(&motion, STEP_S, 0.0, &kept);
            assert_true(kept.yaw_rad == motion.after.yaw_rad);
            if (cp_motion_is_jump(&motion, STEP_S))
                continue;
            for (int tenth = 0; tenth <= 10; tenth++) {
                cp_vehicle_state inside = cp_motion_at(&motion, STEP_S, 0.1 * tenth);
                assert_holds(&box, &inside);
            }
        }
    }
}

// What is kept of one vehicle changes nothing of another.
static void a_kept_heading_makes_no_difference(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_seed(4);
    cp_kept_heading kept = EAST;
    for (uint32_t car = 0; car < 200; car++) {
        drive way = random_drive(key, car);
        cp_vehicle_motion motion = drive_motion(&way, car, STEP_S, STEP_S);
        cp_kept_heading fresh = EAST;
        cp_box with = cp_step_box(&motion, STEP_S, 0.05, &kept);
        cp_box without = cp_step_box(&motion, STEP_S, 0.05, &fresh);
        assert_memory_equal(&with, &without, sizeof with);
    }
}

static void a_straight_way_takes_no_more_than_its_ends_and_margin(void **state)
{
    (void)state;
    drive way = {.x_m = 4.5, .speed_m_s = 20.0};
    cp_kept_heading kept = EAST;
    cp_vehicle_motion motion = drive_motion(&way, 0, STEP_S, STEP_S);
    cp_box box = cp_step_box(&motion, STEP_S, 0.05, &kept);
    assert_true(fabs(box.min_x_m - -0.05) < 1e-12 && fabs(box.max_x_m - 6.55) < 1e-12);
    assert_true(fabs(box.min_y_m - -0.95) < 1e-12 && fabs(box.max_y_m - 0.95) < 1e-12);
}

static void a_vehicle_that_was_put_there_is_only_where_it_is(void **state)
{
    (void)state;
    drive way = {.x_m = 4.5, .speed_m_s = 20.0};
    cp_kept_heading kept = EAST;
    cp_vehicle_motion motion = drive_motion(&way, 0, STEP_S, STEP_S);
    motion.after.front_y_m = 3.2; // one lane sideways
    cp_box box = cp_step_box(&motion, STEP_S, 0.0, &kept);
    assert_true(fabs(box.min_x_m - 2.0) < 1e-12 && fabs(box.min_y_m - 2.3) < 1e-12);
    motion = (cp_vehicle_motion){.after = motion.after};
    box = cp_step_box(&motion, STEP_S, 0.0, &kept);
    assert_true(fabs(box.min_x_m - 2.0) < 1e-12 && fabs(box.min_y_m - 2.3) < 1e-12);
}

static void a_state_that_is_nowhere_overlaps_nothing(void **state)
{
    (void)state;
    drive way = {.speed_m_s = 20.0};
    cp_kept_heading kept = EAST;
    cp_vehicle_motion motion = drive_motion(&way, 0, STEP_S, STEP_S), lost = motion;
    lost.after.front_x_m = NAN;
    cp_box box = cp_step_box(&lost, STEP_S, 0.05, &kept);
    assert_true(box.min_x_m > box.max_x_m);
    lost = motion;
    lost.before.yaw_rad = INFINITY;
    box = cp_step_box(&lost, STEP_S, 0.05, &kept);
    assert_true(box.min_x_m > box.max_x_m);
    lost.was_present = false; // there is no before
    box = cp_step_box(&lost, STEP_S, 0.05, &kept);
    assert_true(box.min_x_m < box.max_x_m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_holds_the_whole_way_through_the_step),
        cmocka_unit_test(a_kept_heading_makes_no_difference),
        cmocka_unit_test(a_straight_way_takes_no_more_than_its_ends_and_margin),
        cmocka_unit_test(a_vehicle_that_was_put_there_is_only_where_it_is),
        cmocka_unit_test(a_state_that_is_nowhere_overlaps_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
