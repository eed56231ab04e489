/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control.h"

#include "control/scripted_road.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

#include "builders/assert_near.h"

/* What controls tell of a crash afterwards: driver errors at work before it, and what functions
 * did. */

static void step(cp_traffic *traffic, cp_controls *controls)
{
    cp_error error = {0};
    assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
    assert_int_equal(cp_controls_step(controls, &error), CP_OK);
}

// ---- driver errors -------------------------------------------------------------------------

/* A driver error that a test switches: at work on car 0, towards whom it says. */
static struct {
    bool is_on;
    uint32_t towards;
} switched;

static cp_status create_nothing(const cp_control_context *context, void **state, cp_error *error)
{
    (void)error;
    *state = NULL;
    return context->acts == NULL ? CP_OK : CP_BAD_INPUT; // acts are those of functions
}

static cp_status step_nothing(void *state, const cp_control_context *context, cp_error *error)
{
    (void)state, (void)context, (void)error;
    return CP_OK;
}

static cp_status visit_switched(const void *state, cp_error_visit visit, void *context,
                                cp_error *error)
{
    (void)state;
    return switched.is_on ? visit(context, 0, switched.towards, error) : CP_OK;
}

static bool is_switched(const void *state, uint32_t vehicle)
{
    (void)state;
    return switched.is_on && vehicle == 0;
}

static void destroy_nothing(void *state)
{
    (void)state;
}

static const cp_control_type LISTED = {.name = "listed",
                                       .kind = CP_CONTROL_DRIVER_ERROR,
                                       .create = create_nothing,
                                       .step = step_nothing,
                                       .visit_errors = visit_switched,
                                       .destroy = destroy_nothing};
static const cp_control_type ASKED = {.name = "asked",
                                      .kind = CP_CONTROL_DRIVER_ERROR,
                                      .create = create_nothing,
                                      .step = step_nothing,
                                      .is_at_fault = is_switched,
                                      .destroy = destroy_nothing};

static void errors_are_told_with_their_times(void **unused)
{
    (void)unused;
    const cp_control_settings settings[] = {cp_control_settings_default(&LISTED),
                                            cp_control_settings_default(&ASKED)};
    cp_traffic *traffic = road_open(0.1);
    cp_controls *controls;
    cp_error error = {0};
    cp_error_at at;
    assert_int_equal(cp_controls_create(settings, 2, 5, 1, traffic, &controls, &error), CP_OK);
    assert_int_equal(cp_controls_driver_error_count(controls), 2);
    assert_int_equal(cp_controls_function_count(controls), 0);
    for (int k = 0; k < 3; k++)
        road_add("car", 100.0 * k, 0.0, 0.0, 1.0);

    // From 1.1 to 2.0 s towards car 1, then until 3.0 s towards car 2.
    for (int k = 1; k <= 30; k++) {
        switched.is_on = k > 10;
        switched.towards = k <= 20 ? 1 : 2;
        step(traffic, controls);
    }
    switched.is_on = false;
    assert_false(cp_controls_error_at(controls, 0, 1, 0, 2.95, &at));
    assert_true(cp_controls_error_at(controls, 0, 0, 1, 2.95, &at));
    assert_string_equal(at.name, "listed");
    assert_int_equal(at.towards, CP_TOWARDS_OPPONENT);
    assert_near(at.began_s, 1.85, 1e-9);
    assert_near(at.ended_s, 0.95, 1e-9);
    assert_true(at.is_cause);
    assert_true(cp_controls_error_at(controls, 0, 0, 2, 2.95, &at));
    assert_int_equal(at.towards, CP_TOWARDS_OPPONENT);
    assert_near(at.began_s, 0.85, 1e-9);
    assert_true(at.ended_s == 0.0 && at.is_cause);
    // Of a crash with neither it is no cause, the later of the two is told.
    assert_true(cp_controls_error_at(controls, 0, 0, 7, 2.95, &at));
    assert_int_equal(at.towards, CP_TOWARDS_ANOTHER);
    assert_true(at.ended_s == 0.0 && !at.is_cause);
    assert_near(at.began_s, 0.85, 1e-9);
    // One without a list is asked of everybody.
    assert_true(cp_controls_error_at(controls, 1, 0, 1, 2.95, &at));
    assert_int_equal(at.towards, CP_TOWARDS_EVERYBODY);
    assert_near(at.began_s, 1.85, 1e-9);
    assert_true(at.ended_s == 0.0 && at.is_cause);

    // A cause until 3 s after its end, told until 5 s.
    for (int k = 31; k <= 90; k++) {
        step(traffic, controls);
        double ended_s = road.time_s - 3.0;
        bool is_told = cp_controls_error_at(controls, 1, 0, 1, road.time_s, &at);
        if (ended_s < CP_ERROR_MEMORY_S - 0.01) {
            assert_true(is_told);
            assert_near(at.ended_s, ended_s, 1e-9);
            if (fabs(ended_s - CP_CAUSE_WINDOW_S) > 0.01)
                assert_int_equal(at.is_cause, ended_s < CP_CAUSE_WINDOW_S);
        } else if (ended_s > CP_ERROR_MEMORY_S + 0.01) {
            assert_false(is_told);
        }
    }
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

// ---- functions -----------------------------------------------------------------------------

static cp_function_at function_at(cp_controls *controls, size_t number, double instant_s,
                                  double speed_m_s)
{
    cp_function_at at;
    cp_error error = {0};
    assert_int_equal(
        cp_controls_function_at(controls, number, 0, instant_s, speed_m_s, &at, &error), CP_OK);
    return at;
}

// Speed lost by a brake that rises by the jerk up to the deceleration, s after its beginning.
static double lost_m_s(double jerk_m_s3, double deceleration_m_s2, double s)
{
    double rise_s = deceleration_m_s2 / jerk_m_s3;
    return s < rise_s ? 0.5 * jerk_m_s3 * s * s : deceleration_m_s2 * (s - 0.5 * rise_s);
}

/* A car at 20 m/s, 70.3 m before a standing one, with a function or two. */
typedef struct drive {
    cp_traffic *traffic;
    cp_controls *controls;
} drive;

static drive set_out(const cp_control_settings *settings, size_t count)
{
    drive own = {road_open(0.01), NULL};
    cp_error error = {0};
    assert_int_equal(cp_controls_create(settings, count, 5, 1, own.traffic, &own.controls, &error),
                     CP_OK);
    road_add("own", 0.0, 0.0, 0.0, 20.0);
    road_add("standing", 70.3 + 4.5, 0.0, 0.0, 0.0);
    return own;
}

// Everybody heeds the warning after 1 s.
static cp_control_settings fcw(void)
{
    static const char *const NAMES[] = {
        "ttc_s",        "required_deceleration_m_s2", "reaction_spread_1",
        "compliance_1", "sensor_confirmation_s",      NULL};
    const double values[] = {2.4, 0.0, 0.0, 1.0, 0.0};
    return road_settings(CP_CONTROL_FUNCTION, "fcw", NAMES, values);
}

static cp_control_settings aeb(double ttc_s)
{
    static const char *const NAMES[] = {"ttc_s", "required_deceleration_m_s2",
                                        "sensor_confirmation_s", NULL};
    const double values[] = {ttc_s, 0.0, 0.0};
    return road_settings(CP_CONTROL_FUNCTION, "aeb", NAMES, values);
}

static void arrive(drive *own)
{
    cp_controls_destroy(own->controls);
    cp_traffic_destroy(own->traffic);
}

static void until(drive *own, double time_s)
{
    while (road.time_s < time_s - 1e-6)
        step(own->traffic, own->controls);
}

static void functions_are_told_by_closed_form(void **unused)
{
    (void)unused;
    const cp_control_settings settings[] = {fcw(), aeb(0.2)};
    drive own = set_out(settings, 2);
    // TTC 2.4 s at 0.01 + 1.115 s, told after a latency of 0.1 s; the driver brakes 1 s later.
    const double warned_s = 1.225, brakes_s = 2.225;
    until(&own, 1.2);
    cp_act_at act = function_at(own.controls, 0, road.time_s - 0.004, 20.0).act;
    assert_int_equal(act.state, CP_ACT_IDLE);
    assert_true(isnan(act.warned_s) && isnan(act.braking_s));
    until(&own, 1.8);
    cp_function_at at = function_at(own.controls, 0, road.time_s - 0.004, 20.0);
    assert_true(at.is_equipped);
    assert_string_equal(at.name, "fcw");
    assert_int_equal(at.act.state, CP_ACT_WARNED);
    assert_near(at.act.warned_s, 1.796 - warned_s, 1e-6);
    assert_true(isnan(at.act.braking_s) && isnan(at.act.brake_request_m_s2));

    until(&own, 3.0);
    act = function_at(own.controls, 0, 3.0, road.cars[0].state.speed_m_s).act;
    assert_int_equal(act.state, CP_ACT_BRAKED);
    assert_near(act.warned_s, 3.0 - warned_s, 1e-6);
    assert_near(act.braking_s, 3.0 - brakes_s, 1e-6);
    assert_near(act.speed_taken_off_m_s, lost_m_s(20.0, 6.0, 3.0 - brakes_s), 1e-9);
    assert_near(act.brake_request_m_s2, 6.0, 1e-12);
    assert_near(act.deceleration_m_s2, 6.0, 1e-9);
    assert_true(isnan(act.released_s) && isnan(act.requested_s) && isnan(act.steering_s));
    // AEB has nothing to do then.
    assert_int_equal(function_at(own.controls, 1, 3.0, 15.0).act.state, CP_ACT_IDLE);
    arrive(&own);
}

static void aeb_is_told_by_closed_form(void **unused)
{
    (void)unused;
    // TTC 0.8 s at 0.01 + (70.3 / 20 - 0.8) s; latency and dead time 0.2 s.
    const cp_control_settings settings = aeb(0.8);
    drive own = set_out(&settings, 1);
    const double requested_s = 0.01 + 70.3 / 20.0 - 0.8, brakes_s = requested_s + 0.2;
    until(&own, 2.85);
    cp_act_at act = function_at(own.controls, 0, 2.847, 20.0).act;
    assert_int_equal(act.state, CP_ACT_REQUESTED);
    // Contact at 1 mm: the threshold is reached some microseconds later than of points.
    assert_near(act.requested_s, 2.847 - requested_s, 2e-4);
    assert_true(isnan(act.braking_s));
    // While deceleration rises by 40 m/s^3: what was asked for the end of the step of the instant.
    until(&own, 3.0);
    act = function_at(own.controls, 0, 2.996, 20.0).act;
    assert_near(act.brake_request_m_s2, 40.0 * (3.0 - brakes_s), 0.02);
    until(&own, 3.4);
    double speed_m_s = road.cars[0].state.speed_m_s;
    act = function_at(own.controls, 0, 3.4, speed_m_s).act;
    assert_int_equal(act.state, CP_ACT_BRAKED);
    assert_near(act.requested_s, 3.4 - requested_s, 2e-4);
    assert_near(act.braking_s, act.requested_s - 0.2, 1e-9);
    assert_near(act.braking_s, 3.4 - brakes_s, 2e-4);
    assert_near(act.speed_taken_off_m_s, lost_m_s(40.0, 8.0, 3.4 - brakes_s), 2e-3);
    assert_near(act.brake_request_m_s2, 8.0, 1e-12);
    assert_near(act.deceleration_m_s2, 8.0, 1e-9);
    arrive(&own);
}

static void what_is_over_is_told_for_a_while(void **unused)
{
    (void)unused;
    const cp_control_settings settings = fcw();
    drive own = set_out(&settings, 1);
    until(&own, 3.0);
    // The other is gone: the driver brakes on for 0.5 s after the danger has passed.
    road.cars[1].is_there = false;
    until(&own, 3.4);
    assert_int_equal(function_at(own.controls, 0, 3.4, 15.0).act.state, CP_ACT_BRAKED);
    until(&own, 4.5);
    double speed_m_s = road.cars[0].state.speed_m_s;
    cp_act_at act = function_at(own.controls, 0, 4.5, speed_m_s).act;
    assert_int_equal(act.state, CP_ACT_RELEASED);
    assert_near(act.released_s, 4.5 - 3.51, 0.011);
    assert_near(act.braking_s, 4.5 - 2.225, 1e-6);
    assert_true(isnan(act.brake_request_m_s2));
    assert_near(act.speed_taken_off_m_s, 20.0 - speed_m_s, 1e-9);
    until(&own, 3.51 + CP_ACTS_MEMORY_S - 0.1);
    assert_int_equal(function_at(own.controls, 0, road.time_s, 15.0).act.state, CP_ACT_RELEASED);
    until(&own, 3.51 + CP_ACTS_MEMORY_S + 0.1);
    assert_int_equal(function_at(own.controls, 0, road.time_s, 15.0).act.state, CP_ACT_IDLE);

    // Another warning is another act, with times of its own.
    double from_s = road.time_s, speed_before_m_s = road.cars[0].state.speed_m_s;
    road.cars[1].state.front_x_m = road.cars[0].state.front_x_m + 60.0;
    road.cars[1].is_there = true;
    until(&own, from_s + 3.8);
    act = function_at(own.controls, 0, road.time_s, road.cars[0].state.speed_m_s).act;
    assert_int_equal(act.state, CP_ACT_BRAKED);
    assert_true(act.warned_s < 3.8 && act.braking_s < act.warned_s);
    assert_near(act.speed_taken_off_m_s, speed_before_m_s - road.cars[0].state.speed_m_s, 1e-9);
    arrive(&own);
}

static void who_has_none_is_told(void **unused)
{
    (void)unused;
    static const char *const NONE[] = {"penetration_1", NULL};
    const double none = 0.0;
    const cp_control_settings settings = road_settings(CP_CONTROL_FUNCTION, "fcw", NONE, &none);
    drive own = set_out(&settings, 1);
    until(&own, 3.0);
    cp_function_at at = function_at(own.controls, 0, 3.0, 20.0);
    assert_false(at.is_equipped);
    assert_int_equal(at.act.state, CP_ACT_IDLE);
    arrive(&own);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_told_with_their_times),
        cmocka_unit_test(functions_are_told_by_closed_form),
        cmocka_unit_test(aeb_is_told_by_closed_form),
        cmocka_unit_test(what_is_over_is_told_for_a_while),
        cmocka_unit_test(who_has_none_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
