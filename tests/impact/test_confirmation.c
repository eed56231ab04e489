/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/confirmation.h"

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

static cp_touching_body car(double front_x_m, double front_y_m, double yaw_rad, double speed_m_s)
{
    cp_vec2 along = cp_vec2_heading(yaw_rad);
    return (cp_touching_body){
        .rectangle = {{front_x_m - 2.0 * along.x, front_y_m - 2.0 * along.y}, yaw_rad, 4.0, 2.0},
        .front_velocity_m_s = cp_vec2_scale(along, speed_m_s)};
}

static bool is_crash(cp_touching_body a, cp_touching_body b)
{
    cp_touching_body body[2] = {a, b};
    cp_first_touch touch = cp_touch_of(body);
    return cp_contact_is_crash(body, &touch);
}

static void a_rear_impact_counts_from_400_mm_in_half_a_second(void **state)
{
    (void)state;
    for (double ahead_m_s = 0.0; ahead_m_s < 30.0; ahead_m_s += 7.0) {
        assert_true(is_crash(car(0, 0, 0, ahead_m_s + 0.81), car(4, 0, 0, ahead_m_s)));
        assert_false(is_crash(car(0, 0, 0, ahead_m_s + 0.79), car(4, 0, 0, ahead_m_s)));
    }
}

static void front_on_front_counts_from_a_tenth_of_the_width(void **state)
{
    (void)state;
    assert_true(is_crash(car(0, 0, 0, 0.5), car(0, 1.79, CP_PI, 0.5)));
    assert_false(is_crash(car(0, 0, 0, 0.5), car(0, 1.81, CP_PI, 0.5)));
    // Of the narrower, whichever comes first; slower than 0.8 m/s nothing is struck.
    for (double overlap_m = 0.09; overlap_m < 0.12; overlap_m += 0.02) {
        cp_touching_body narrow = car(0, 1.5 - overlap_m, CP_PI, 5);
        narrow.rectangle.width_m = 1.0;
        assert_int_equal(is_crash(car(0, 0, 0, 5), narrow), overlap_m > 0.1);
        assert_int_equal(is_crash(narrow, car(0, 0, 0, 5)), overlap_m > 0.1);
    }
    assert_false(is_crash(car(0, 0, 0, 0.39), car(0, 0, CP_PI, 0.4)));
    assert_true(is_crash(car(0, 0, 0, 0.41), car(0, 0, CP_PI, 0.4)));
    // Fast but thin: parted by less than 0.4 m sideways at any time.
    assert_false(is_crash(car(0, 0, 0, 20), car(0, 1.81, CP_PI, 20)));
    // Thin and turning in: goes deep.
    cp_touching_body turning = car(0, 1.81, CP_PI, 10);
    turning.yaw_rate_rad_s = 3.0;
    assert_true(is_crash(car(0, 0, 0, 10), turning));
}

/* A car standing obliquely, its flank to the other, whose highest corner reaches `reach_m` into the
 * way of one that drives east at 15 m/s, just touching it. */
static bool clip_is_crash(double reach_m)
{
    cp_touching_body waiting = car(0.0, 0.0, CP_PI / 2 - 0.6, 0.0), passing = car(0, 0, 0, 15.0);
    cp_vec2 corners_m[4];
    cp_rectangle_corners(&waiting.rectangle, corners_m);
    double highest_m = -INFINITY;
    for (int k = 0; k < 4; k++)
        highest_m = fmax(highest_m, corners_m[k].y);
    passing.rectangle.centre_m = (cp_vec2){-20.0, highest_m - reach_m + 1.0};
    for (int k = 0; k < 1000; k++)
        passing.rectangle.centre_m.x +=
            cp_rectangle_separation(&passing.rectangle, &waiting.rectangle);
    assert_near(cp_rectangle_separation(&passing.rectangle, &waiting.rectangle), 0.0, 1e-9);
    return is_crash(passing, waiting);
}

static void a_clipped_waiting_car_is_a_graze(void **state)
{
    (void)state;
    assert_false(clip_is_crash(0.2));
    assert_false(clip_is_crash(0.38));
    assert_true(clip_is_crash(0.42));
    assert_true(clip_is_crash(1.5));
}

/* A car that stands or creeps turned, its front corner `reach_m` in the way of one that passes: its
 * flank, behind the corner, leads away from the way or into it. */
static bool corner_is_crash(double turned_rad, double reach_m, double creep_m_s, bool swap)
{
    cp_touching_body passing = car(0, 0, CP_PI, 11.0), turned = car(0, 0, turned_rad, creep_m_s);
    cp_vec2 corner_m =
        cp_pose_to_world((cp_pose){turned.rectangle.centre_m, turned.rectangle.yaw_rad},
                         (cp_vec2){2.0, 1.0}); // front left
    passing.rectangle.centre_m = (cp_vec2){30.0, corner_m.y - reach_m + 1.0};
    for (int k = 0; k < 1000; k++)
        passing.rectangle.centre_m.x -=
            cp_rectangle_separation(&passing.rectangle, &turned.rectangle);
    return swap ? is_crash(turned, passing) : is_crash(passing, turned);
}

static void a_brushed_corner_is_no_front_on_front(void **state)
{
    (void)state;
    for (int swap = 0; swap < 2; swap++)
        for (double creep_m_s = 0.0; creep_m_s < 2.0; creep_m_s += 0.3) {
            // Turned by 16 degrees with the flank away from the way, and into it.
            assert_false(corner_is_crash(0.28, 0.14, creep_m_s, swap));
            assert_true(corner_is_crash(0.28, 0.5, creep_m_s, swap));
            assert_true(corner_is_crash(-0.28, 0.14, creep_m_s, swap));
        }
}

static void front_edges_meet_across_the_relative_velocity(void **state)
{
    (void)state;
    cp_touching_body body[2] = {car(0, 0, 0, 10), car(0, 1.5, CP_PI, 10)};
    assert_near(cp_front_edges_overlap_m(body), 0.5, 1e-12);
    // Turned by 30 degrees, standing: its edge covers 2 cos 30 across.
    body[1] = car(0, 1.5, CP_PI - CP_PI / 6, 0);
    assert_near(cp_front_edges_overlap_m(body), 1.0 - (1.5 - cos(CP_PI / 6)), 1e-12);
    cp_touching_body swapped[2] = {body[1], body[0]};
    assert_near(cp_front_edges_overlap_m(swapped), cp_front_edges_overlap_m(body), 1e-12);
    // In a queue, side by side, nothing moves.
    body[0].front_velocity_m_s = (cp_vec2){0, 0};
    assert_true(cp_front_edges_overlap_m(body) == -INFINITY);
}

// Straight on from 0.8 m/s; at 1 m/s also at an angle, when it would go deep; never slower.
static void a_slow_touch_at_an_angle_counts_like_one_straight_on(void **state)
{
    (void)state;
    for (double turned_rad = 0.0; turned_rad < 0.75; turned_rad += 0.1) {
        // A flank turned away from square, in the middle of a car's way (further: its front).
        for (double speed_m_s = 0.75; speed_m_s < 3.0; speed_m_s += 0.1) {
            cp_touching_body moving = car(0, 0, 0, speed_m_s), flank = car(0, 0, 0, 0);
            flank.rectangle.yaw_rad = CP_PI / 2 + turned_rad;
            flank.rectangle.centre_m = (cp_vec2){10.0, 0.0};
            for (int k = 0; k < 1000; k++)
                flank.rectangle.centre_m.x -=
                    cp_rectangle_separation(&moving.rectangle, &flank.rectangle);
            assert_int_equal(is_crash(moving, flank), speed_m_s > 0.8);
        }
    }
}

static void a_constant_turn_follows_its_circle(void **state)
{
    (void)state;
    cp_touching_body body = car(5, 0, CP_PI / 2, 10.0);
    body.yaw_rate_rad_s = 2.0; // radius 5 about the origin
    for (double time_s = 0.0; time_s < 3.0; time_s += 0.1) {
        cp_rectangle later = cp_touching_body_later(&body, time_s);
        cp_vec2 front =
            cp_vec2_add(later.centre_m, cp_vec2_scale(cp_vec2_heading(later.yaw_rad), 2.0));
        assert_near(front.x, 5.0 * cos(2.0 * time_s), 1e-12);
        assert_near(front.y, 5.0 * sin(2.0 * time_s), 1e-12);
        assert_near(cp_wrap_angle(later.yaw_rad - CP_PI / 2 - 2.0 * time_s), 0.0, 1e-12);
    }
}

static void what_lies_in_the_way_is_measured_across_the_heading(void **state)
{
    (void)state;
    cp_rectangle moving = {.length_m = 12.0, .width_m = 2.5};
    cp_rectangle standing = {.centre_m = {20.0, 1.85}, .length_m = 4.5, .width_m = 1.8};
    assert_near(cp_width_in_way_m(&moving, &standing), 0.3, 1e-12);
    standing.yaw_rad = CP_PI / 2; // its length of 4.5 m across
    assert_near(cp_width_in_way_m(&moving, &standing), 1.65, 1e-12);
    standing.centre_m.y = 4.0;
    assert_true(cp_width_in_way_m(&moving, &standing) < 0.0);
}

static void a_vehicle_that_slides_or_spins_is_no_vehicle(void **state)
{
    (void)state;
    cp_touching_body car = {.rectangle = {.length_m = 4.5, .width_m = 1.8},
                            .front_velocity_m_s = {10.0, 0.0}};
    assert_false(cp_motion_is_impossible(&car));
    // Turning on a circle of 6 m: the front moves to the inside by half the length.
    car.front_velocity_m_s = (cp_vec2){6.0, 2.25};
    car.yaw_rate_rad_s = 1.0;
    assert_false(cp_motion_is_impossible(&car));
    car.yaw_rate_rad_s = -1.0;
    assert_true(cp_motion_is_impossible(&car));
    // A lane change at 1 m/s; sideways at 4.
    car = (cp_touching_body){.rectangle = {.length_m = 4.5, .width_m = 1.8},
                             .front_velocity_m_s = {3.0, 1.0}};
    assert_false(cp_motion_is_impossible(&car));
    car.front_velocity_m_s = (cp_vec2){8.0, 4.0};
    assert_true(cp_motion_is_impossible(&car));
    // A bus that turns about its own middle; a car that stands.
    car = (cp_touching_body){.rectangle = {.length_m = 12.0, .width_m = 2.5},
                             .front_velocity_m_s = {3.0, 2.0},
                             .yaw_rate_rad_s = 1.0};
    assert_true(cp_motion_is_impossible(&car));
    car =
        (cp_touching_body){.rectangle = {.length_m = 4.5, .width_m = 1.8}, .yaw_rate_rad_s = 1e-6};
    assert_false(cp_motion_is_impossible(&car));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rear_impact_counts_from_400_mm_in_half_a_second),
        cmocka_unit_test(front_on_front_counts_from_a_tenth_of_the_width),
        cmocka_unit_test(a_clipped_waiting_car_is_a_graze),
        cmocka_unit_test(a_brushed_corner_is_no_front_on_front),
        cmocka_unit_test(front_edges_meet_across_the_relative_velocity),
        cmocka_unit_test(what_lies_in_the_way_is_measured_across_the_heading),
        cmocka_unit_test(a_vehicle_that_slides_or_spins_is_no_vehicle),
        cmocka_unit_test(a_slow_touch_at_an_angle_counts_like_one_straight_on),
        cmocka_unit_test(a_constant_turn_follows_its_circle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
