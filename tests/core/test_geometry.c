/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/geometry.h"

#include "core/rng.h"
#include "core/units.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "builders/assert_near.h"

static void angles_wrap_into_minus_pi_exclusive_to_pi(void **state)
{
    (void)state;
    assert_near(cp_wrap_angle(0.0), 0.0, 0.0);
    assert_near(cp_wrap_angle(CP_PI), CP_PI, 0.0);
    assert_near(cp_wrap_angle(-CP_PI), CP_PI, 1e-15);
    assert_near(cp_wrap_angle(CP_PI + 0.1), -CP_PI + 0.1, 1e-14);
    assert_near(cp_wrap_angle(-CP_PI - 0.1), CP_PI - 0.1, 1e-14);
    assert_near(cp_wrap_angle(2.0 * CP_PI), 0.0, 1e-15);
    for (double angle = -40.0; angle < 40.0; angle += 0.37) {
        double wrapped = cp_wrap_angle(angle);
        assert_true(wrapped > -CP_PI && wrapped <= CP_PI);
        assert_near(sin(wrapped), sin(angle), 1e-13);
        assert_near(cos(wrapped), cos(angle), 1e-13);
    }
}

static void vectors_turn_counter_clockwise(void **state)
{
    (void)state;
    cp_vec2 turned = cp_vec2_rotate((cp_vec2){2.0, 1.0}, CP_PI / 2.0);
    assert_near(turned.x, -1.0, 1e-15);
    assert_near(turned.y, 2.0, 1e-15);
    assert_near(cp_vec2_heading(CP_PI / 2.0).y, 1.0, 0.0);
    assert_true(cp_vec2_cross((cp_vec2){1, 0}, (cp_vec2){0, 1}) > 0.0);
}

static void points_of_a_turning_body_circle_about_it(void **state)
{
    (void)state;
    // 2 rad/s counter-clockwise: the point in front moves to the left.
    cp_vec2 velocity = cp_point_velocity((cp_vec2){10.0, 0.0}, 2.0, (cp_vec2){1.5, 0.5});
    assert_near(velocity.x, 10.0 - 1.0, 1e-15);
    assert_near(velocity.y, 3.0, 1e-15);
}

static void local_and_world_are_inverse(void **state)
{
    (void)state;
    cp_pose pose = {{100.0, -20.0}, 2.5};
    cp_vec2 left_front = {2.0, 1.0};
    cp_vec2 back = cp_pose_to_local(pose, cp_pose_to_world(pose, left_front));
    assert_near(back.x, 2.0, 1e-12);
    assert_near(back.y, 1.0, 1e-12);
    cp_pose north = {{5.0, 5.0}, CP_PI / 2.0};
    assert_near(cp_pose_to_world(north, left_front).x, 4.0, 1e-12);
    assert_near(cp_pose_to_world(north, left_front).y, 7.0, 1e-12);
}

static void corners_run_counter_clockwise_from_front_left(void **state)
{
    (void)state;
    cp_rectangle car = {{10.0, 0.0}, CP_PI / 2.0, 4.0, 2.0};
    cp_vec2 corner[4];
    cp_rectangle_corners(&car, corner);
    static const double X[] = {9, 9, 11, 11}, Y[] = {2, -2, -2, 2};
    for (int k = 0; k < 4; k++) {
        assert_near(corner[k].x, X[k], 1e-12);
        assert_near(corner[k].y, Y[k], 1e-12);
    }
}

static void separation_is_gap_or_depth(void **state)
{
    (void)state;
    cp_rectangle a = {{0, 0}, 0.0, 4.0, 2.0}, b = {{5.0, 0}, 0.0, 4.0, 2.0};
    assert_near(cp_rectangle_separation(&a, &b), 1.0, 1e-12);
    b.centre_m.x = 3.7;
    assert_near(cp_rectangle_separation(&a, &b), -0.3, 1e-12);
    b.yaw_rad = CP_PI / 2.0; // now it lies across
    assert_near(cp_rectangle_separation(&a, &b), 0.7, 1e-12);
    b = (cp_rectangle){{2.0 + sqrt(2.0), 0.0}, CP_PI / 4.0, 2.0, 2.0}; // a corner ahead
    assert_near(cp_rectangle_separation(&a, &b), 0.0, 1e-12);
}

static void separation_is_symmetric_and_its_depth_parts_them(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_seed(4);
    for (uint64_t run = 0; run < 500; run++) {
        double u[5];
        for (uint64_t k = 0; k < 5; k++)
            u[k] = cp_rng_uniform(key, 5 * run + k);
        cp_rectangle a = {{0, 0}, 6.0 * u[0], 4.5, 1.8};
        cp_rectangle b = {{6.0 * u[1] - 3.0, 6.0 * u[2] - 3.0}, 6.0 * u[3], 3.0 + u[4], 1.5};
        double separation = cp_rectangle_separation(&a, &b);
        assert_near(cp_rectangle_separation(&b, &a), separation, 1e-12);
        if (separation >= 0.0)
            continue;
        // Some direction parts them by the depth; none by less.
        double best = -INFINITY, less = -INFINITY;
        for (int k = 0; k < 720; k++) {
            cp_vec2 way = cp_vec2_heading(k * CP_PI / 360.0);
            cp_rectangle moved = b;
            moved.centre_m = cp_vec2_add(b.centre_m, cp_vec2_scale(way, -1.001 * separation));
            best = fmax(best, cp_rectangle_separation(&a, &moved));
            moved.centre_m = cp_vec2_add(b.centre_m, cp_vec2_scale(way, -0.99 * separation));
            less = fmax(less, cp_rectangle_separation(&a, &moved));
        }
        assert_true(best >= -1e-4);
        assert_true(less < 0.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(angles_wrap_into_minus_pi_exclusive_to_pi),
        cmocka_unit_test(vectors_turn_counter_clockwise),
        cmocka_unit_test(points_of_a_turning_body_circle_about_it),
        cmocka_unit_test(local_and_world_are_inverse),
        cmocka_unit_test(corners_run_counter_clockwise_from_front_left),
        cmocka_unit_test(separation_is_gap_or_depth),
        cmocka_unit_test(separation_is_symmetric_and_its_depth_parts_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
