/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/sensor.h"

#include "core/rng.h"
#include "core/units.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const cp_sensor SENSOR = {50.0, 60.0 * CP_PI / 180.0, 0.1};

// Own car's front in the origin, turned by yaw; target 4 m by 2 m, given in the own frame.
static bool sees(double yaw_rad, double ahead_m, double left_m, double target_yaw_rad)
{
    cp_pose pose = {{0.0, 0.0}, yaw_rad};
    cp_rectangle own = {cp_pose_to_world(pose, (cp_vec2){-2.0, 0.0}), yaw_rad, 4.0, 2.0};
    cp_rectangle target = {cp_pose_to_world(pose, (cp_vec2){ahead_m, left_m}),
                           yaw_rad + target_yaw_rad, 4.0, 2.0};
    return cp_sensor_sees(&SENSOR, &own, &target, NULL, 0);
}

static void sees_ahead_within_range_and_angle(void **unused)
{
    (void)unused;
    for (double yaw_rad = -3.0; yaw_rad < 3.0; yaw_rad += 0.7) {
        assert_true(sees(yaw_rad, 30.0, 0.0, 0.0));
        // The near end counts.
        assert_true(sees(yaw_rad, 51.9, 0.0, 0.0));
        assert_false(sees(yaw_rad, 52.1, 0.0, 0.0));
        assert_false(sees(yaw_rad, -10.0, 0.0, 0.0));
        // 30 degrees to either side: at 20 m ahead 11.5 m aside, plus half a width.
        assert_true(sees(yaw_rad, 18.0, 12.4, 0.0));
        assert_true(sees(yaw_rad, 18.0, -12.4, 0.0));
        assert_false(sees(yaw_rad, 18.0, 12.7, 0.0));
        assert_false(sees(yaw_rad, 18.0, -12.7, 0.0));
    }
}

// ---- against a look at everything ----------------------------------------------------------

static double side_of(cp_vec2 a, cp_vec2 b, cp_vec2 point)
{
    return cp_vec2_cross(cp_vec2_sub(b, a), cp_vec2_sub(point, a));
}

static bool cross_each_other(cp_vec2 a, cp_vec2 b, cp_vec2 c, cp_vec2 d)
{
    return side_of(a, b, c) * side_of(a, b, d) < 0.0 && side_of(c, d, a) * side_of(c, d, b) < 0.0;
}

static cp_vec2 point_of(const cp_rectangle *rectangle, double along_1, double across_1)
{
    cp_pose pose = {rectangle->centre_m, rectangle->yaw_rad};
    return cp_pose_to_world(
        pose, (cp_vec2){0.5 * along_1 * rectangle->length_m, 0.5 * across_1 * rectangle->width_m});
}

static bool is_inside(const cp_rectangle *rectangle, cp_vec2 point_m)
{
    cp_pose pose = {rectangle->centre_m, rectangle->yaw_rad};
    cp_vec2 local = cp_pose_to_local(pose, point_m);
    return fabs(local.x) < 0.5 * rectangle->length_m && fabs(local.y) < 0.5 * rectangle->width_m;
}

// A way leads through a rectangle that has an end of it inside or one of its sides across it.
static bool hides(const cp_rectangle *screen, cp_vec2 from_m, cp_vec2 to_m)
{
    static const double CORNER[5][2] = {{1, 1}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1}};
    bool does = is_inside(screen, from_m) || is_inside(screen, to_m);
    for (int k = 0; k < 4; k++)
        does |=
            cross_each_other(point_of(screen, CORNER[k][0], CORNER[k][1]),
                             point_of(screen, CORNER[k + 1][0], CORNER[k + 1][1]), from_m, to_m);
    return does;
}

static bool sees_plainly(const cp_rectangle *own, const cp_rectangle *target,
                         const cp_rectangle *const *screens, size_t screen_count)
{
    cp_pose mounting = {point_of(own, 1.0, 0.0), own->yaw_rad};
    bool does = false;
    for (int along = -1; along <= 1; along++)
        for (int across = -1; across <= 1; across++) {
            cp_vec2 point_m = point_of(target, along, across);
            cp_vec2 seen_m = cp_pose_to_local(mounting, point_m);
            bool visible = cp_vec2_length(seen_m) <= SENSOR.range_m &&
                           fabs(atan2(seen_m.y, seen_m.x)) <= 0.5 * SENSOR.field_of_view_rad;
            for (size_t k = 0; k < screen_count; k++)
                visible &= screens[k] == own || screens[k] == target ||
                           !hides(screens[k], mounting.position_m, point_m);
            does |= visible;
        }
    return does;
}

#define VEHICLES 200

// What is passed over as too far aside, behind or out of the way makes no difference: few vehicles
// around and many, at all distances.
static void a_short_look_sees_what_a_long_one_does(void **unused)
{
    (void)unused;
    cp_rng_key key = cp_rng_key_seed(9);
    size_t seen = 0, unseen = 0;
    uint64_t draw = 0;
    for (int scene = 0; scene < 400; scene++) {
        cp_rectangle vehicle[VEHICLES];
        const cp_rectangle *screens[VEHICLES];
        size_t count = 2 + (size_t)(cp_rng_uniform(key, draw++) * (scene % 2 == 0 ? 20 : 198));
        for (size_t k = 0; k < count; k++) {
            double x_m = (cp_rng_uniform(key, draw++) - 0.5) * 140.0;
            double y_m = (cp_rng_uniform(key, draw++) - 0.5) * (scene % 4 == 1 ? 4.0 : 140.0);
            double yaw_rad = 2.0 * CP_PI * cp_rng_uniform(key, draw++);
            double length_m = 3.0 + 15.0 * cp_rng_uniform(key, draw++);
            double width_m = 1.5 + cp_rng_uniform(key, draw++);
            vehicle[k] = (cp_rectangle){{x_m, y_m}, yaw_rad, length_m, width_m};
            screens[k] = &vehicle[k];
        }
        for (size_t k = 1; k < count; k++) {
            bool sees = cp_sensor_sees(&SENSOR, &vehicle[0], &vehicle[k], screens, count);
            assert_int_equal(sees, sees_plainly(&vehicle[0], &vehicle[k], screens, count));
            seen += sees;
            unseen += !sees;
        }
    }
    assert_true(seen > 200 && unseen > 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sees_ahead_within_range_and_angle),
                                       cmocka_unit_test(a_short_look_sees_what_a_long_one_does)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
