/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/traffic.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static cp_traffic *create(double step_length_s)
{
    static char path[1024];
    snprintf(path, sizeof path, "%s/tests/traffic/straight/straight.sumocfg",
             getenv("CRASHPULSE_SOURCE"));
    cp_traffic_options options = {.sumocfg = path, .seed = 1, .step_length_s = step_length_s};
    cp_traffic *traffic;
    cp_error error = {0};
    if (cp_traffic_create(&options, &traffic, &error) != CP_OK)
        fail_msg("%s", error.text);
    return traffic;
}

static void run_until(cp_traffic *traffic, double time_s)
{
    cp_error error = {0};
    while (cp_traffic_time_s(traffic) < time_s - 1e-9)
        if (cp_traffic_step(traffic, &error) != CP_OK)
            fail_msg("%s", error.text);
}

static uint32_t number_of(const cp_traffic *traffic, const char *id)
{
    size_t count;
    const cp_vehicle_motion *motions = cp_traffic_motions(traffic, &count);
    for (size_t k = 0; k < count; k++)
        if (strcmp(cp_traffic_vehicle_id(traffic, motions[k].after.vehicle), id) == 0)
            return motions[k].after.vehicle;
    fail_msg("no vehicle %s", id);
    return CP_NO_NUMBER;
}

static void exposure_is_what_was_driven(void **unused)
{
    (void)unused;
    cp_traffic *traffic = create(0.05);
    run_until(traffic, 1.05);
    cp_exposure start = cp_traffic_exposure(traffic);
    assert_int_equal(start.departed, 3);
    assert_true(start.vehicle_km == 0.0);

    // Three cars at 20 m/s for 50 s: 3 km in 150 vehicle seconds.
    run_until(traffic, 51.05);
    cp_exposure end = cp_traffic_exposure(traffic);
    assert_true(fabs(end.vehicle_km - 3.0) < 1e-9);
    assert_true(fabs(end.vehicle_h - 150.0 / 3600.0) < 1e-9);
    assert_false(cp_traffic_finished(traffic));
    run_until(traffic, 400.0);
    assert_true(cp_traffic_finished(traffic));
    assert_int_equal(cp_traffic_exposure(traffic).departed, 13);
    cp_traffic_destroy(traffic);
}

static void this_step_is_joined_to_the_last(void **unused)
{
    (void)unused;
    cp_traffic *traffic = create(0.1);
    run_until(traffic, 1.1);
    uint32_t first = number_of(traffic, "first");
    assert_false(cp_traffic_motion_of(traffic, first)->was_present);
    run_until(traffic, 1.2);
    const cp_vehicle_motion *motion = cp_traffic_motion_of(traffic, first);
    assert_non_null(motion);
    assert_true(motion->was_present);
    assert_true(fabs(motion->before.front_x_m - 100.0) < 1e-9);
    assert_true(fabs(motion->after.front_x_m - 102.0) < 1e-9);
    assert_true(motion->yaw_rate_rad_s == 0.0);
    cp_traffic_destroy(traffic);
}

// Without places in the states they are told one by one, the same.
static void places_can_be_asked_for(void **unused)
{
    (void)unused;
    cp_error error = {0};
    cp_vehicle_state with_places[8], state;
    size_t count;
    cp_traffic *traffic = create(0.1);
    run_until(traffic, 5.0);
    const cp_vehicle_motion *motions = cp_traffic_motions(traffic, &count);
    assert_int_equal(count, 3);
    for (size_t k = 0; k < count; k++)
        with_places[k] = motions[k].after;
    assert_true(with_places[0].lane_position_m > 100.0);
    cp_traffic_destroy(traffic);

    traffic = create(0.1);
    cp_traffic_read_places(traffic, false);
    run_until(traffic, 5.0);
    motions = cp_traffic_motions(traffic, &count);
    for (size_t k = 0; k < count; k++) {
        state = motions[k].after;
        assert_true(state.lane_position_m == 0.0);
        assert_int_equal(cp_traffic_place(traffic, &state, &error), CP_OK);
        assert_true(state.lane_position_m == with_places[k].lane_position_m);
        assert_string_equal(cp_traffic_lane_id(traffic, state.lane), k == 0   ? "east_0"
                                                                     : k == 1 ? "north_0"
                                                                              : "west_0");
        assert_true(state.front_x_m == with_places[k].front_x_m);
        assert_true(state.speed_m_s == with_places[k].speed_m_s);
    }
    cp_traffic_destroy(traffic);
}

static void a_crashed_car_can_be_taken_off(void **unused)
{
    (void)unused;
    cp_traffic *traffic = create(0.1);
    run_until(traffic, 5.0);
    uint32_t first = number_of(traffic, "first"), oncoming = number_of(traffic, "oncoming");
    cp_error error = {0};
    assert_int_equal(cp_traffic_remove(traffic, first, &error), CP_OK);
    size_t count;
    cp_traffic_motions(traffic, &count);
    assert_int_equal(count, 2);
    assert_null(cp_traffic_motion_of(traffic, first));
    assert_int_equal(cp_traffic_motion_of(traffic, oncoming)->after.vehicle, oncoming);

    // Again, or a vehicle that never was: nothing to do.
    assert_int_equal(cp_traffic_remove(traffic, first, &error), CP_OK);
    assert_int_equal(cp_traffic_remove(traffic, 4711, &error), CP_OK);
    run_until(traffic, 5.1);
    assert_null(cp_traffic_motion_of(traffic, first));
    assert_true(cp_traffic_motion_of(traffic, oncoming)->was_present);
    cp_traffic_destroy(traffic);
}

static void a_crashed_car_can_stay_for_a_while(void **unused)
{
    (void)unused;
    cp_traffic *traffic = create(0.1);
    run_until(traffic, 75.0);
    uint32_t leader = number_of(traffic, "people.0"), follower = number_of(traffic, "people.1");
    cp_vehicle_state pose = cp_traffic_motion_of(traffic, leader)->after;
    assert_true(pose.speed_m_s > 5.0);
    cp_error error = {0};
    assert_int_equal(cp_traffic_hold(traffic, leader, 100.0, &error), CP_OK);
    assert_true(cp_traffic_is_held(traffic, leader) && !cp_traffic_is_held(traffic, follower));
    // Again, or a vehicle that never was: nothing to do.
    assert_int_equal(cp_traffic_hold(traffic, leader, 400.0, &error), CP_OK);
    assert_int_equal(cp_traffic_hold(traffic, 4711, 400.0, &error), CP_OK);

    // It stands from the first step on, whatever else is commanded.
    run_until(traffic, 75.1);
    const cp_vehicle_motion *motion = cp_traffic_motion_of(traffic, leader);
    assert_true(motion->was_present && motion->before.speed_m_s == 0.0);
    assert_true(motion->after.speed_m_s == 0.0 && motion->after.front_x_m == pose.front_x_m);
    assert_int_equal(cp_traffic_commands(traffic)->set_speed(leader, 10.0, &error), CP_OK);
    run_until(traffic, 99.8);
    motion = cp_traffic_motion_of(traffic, leader);
    assert_true(motion->after.front_x_m == pose.front_x_m && motion->after.speed_m_s == 0.0);

    // Who follows stops behind it, and drives on when it has gone.
    motion = cp_traffic_motion_of(traffic, follower);
    double stop_m = motion->after.front_x_m;
    assert_true(motion->after.speed_m_s == 0.0);
    assert_true(stop_m < pose.front_x_m - pose.length_m + 1.0 &&
                stop_m > pose.front_x_m - pose.length_m - 5.0);
    run_until(traffic, 100.0);
    assert_null(cp_traffic_motion_of(traffic, leader));
    assert_false(cp_traffic_is_held(traffic, leader));
    run_until(traffic, 105.0);
    assert_true(cp_traffic_motion_of(traffic, follower)->after.front_x_m > stop_m + 5.0);
    run_until(traffic, 400.0);
    assert_true(cp_traffic_finished(traffic));
    cp_traffic_destroy(traffic);
}

/* A road of one car whose next state the test sets. */
static cp_vehicle_state scripted;

static cp_status scripted_step(const cp_vehicle_state **states, size_t *count, cp_error *error)
{
    (void)error;
    *states = &scripted;
    *count = 1;
    return CP_OK;
}

static cp_status scripted_departed(const uint32_t **vehicles, size_t *count, cp_error *error)
{
    (void)error;
    *vehicles = NULL;
    *count = 0;
    return CP_OK;
}

static double scripted_time_s(void)
{
    return 0.0;
}

static void scripted_stop(void)
{
}

static const cp_vehicle_motion *drive_to(cp_traffic *traffic, double x_m, double yaw_rad)
{
    scripted.front_x_m = x_m;
    scripted.yaw_rad = yaw_rad;
    cp_error error = {0};
    assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
    return cp_traffic_motion_of(traffic, scripted.vehicle);
}

static void a_jump_is_no_motion(void **unused)
{
    (void)unused;
    static const cp_traffic_source SOURCE = {.step = scripted_step,
                                             .departed = scripted_departed,
                                             .time_s = scripted_time_s,
                                             .stop = scripted_stop};
    scripted = (cp_vehicle_state){.vehicle = 900, .speed_m_s = 10.0};
    cp_traffic *traffic;
    cp_error error = {0};
    assert_int_equal(cp_traffic_create_from(&SOURCE, 0.1, &traffic, &error), CP_OK);
    assert_false(drive_to(traffic, 0.0, 3.1)->was_present);

    // Across pi the short way round.
    const cp_vehicle_motion *motion = drive_to(traffic, 1.0, -3.1);
    assert_true(motion->was_present);
    assert_true(fabs(motion->yaw_rate_rad_s - (2.0 * 3.14159265358979 - 6.2) / 0.1) < 1e-6);
    assert_false(drive_to(traffic, 300.0, -3.1)->was_present);
    assert_true(drive_to(traffic, 301.0, -3.1)->was_present);
    cp_traffic_destroy(traffic);
    assert_int_equal(cp_traffic_create_from(&SOURCE, 0.0, &traffic, &error), CP_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exposure_is_what_was_driven),
        cmocka_unit_test(this_step_is_joined_to_the_last),
        cmocka_unit_test(places_can_be_asked_for),
        cmocka_unit_test(a_crashed_car_can_be_taken_off),
        cmocka_unit_test(a_crashed_car_can_stay_for_a_while),
        cmocka_unit_test(a_jump_is_no_motion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
