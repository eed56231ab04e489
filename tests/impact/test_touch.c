/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/touch.h"

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

/* Car of 4 m x 2 m by the middle of its front. */
static cp_touching_body car(double front_x_m, double front_y_m, double yaw_rad, double speed_m_s)
{
    cp_vec2 along = cp_vec2_heading(yaw_rad);
    return (cp_touching_body){
        .rectangle = {{front_x_m - 2.0 * along.x, front_y_m - 2.0 * along.y}, yaw_rad, 4.0, 2.0},
        .front_velocity_m_s = cp_vec2_scale(along, speed_m_s)};
}

static void assert_touch(cp_touching_body a, cp_touching_body b, double x_m, double y_m,
                         cp_contact_side side_a, cp_contact_side side_b)
{
    cp_touching_body body[2] = {a, b};
    cp_first_touch touch = cp_touch_of(body);
    assert_near(touch.point_m.x, x_m, 1e-9);
    assert_near(touch.point_m.y, y_m, 1e-9);
    assert_int_equal(touch.side[0], side_a);
    assert_int_equal(touch.side[1], side_b);

    // The same two the other way round.
    cp_touching_body swapped[2] = {b, a};
    touch = cp_touch_of(swapped);
    assert_near(touch.point_m.x, x_m, 1e-9);
    assert_near(touch.point_m.y, y_m, 1e-9);
    assert_int_equal(touch.side[0], side_b);
    assert_int_equal(touch.side[1], side_a);
}

static void parallel_edges_touch_in_the_middle_of_their_common_stretch(void **state)
{
    (void)state;
    // Oncoming, 1.2 m aside: common stretch 0.2 .. 1.0.
    assert_touch(car(0, 0, 0, 10), car(0, 1.2, CP_PI, 10), 0.0, 0.6, CP_SIDE_FRONT, CP_SIDE_FRONT);
    // Into the rear of a car ahead.
    assert_touch(car(0, 0, 0, 10), car(4, -0.5, 0, 5), 0.0, -0.25, CP_SIDE_FRONT, CP_SIDE_REAR);
    // Square into the left side of one that crosses northwards.
    assert_touch(car(0, 0, 0, 10), car(1, 2, CP_PI / 2, 5), 0.0, 0.0, CP_SIDE_FRONT, CP_SIDE_LEFT);
    // Side by side.
    assert_touch(car(0, 0, 0, 10), car(1, -2, 0, 5), -1.5, -1.0, CP_SIDE_RIGHT, CP_SIDE_LEFT);
    assert_touch(car(0, 0, 0, 10), car(-1, 2, CP_PI, 5), -0.5, 1.0, CP_SIDE_LEFT, CP_SIDE_LEFT);
}

static void a_whiff_of_yaw_does_not_move_the_point_to_a_corner(void **state)
{
    (void)state;
    cp_touching_body body[2] = {car(0, 0, 0, 10), car(0, 0.4, CP_PI + 0.002, 10)};
    cp_first_touch touch = cp_touch_of(body);
    assert_near(touch.point_m.y, 0.2, 0.005);
    assert_int_equal(touch.side[0], CP_SIDE_FRONT);
    assert_int_equal(touch.side[1], CP_SIDE_FRONT);
}

/* b, its left front corner at (x, y), heading yaw. */
static cp_touching_body by_left_front_corner(double x_m, double y_m, double yaw_rad, double speed)
{
    cp_vec2 left = cp_vec2_heading(yaw_rad + CP_PI / 2);
    return car(x_m - left.x, y_m - left.y, yaw_rad, speed);
}

static void a_corner_takes_the_edge_that_meets_the_other(void **state)
{
    (void)state;
    // Oblique and fast: b's left front corner on a's front, b's front meets a.
    assert_touch(car(0, 0, 0, 10), by_left_front_corner(0, 0.5, CP_PI - 0.5, 10), 0.0, 0.5,
                 CP_SIDE_FRONT, CP_SIDE_FRONT);
    // b stands across: its flank is what a runs into; at a flatter angle its front.
    assert_touch(car(0, 0, 0, 10), by_left_front_corner(0, -0.5, CP_PI / 2 + 0.3, 0), 0.0, -0.5,
                 CP_SIDE_FRONT, CP_SIDE_LEFT);
    assert_touch(car(0, 0, 0, 10), by_left_front_corner(0, -0.5, CP_PI / 2 + 1.0, 0), 0.0, -0.5,
                 CP_SIDE_FRONT, CP_SIDE_FRONT);
    // Corner on a's side, b driving into it.
    assert_touch(car(0, 0, 0, 5), by_left_front_corner(-1.0, -1.0, 1.0, 10), -1.0, -1.0,
                 CP_SIDE_RIGHT, CP_SIDE_FRONT);
}

static void corner_on_corner_is_decided_by_velocity_for_both(void **state)
{
    (void)state;
    // Oncoming cars just clipping: fronts. The same place, closing sideways: flanks.
    assert_touch(car(0, 0, 0, 10), car(0, 2.0, CP_PI, 10), 0.0, 1.0, CP_SIDE_FRONT, CP_SIDE_FRONT);
    cp_touching_body a = car(0, 0, 0, 0), b = car(0, 2.0, CP_PI, 0);
    a.front_velocity_m_s = (cp_vec2){0.0, 1.0};
    assert_touch(a, b, 0.0, 1.0, CP_SIDE_LEFT, CP_SIDE_LEFT);
}

static void turning_counts_in_the_velocity_at_the_corner(void **state)
{
    (void)state;
    // Standing side by side, corner on corner; a's front swings left into b.
    cp_touching_body a = car(0, 0, 0, 0), b = car(4.0, 2.0, 0, 0);
    a.yaw_rate_rad_s = 0.5; // about its front: the left corner moves back, against nothing
    a.front_velocity_m_s = (cp_vec2){0.0, 1.0};
    cp_touching_body body[2] = {a, b};
    assert_int_equal(cp_touch_of(body).side[0], CP_SIDE_LEFT);
    a.front_velocity_m_s = (cp_vec2){2.0, 0.3};
    cp_touching_body forward[2] = {a, b};
    assert_int_equal(cp_touch_of(forward).side[0], CP_SIDE_FRONT);
    assert_int_equal(cp_touch_of(forward).side[1], CP_SIDE_REAR);
    a.yaw_rate_rad_s = 1.9; // now the corner itself moves back faster than the car goes on
    cp_touching_body swinging[2] = {a, b};
    assert_int_equal(cp_touch_of(swinging).side[0], CP_SIDE_LEFT);
}

static const cp_contact_side MIRRORED[] = {
    [CP_SIDE_FRONT] = CP_SIDE_FRONT,
    [CP_SIDE_LEFT] = CP_SIDE_RIGHT,
    [CP_SIDE_RIGHT] = CP_SIDE_LEFT,
    [CP_SIDE_REAR] = CP_SIDE_REAR,
};

static cp_touching_body mirror(cp_touching_body body)
{
    body.rectangle.centre_m.y *= -1.0;
    body.rectangle.yaw_rad *= -1.0;
    body.front_velocity_m_s.y *= -1.0;
    body.yaw_rate_rad_s *= -1.0;
    return body;
}

static cp_touching_body turn(cp_touching_body body, double angle_rad)
{
    body.rectangle.centre_m = cp_vec2_rotate(body.rectangle.centre_m, angle_rad);
    body.rectangle.yaw_rad += angle_rad;
    body.front_velocity_m_s = cp_vec2_rotate(body.front_velocity_m_s, angle_rad);
    return body;
}

/* Random cars pushed together until they just touch: point on both outlines; mirrored and turned
 * scenes give mirrored and turned answers. */
static void mirrored_and_turned_scenes_give_the_same_answer(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_seed(3);
    for (uint64_t run = 0; run < 500; run++) {
        double u[5];
        for (uint64_t k = 0; k < 5; k++)
            u[k] = cp_rng_uniform(key, 5 * run + k);
        cp_touching_body body[2] = {car(0, 0, 0, 20 * u[0]), car(0, 0, 6.28 * u[1], 20 * u[2])};
        cp_vec2 away = cp_vec2_heading(6.28 * u[3]);
        double near_m = 0.0, far_m = 20.0;
        cp_vec2 origin_m = body[1].rectangle.centre_m;
        for (int k = 0; k < 100; k++) {
            double middle_m = 0.5 * (near_m + far_m);
            body[1].rectangle.centre_m = cp_vec2_add(origin_m, cp_vec2_scale(away, middle_m));
            bool apart = cp_rectangle_separation(&body[0].rectangle, &body[1].rectangle) > 0.0;
            *(apart ? &far_m : &near_m) = middle_m;
        }
        cp_first_touch touch = cp_touch_of(body);
        for (int k = 0; k < 2; k++) {
            cp_vec2 local = cp_pose_to_local(
                (cp_pose){body[k].rectangle.centre_m, body[k].rectangle.yaw_rad}, touch.point_m);
            assert_near(fmax(fabs(local.x) - 2.0, fabs(local.y) - 1.0), 0.0, 0.011);
        }

        cp_touching_body mirrored[2] = {mirror(body[0]), mirror(body[1])};
        cp_first_touch reflection = cp_touch_of(mirrored);
        cp_touching_body turned[2] = {turn(body[0], u[4]), turn(body[1], u[4])};
        cp_first_touch rotation = cp_touch_of(turned);
        cp_vec2 point_m = cp_vec2_rotate(rotation.point_m, -u[4]);
        assert_near(reflection.point_m.x, touch.point_m.x, 1e-9);
        assert_near(reflection.point_m.y, -touch.point_m.y, 1e-9);
        assert_near(point_m.x, touch.point_m.x, 1e-9);
        assert_near(point_m.y, touch.point_m.y, 1e-9);
        for (int k = 0; k < 2; k++) {
            assert_int_equal(reflection.side[k], MIRRORED[touch.side[k]]);
            assert_int_equal(rotation.side[k], touch.side[k]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parallel_edges_touch_in_the_middle_of_their_common_stretch),
        cmocka_unit_test(a_whiff_of_yaw_does_not_move_the_point_to_a_corner),
        cmocka_unit_test(a_corner_takes_the_edge_that_meets_the_other),
        cmocka_unit_test(corner_on_corner_is_decided_by_velocity_for_both),
        cmocka_unit_test(turning_counts_in_the_velocity_at_the_corner),
        cmocka_unit_test(mirrored_and_turned_scenes_give_the_same_answer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
