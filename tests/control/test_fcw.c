/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control.h"

#include "control/scripted_road.h"

#include <jansson.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

static const char *const NAMES[] = {"ttc_s",
                                    "required_deceleration_m_s2",
                                    "reaction_spread_1",
                                    "compliance_1",
                                    "sensor_confirmation_s",
                                    "penetration_1",
                                    NULL};

/* Drive towards a standing car 70.3 m ahead at 20 m/s; time at which the driver first brakes, NAN
 * when he does not. */
static double brakes_at_s(const char *id, double spread_1, double compliance_1,
                          double penetration_1)
{
    const double values[] = {2.4, 0.0, spread_1, compliance_1, 0.0, penetration_1};
    cp_control_settings settings = road_settings(CP_CONTROL_FUNCTION, "fcw", NAMES, values);
    cp_traffic *traffic = road_open(0.01);
    cp_controls *controls;
    cp_error error = {0};
    assert_int_equal(cp_controls_create(&settings, 1, 5, 1, traffic, &controls, &error), CP_OK);
    road_add(id, 0.0, 0.0, 0.0, 20.0);
    road_add("standing", 70.3 + 4.5, 0.0, 0.0, 0.0);
    double found_s = NAN;
    while (isnan(found_s) && road.time_s < 3.4) {
        assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
        assert_int_equal(cp_controls_step(controls, &error), CP_OK);
        if (road.cars[0].command_m_s >= 0.0)
            found_s = road.time_s;
    }
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
    return found_s;
}

static void the_driver_brakes_after_his_reaction_time(void **unused)
{
    (void)unused;
    // TTC 2.4 s at 0.01 + 1.115 s; latency 0.1 s, reaction 1 s; told at the end of the step before.
    double found_s = brakes_at_s("own", 0.0, 1.0, 1.0);
    assert_true(fabs(found_s - (0.01 + 1.115 + 1.1)) < 0.011);
}

static void reaction_times_are_log_normal_and_seeded(void **unused)
{
    (void)unused;
    // Medians: about half react faster than 1 s, and the spread is that of the logarithm.
    int faster = 0, count = 60;
    double squares = 0.0;
    for (int k = 0; k < count; k++) {
        char id[16];
        snprintf(id, sizeof id, "own%d", k);
        double found_s = brakes_at_s(id, 0.2, 1.0, 1.0);
        assert_false(isnan(found_s));
        double log_1 = log(found_s - (0.01 + 1.115 + 0.1));
        faster += log_1 < 0.0;
        squares += log_1 * log_1;
        if (k == 0)
            assert_true(found_s == brakes_at_s(id, 0.2, 1.0, 1.0));
    }
    assert_true(faster > 18 && faster < 42);
    double spread_1 = sqrt(squares / count);
    assert_true(spread_1 > 0.14 && spread_1 < 0.26);
}

static void some_heed_no_warning(void **unused)
{
    (void)unused;
    int heed = 0;
    for (int k = 0; k < 40; k++) {
        char id[16];
        snprintf(id, sizeof id, "own%d", k);
        heed += !isnan(brakes_at_s(id, 0.0, 0.5, 1.0));
    }
    assert_true(heed > 8 && heed < 32);
    assert_true(isnan(brakes_at_s("own", 0.0, 0.0, 1.0)));
    assert_true(isnan(brakes_at_s("own", 0.0, 1.0, 0.0)));
}

/* Counters after an unheeded warning of a standing car that goes away at gone_s. */
static json_t *counters_when_gone_at(double gone_s)
{
    const double values[] = {2.4, 0.0, 0.0, 0.0, 0.0, 1.0};
    cp_control_settings settings = road_settings(CP_CONTROL_FUNCTION, "fcw", NAMES, values);
    cp_traffic *traffic = road_open(0.1);
    cp_controls *controls;
    cp_error error = {0};
    char *json = NULL;
    assert_int_equal(cp_controls_create(&settings, 1, 5, 1, traffic, &controls, &error), CP_OK);
    road_add("own", 0.0, 0.0, 0.0, 20.0);
    road_add("standing", 50.0 + 4.5, 0.0, 0.0, 0.0);
    while (road.time_s < 2.8) {
        assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
        assert_int_equal(cp_controls_step(controls, &error), CP_OK);
        road.cars[1].is_there = road.time_s < gone_s;
    }
    assert_int_equal(cp_controls_counters_json(controls, &json, &error), CP_OK);
    json_t *counters = json_loads(json, 0, NULL);
    free(json);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
    return counters;
}

static double counted(const json_t *counters, const char *name)
{
    const json_t *value = json_object_get(counters, name);
    assert_non_null(value);
    return json_number_value(value);
}

static void a_warning_is_borne_out_by_a_touch(void **unused)
{
    (void)unused;
    // They touch 2.6 s on; nobody errs.
    json_t *counters = counters_when_gone_at(100.0);
    assert_true(counted(counters, "fcw.warnings") >= 1.0);
    assert_true(counted(counters, "fcw.warnings_borne_out") == 1.0);
    assert_true(counted(counters, "fcw.warnings_without_error") ==
                counted(counters, "fcw.warnings"));
    json_decref(counters);
    // It goes away in time.
    counters = counters_when_gone_at(2.0);
    assert_true(counted(counters, "fcw.warnings") == 1.0);
    assert_true(counted(counters, "fcw.warnings_borne_out") == 0.0);
    json_decref(counters);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_driver_brakes_after_his_reaction_time),
        cmocka_unit_test(reaction_times_are_log_normal_and_seeded),
        cmocka_unit_test(some_heed_no_warning),
        cmocka_unit_test(a_warning_is_borne_out_by_a_touch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
