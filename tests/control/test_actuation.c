/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/actuation.h"

#include "control/scripted_road.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

static void step(cp_traffic *traffic)
{
    cp_error error = {0};
    assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
}

static void request(cp_actuation *actuation, double speed_m_s, double deceleration_m_s2)
{
    cp_error error = {0};
    assert_int_equal(cp_actuation_request(actuation, 0, speed_m_s, deceleration_m_s2, &error),
                     CP_OK);
}

static void apply(cp_actuation *actuation, const cp_traffic *traffic)
{
    cp_error error = {0};
    assert_int_equal(cp_actuation_apply(actuation, traffic, &error), CP_OK);
}

static void the_lowest_request_goes_to_sumo(void **unused)
{
    (void)unused;
    cp_traffic *traffic = road_open(0.1);
    cp_actuation actuation = {0};
    road_add("one", 0.0, 0.0, 0.0, 20.0);
    step(traffic);
    request(&actuation, 19.0, 5.0);
    request(&actuation, 18.5, 8.0);
    request(&actuation, 19.5, 2.0);
    apply(&actuation, traffic);
    assert_true(road.cars[0].command_m_s == 18.5);
    assert_true(cp_actuation_deceleration_m_s2(&actuation, 0) == 8.0);
    assert_true(cp_actuation_deceleration_m_s2(&actuation, 7) == 0.0);

    // Each step anew.
    step(traffic);
    request(&actuation, 18.0, 3.0);
    apply(&actuation, traffic);
    assert_true(road.cars[0].command_m_s == 18.0);
    assert_true(cp_actuation_deceleration_m_s2(&actuation, 0) == 3.0);
    cp_actuation_destroy(&actuation);
    cp_traffic_destroy(traffic);
}

static void a_vehicle_is_handed_back_as_it_was(void **unused)
{
    (void)unused;
    cp_traffic *traffic = road_open(0.1);
    cp_actuation actuation = {0};
    road_add("one", 0.0, 0.0, 0.0, 20.0)->mode = 7;
    step(traffic);
    apply(&actuation, traffic);
    assert_int_equal(road.commands, 0);
    request(&actuation, 19.0, 5.0);
    apply(&actuation, traffic);
    assert_int_equal(road.cars[0].mode, 27);
    step(traffic);
    apply(&actuation, traffic);
    assert_int_equal(road.cars[0].mode, 7);
    assert_true(road.cars[0].command_m_s < 0.0);
    assert_true(cp_actuation_deceleration_m_s2(&actuation, 0) == 0.0);
    int commands = road.commands;
    step(traffic);
    apply(&actuation, traffic);
    assert_int_equal(road.commands, commands);
    cp_actuation_destroy(&actuation);
    cp_traffic_destroy(traffic);
}

static void who_has_left_gets_no_commands(void **unused)
{
    (void)unused;
    cp_traffic *traffic = road_open(0.1);
    cp_actuation actuation = {0};
    road_add("one", 0.0, 0.0, 0.0, 20.0);
    step(traffic);
    request(&actuation, 19.0, 5.0);
    apply(&actuation, traffic);
    int commands = road.commands;
    road.cars[0].is_there = false;
    step(traffic);
    apply(&actuation, traffic);
    assert_int_equal(road.commands, commands);
    cp_actuation_destroy(&actuation);
    cp_traffic_destroy(traffic);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_lowest_request_goes_to_sumo),
        cmocka_unit_test(a_vehicle_is_handed_back_as_it_was),
        cmocka_unit_test(who_has_left_gets_no_commands),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
