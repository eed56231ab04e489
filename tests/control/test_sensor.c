/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/sensor.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sees_ahead_within_range_and_angle)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
