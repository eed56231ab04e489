/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control.h"

#include "control/brake.h"
#include "control/scripted_road.h"
#include "core/units.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

static cp_controls *create(const cp_traffic *traffic, const char *const *names,
                           const double *values)
{
    cp_control_settings settings = road_settings(CP_CONTROL_FUNCTION, "aeb", names, values);
    cp_controls *controls;
    cp_error error = {0};
    assert_int_equal(cp_controls_create(&settings, 1, 5, 1, traffic, &controls, &error), CP_OK);
    return controls;
}

static void step(cp_traffic *traffic, cp_controls *controls)
{
    cp_error error = {0};
    assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
    assert_int_equal(cp_controls_step(controls, &error), CP_OK);
}

static void braking_follows_the_profile_whatever_the_step(void **unused)
{
    (void)unused;
    // 20 m/s towards a standing car 50.3 m ahead: TTC 1.2 s at 1.315 s, brakes hold 0.35 s later.
    const char *const names[] = {
        "ttc_s", "deceleration_m_s2", "dead_time_s", "sensor_latency_s", "jerk_m_s3", NULL};
    const double values[] = {1.2, 7.0, 0.2, 0.15, 30.0};
    const double steps_s[] = {0.1, 0.05, 0.02};
    for (size_t k = 0; k < 3; k++) {
        cp_traffic *traffic = road_open(steps_s[k]);
        cp_controls *controls = create(traffic, names, values);
        road_add("own", 0.0, 0.0, 0.0, 20.0);
        road_add("standing", 50.3 + 4.5, 0.0, 0.0, 0.0);
        double start_s = steps_s[k] + 50.3 / 20.0 - 1.2 + 0.35; // put there by the first step
        cp_brake profile = {start_s, 30.0, 7.0, 0.0};
        while (road.time_s < start_s + 0.7) {
            step(traffic, controls);
            double expected_m_s = 20.0 - cp_brake_speed_loss_m_s(&profile, road.time_s);
            assert_true(fabs(road.cars[0].state.speed_m_s - expected_m_s) < 1e-9);
        }
        assert_int_equal(road.cars[0].mode, 27);
        cp_controls_destroy(controls);
        cp_traffic_destroy(traffic);
    }
}

static void a_trigger_inside_the_step_is_caught_up(void **unused)
{
    (void)unused;
    // No dead time: deceleration began before the first command could be given.
    const char *const names[] = {"ttc_s", "dead_time_s", "sensor_latency_s", "jerk_m_s3", NULL};
    const double values[] = {1.0, 0.0, 0.0, 1000.0};
    cp_traffic *traffic = road_open(0.1);
    cp_controls *controls = create(traffic, names, values);
    road_add("own", 0.0, 0.0, 0.0, 20.0);
    road_add("standing", 20.0 + 4.5 + 0.74 * 20.0, 0.0, 0.0, 0.0);
    cp_brake profile = {0.1 + 0.74, 1000.0, 8.0, 0.0};
    while (road.time_s < 1.45) {
        step(traffic, controls);
        if (road.time_s > 0.95)
            assert_true(fabs(road.cars[0].state.speed_m_s - 20.0 +
                             cp_brake_speed_loss_m_s(&profile, road.time_s)) < 1e-9);
    }
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

static void friction_limits_deceleration(void **unused)
{
    (void)unused;
    const char *const names[] = {"friction_1", "deceleration_m_s2", NULL};
    const double values[] = {0.3, 9.0};
    cp_traffic *traffic = road_open(0.05);
    cp_controls *controls = create(traffic, names, values);
    road_add("own", 0.0, 0.0, 0.0, 20.0);
    road_add("standing", 30.0, 0.0, 0.0, 0.0);
    double before_m_s = 20.0, hardest_m_s2 = 0.0;
    for (int k = 0; k < 30; k++) {
        step(traffic, controls);
        hardest_m_s2 = fmax(hardest_m_s2, (before_m_s - road.cars[0].state.speed_m_s) / 0.05);
        before_m_s = road.cars[0].state.speed_m_s;
    }
    assert_true(fabs(hardest_m_s2 - 0.3 * CP_G0_M_S2) < 1e-9);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

static void oncoming_cars_in_their_lane_are_left_alone(void **unused)
{
    (void)unused;
    cp_traffic *traffic = road_open(0.05);
    cp_controls *controls = create(traffic, NULL, NULL);
    road_add("east", 0.0, -1.6, 0.0, 25.0);
    road_add("west", 100.0, 1.6, CP_PI, 25.0);
    road_add("west_too", 150.0, 1.6, CP_PI, 25.0);
    for (int k = 0; k < 100; k++)
        step(traffic, controls);
    assert_int_equal(road.commands, 0);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);

    // The same in one lane: both brake.
    traffic = road_open(0.05);
    controls = create(traffic, NULL, NULL);
    road_add("east", 0.0, 0.0, 0.0, 25.0);
    road_add("west", 100.0, 0.0, CP_PI, 25.0);
    for (int k = 0; k < 30; k++)
        step(traffic, controls);
    assert_true(road.cars[0].state.speed_m_s < 25.0);
    assert_true(road.cars[1].state.speed_m_s < 25.0);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

// Commands given to a car of this speed driving at a standing one.
static int commands_at_speed(double speed_m_s)
{
    const char *const names[] = {"speed_min_m_s", "speed_max_m_s", "required_deceleration_m_s2",
                                 NULL};
    const double values[] = {3.0, 30.0, 3.0};
    cp_traffic *traffic = road_open(0.05);
    cp_controls *controls = create(traffic, names, values);
    road_add("own", 0.0, 0.0, 0.0, speed_m_s);
    road_add("standing", 4.5 + 1.5 * speed_m_s, 0.0, 0.0, 0.0);
    for (int k = 0; k < 25; k++)
        step(traffic, controls);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
    return road.commands;
}

static void acts_in_its_range_of_speed_only(void **unused)
{
    (void)unused;
    assert_int_equal(commands_at_speed(2.9), 0);
    assert_true(commands_at_speed(3.1) > 0);
    assert_true(commands_at_speed(29.9) > 0);
    assert_int_equal(commands_at_speed(30.1), 0);
}

static void the_driver_gets_the_car_back(void **unused)
{
    (void)unused;
    const char *const names[] = {"hold_s", NULL};
    const double values[] = {0.5};
    cp_traffic *traffic = road_open(0.05);
    cp_controls *controls = create(traffic, names, values);
    road_add("own", 0.0, 0.0, 0.0, 20.0)->mode = 23;
    road_add("standing", 30.0, 0.0, 0.0, 0.0);
    while (road.cars[0].command_m_s < 0.0)
        step(traffic, controls);
    // The other one goes: half a second later speed and mode are the driver's again.
    road.cars[1].is_there = false;
    double gone_s = road.time_s;
    while (road.cars[0].command_m_s >= 0.0 && road.time_s < 10.0)
        step(traffic, controls);
    assert_true(fabs(road.time_s - gone_s - 0.55) < 0.051);
    assert_int_equal(road.cars[0].mode, 23);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

static void a_danger_gone_before_braking_is_forgotten(void **unused)
{
    (void)unused;
    const char *const names[] = {"dead_time_s", NULL};
    const double values[] = {0.5};
    cp_traffic *traffic = road_open(0.05);
    cp_controls *controls = create(traffic, names, values);
    road_add("own", 0.0, 0.0, 0.0, 20.0);
    road_add("passing", 20.0 + 4.5, 0.0, 0.0, 0.0);
    step(traffic, controls);
    step(traffic, controls);
    road.cars[1].is_there = false;
    for (int k = 0; k < 40; k++)
        step(traffic, controls);
    assert_int_equal(road.commands, 0);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

// Which of the cars 0 ... 7 with ids of this prefix are equipped: one bit each.
static unsigned equipped(const char *prefix, double penetration_1)
{
    const char *const names[] = {"penetration_1", NULL};
    unsigned bits = 0;
    for (unsigned k = 0; k < 8; k++) {
        cp_traffic *traffic = road_open(0.05);
        cp_controls *controls = create(traffic, names, &penetration_1);
        char id[16];
        snprintf(id, sizeof id, "%s%u", prefix, k);
        road_add("standing", 30.0, 0.0, 0.0, 0.0);
        road_add(id, 0.0, 0.0, 0.0, 20.0);
        for (int i = 0; i < 25; i++)
            step(traffic, controls);
        bits |= (road.commands > 0 ? 1u : 0u) << k;
        cp_controls_destroy(controls);
        cp_traffic_destroy(traffic);
    }
    return bits;
}

static void equipment_is_drawn_by_vehicle_id(void **unused)
{
    (void)unused;
    assert_int_equal(equipped("car", 0.0), 0);
    assert_int_equal(equipped("car", 1.0), 0xff);
    unsigned half = equipped("car", 0.5);
    assert_int_equal(equipped("car", 0.5), half);
    assert_int_not_equal(half, 0);
    assert_int_not_equal(half, 0xff);
    assert_int_not_equal(equipped("van", 0.5), half);
    // Who has it at half has it at more.
    assert_int_equal(equipped("car", 0.8) & half, half);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(braking_follows_the_profile_whatever_the_step),
        cmocka_unit_test(a_trigger_inside_the_step_is_caught_up),
        cmocka_unit_test(friction_limits_deceleration),
        cmocka_unit_test(oncoming_cars_in_their_lane_are_left_alone),
        cmocka_unit_test(acts_in_its_range_of_speed_only),
        cmocka_unit_test(the_driver_gets_the_car_back),
        cmocka_unit_test(a_danger_gone_before_braking_is_forgotten),
        cmocka_unit_test(equipment_is_drawn_by_vehicle_id),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
