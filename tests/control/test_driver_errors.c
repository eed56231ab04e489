/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control.h"

#include "control/scripted_road.h"
#include "core/units.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

#include "builders/assert_near.h"

/* Misjudged gap, red light, late braking: who is commanded what, and when. */

static cp_controls *create(const cp_traffic *traffic, const char *model, const char *const *names,
                           const double *values)
{
    cp_control_settings settings = road_settings(CP_CONTROL_DRIVER_ERROR, model, names, values);
    cp_controls *controls;
    cp_error error = {0};
    if (cp_controls_create(&settings, 1, 5, 1, traffic, &controls, &error) != CP_OK)
        fail_msg("%s", error.text);
    return controls;
}

static void step(cp_traffic *traffic, cp_controls *controls)
{
    cp_error error = {0};
    assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
    assert_int_equal(cp_controls_step(controls, &error), CP_OK);
}

static void a_gap_in_the_range_is_misjudged_and_a_shorter_one_is_not(void **unused)
{
    (void)unused;
    static const char *const NAMES[] = {"probability_1", "gap_min_s", "gap_max_s", "hold_s", NULL};
    static const double VALUES[] = {1.0, 1.5, 4.0, 4.2};
    cp_traffic *traffic = road_open(0.1);
    cp_controls *controls = create(traffic, "misjudged_gap", NAMES, VALUES);
    // ego waits facing north; far comes from 100 m at 20 m/s, near from 20 m; away drives off.
    road_add("ego", 0.0, -3.0, CP_PI / 2, 0.0);
    road_add("far", -100.0, 0.0, 0.0, 20.0);
    road_add("near", 20.0, 0.0, CP_PI, 20.0);
    road_add("away", 60.0, 0.0, 0.0, 20.0);
    step(traffic, controls);
    assert_string_equal(road.cars[0].value, "");
    while (road.cars[0].value[0] == '\0')
        step(traffic, controls);
    assert_string_equal(road.cars[0].value, "far");
    // 4 s at 20 m/s.
    assert_near(cp_traffic_motion_of(traffic, 1)->after.front_x_m, -80.0, 2.1);
    assert_false(cp_controls_is_at_fault(controls, 0));
    for (int k = 0; k < 37; k++)
        step(traffic, controls);
    assert_true(cp_controls_is_at_fault(controls, 0));
    assert_false(cp_controls_is_at_fault(controls, 1));
    for (int k = 0; k < 6; k++)
        step(traffic, controls);
    assert_string_equal(road.cars[0].value, "");
    assert_false(cp_controls_is_at_fault(controls, 0));
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

static void a_runner_heeds_no_red_and_some_do_not_expect_him(void **unused)
{
    (void)unused;
    static const char *const NAMES[] = {"probability_1", "unaware_1", NULL};
    static const double VALUES[] = {1.0, 1.0};
    cp_traffic *traffic = road_open(0.1);
    cp_controls *controls = create(traffic, "red_light", NAMES, VALUES);
    road_car *runner = road_add("runner", 0.0, 0.0, 0.0, 12.0);
    road_add("crossing", 40.0, -20.0, CP_PI / 2, 12.0);
    road_add("follower", -15.0, 0.0, 0.0, 12.0);
    runner->light = (cp_next_light){60.0, 7, true};
    step(traffic, controls);
    assert_int_equal(runner->mode, 31);
    runner->light.distance_m = 45.0;
    step(traffic, controls);
    assert_int_equal(runner->mode, 39);
    assert_true(cp_controls_is_at_fault(controls, 0));
    assert_string_equal(road.cars[1].value, "runner");
    assert_string_equal(road.cars[2].value, ""); // behind him, same way

    // Past it: five seconds later he is a driver like others.
    runner->light = (cp_next_light){INFINITY, CP_NO_NUMBER, false};
    for (int k = 0; k < 52; k++)
        step(traffic, controls);
    assert_int_equal(runner->mode, 31);
    assert_false(cp_controls_is_at_fault(controls, 0));
    assert_string_equal(road.cars[1].value, "");

    // Green is no red.
    runner->light = (cp_next_light){20.0, 8, false};
    step(traffic, controls);
    assert_int_equal(runner->mode, 31);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

static void who_looks_up_late_brakes_weakly(void **unused)
{
    (void)unused;
    static const char *const NAMES[] = {"rate_per_h",        "duration_mean_s", "duration_sd_s",
                                        "deceleration_m_s2", "jerk_m_s3",       NULL};
    static const double VALUES[] = {3600.0, 2.0, 0.0, 4.0, 1000.0};
    cp_traffic *traffic = road_open(0.1);
    cp_controls *controls = create(traffic, "late_braking", NAMES, VALUES);
    road_car *ego = road_add("ego", 0.0, 0.0, 0.0, 20.0);
    double blind_s = 0.0;
    while (blind_s == 0.0) {
        step(traffic, controls);
        if (ego->mode == 24)
            blind_s = cp_traffic_time_s(traffic);
    }
    assert_near(ego->command_m_s, 20.0, 0.0);
    assert_true(cp_controls_is_at_fault(controls, 0));
    // A queue 80 m ahead: at 20 m/s he looks up 40 m later, 2 s before it.
    road_add("queue", ego->state.front_x_m + 80.0 + 4.5, 0.0, 0.0, 0.0);
    double looked_up_s = 0.0;
    while (looked_up_s == 0.0) {
        step(traffic, controls);
        if (ego->command_m_s < 20.0)
            looked_up_s = cp_traffic_time_s(traffic);
    }
    assert_near(looked_up_s - blind_s, 2.0, 0.11);
    double before_m_s = ego->command_m_s;
    step(traffic, controls);
    assert_near(before_m_s - ego->command_m_s, 0.4, 1e-9);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_gap_in_the_range_is_misjudged_and_a_shorter_one_is_not),
        cmocka_unit_test(a_runner_heeds_no_red_and_some_do_not_expect_him),
        cmocka_unit_test(who_looks_up_late_brakes_weakly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
