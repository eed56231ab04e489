/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* What a run came to. */
typedef struct outcome {
    double fingerprint; /* sum over all states */
    int collisions;     /* reports of SUMO's, one a step and pair */
    int one_at_fault;   /* of these, with exactly one of the two at fault */
    int fault_at_home;  /* vehicles at fault on a lane of the direction they are named after */
    double fastest_m_s; /* of those who have driven 600 m */
    char *counters;     /* freed by the caller */
} outcome;

// "east.7" belongs on "eastbound_0".
static bool is_at_fault_at_home(cp_controls *controls, const cp_traffic *traffic, uint32_t vehicle)
{
    const cp_vehicle_motion *motion = cp_traffic_motion_of(traffic, vehicle);
    return motion && cp_controls_is_at_fault(controls, vehicle) &&
           strncmp(cp_traffic_lane_id(traffic, motion->after.lane),
                   cp_traffic_vehicle_id(traffic, vehicle), 4) == 0;
}

static void look_at_collisions(cp_controls *controls, const cp_traffic *traffic, outcome *found)
{
    const cp_sumo_collision *collisions;
    size_t count;
    cp_error error = {0};
    assert_int_equal(cp_traffic_collisions(traffic, &collisions, &count, &error), CP_OK);
    for (size_t k = 0; k < count; k++) {
        found->collisions++;
        found->one_at_fault += cp_controls_is_at_fault(controls, collisions[k].collider) !=
                               cp_controls_is_at_fault(controls, collisions[k].victim);
        found->fault_at_home += is_at_fault_at_home(controls, traffic, collisions[k].collider);
        found->fault_at_home += is_at_fault_at_home(controls, traffic, collisions[k].victim);
    }
}

static outcome run(const char *scenario, double duration_s, const cp_control_settings *settings,
                   size_t count)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/sumo_scenarios/%s/%s.sumocfg", getenv("CRASHPULSE_BUILD"),
             scenario, scenario);
    cp_traffic_options options = {.sumocfg = path, .seed = 3, .step_length_s = 0.1};
    cp_traffic *traffic;
    cp_controls *controls;
    cp_error error = {0};
    outcome found = {0};
    if (cp_traffic_create(&options, &traffic, &error) != CP_OK ||
        cp_controls_create(settings, count, 11, 3, traffic, &controls, &error) != CP_OK)
        fail_msg("%s", error.text);
    while (cp_traffic_time_s(traffic) < duration_s) {
        if (cp_traffic_step(traffic, &error) != CP_OK ||
            cp_controls_step(controls, &error) != CP_OK)
            fail_msg("%s", error.text);
        size_t vehicles;
        const cp_vehicle_motion *motions = cp_traffic_motions(traffic, &vehicles);
        for (size_t k = 0; k < vehicles; k++) {
            found.fingerprint +=
                (double)(k + 1) * (motions[k].after.front_x_m + motions[k].after.speed_m_s);
            if (motions[k].after.lane_position_m > 600.0)
                found.fastest_m_s = fmax(found.fastest_m_s, motions[k].after.speed_m_s);
        }
        look_at_collisions(controls, traffic, &found);
    }
    assert_int_equal(cp_controls_counters_json(controls, &found.counters, &error), CP_OK);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
    return found;
}

// Default settings but for the first parameter, the probability or the penetration.
static cp_control_settings with(cp_control_kind kind, const char *name, double first)
{
    cp_control_settings settings = cp_control_settings_default(cp_control_type_find(kind, name));
    settings.parameter[0] = first;
    return settings;
}

static void nobody_equipped_is_the_baseline_bit_for_bit(void **unused)
{
    (void)unused;
    // Every function there is but for that of a library, of which there is none here.
    cp_control_settings settings[16] = {with(CP_CONTROL_DRIVER_ERROR, "failed_to_see", 0.5)};
    size_t count = 1;
    for (size_t k = 0; k < CP_CONTROL_TYPE_COUNT; k++)
        if (CP_CONTROL_TYPE[k]->function != NULL)
            settings[count++] = with(CP_CONTROL_FUNCTION, CP_CONTROL_TYPE[k]->name, 0.0);
    assert_true(count >= 5);
    outcome baseline = run("left_turn", 120.0, settings, 1);
    outcome nobody = run("left_turn", 120.0, settings, count);
    settings[1] = with(CP_CONTROL_FUNCTION, "aeb", 1.0);
    outcome everybody = run("left_turn", 120.0, settings, 2);
    assert_true(nobody.fingerprint == baseline.fingerprint);
    assert_true(everybody.fingerprint != baseline.fingerprint);
    free(baseline.counters);
    free(nobody.counters);
    free(everybody.counters);
}

static void isa_keeps_to_the_speed_limit(void **unused)
{
    (void)unused;
    // 80 km/h; a car that comes faster than that slows down first.
    cp_control_settings isa = with(CP_CONTROL_FUNCTION, "isa", 1.0);
    outcome free_driving = run("head_on_overtaking", 150.0, NULL, 0);
    outcome limited = run("head_on_overtaking", 150.0, &isa, 1);
    assert_true(free_driving.fastest_m_s > 23.5);
    assert_true(limited.fastest_m_s < 22.23);
    free(free_driving.counters);
    free(limited.counters);
}

static void ordinary_two_way_traffic_never_triggers(void **unused)
{
    (void)unused;
    cp_control_settings aeb = with(CP_CONTROL_FUNCTION, "aeb", 1.0);
    outcome baseline = run("head_on_overtaking", 200.0, NULL, 0);
    outcome equipped = run("head_on_overtaking", 200.0, &aeb, 1);
    assert_non_null(strstr(equipped.counters, "\"aeb.activations\":0.0"));
    assert_true(equipped.fingerprint == baseline.fingerprint);
    assert_int_equal(baseline.collisions, 0);
    free(baseline.counters);
    free(equipped.counters);
}

static void who_fails_to_see_crashes(void **unused)
{
    (void)unused;
    cp_control_settings all_see = with(CP_CONTROL_DRIVER_ERROR, "failed_to_see", 0.0);
    cp_control_settings many_fail = with(CP_CONTROL_DRIVER_ERROR, "failed_to_see", 0.6);
    outcome careful = run("left_turn", 300.0, &all_see, 1);
    outcome careless = run("left_turn", 300.0, &many_fail, 1);
    assert_int_equal(careful.collisions, 0);
    assert_true(careless.collisions > 0);
    free(careful.counters);
    free(careless.counters);
}

static void who_overtakes_riskily_is_at_fault(void **unused)
{
    (void)unused;
    cp_control_settings risky = with(CP_CONTROL_DRIVER_ERROR, "risky_overtaking", 1.0);
    outcome found = run("head_on_overtaking", 330.0, &risky, 1);
    assert_true(found.collisions > 0);
    assert_true(found.one_at_fault > 0);
    assert_int_equal(found.fault_at_home, 0);
    free(found.counters);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nobody_equipped_is_the_baseline_bit_for_bit),
        cmocka_unit_test(isa_keeps_to_the_speed_limit),
        cmocka_unit_test(ordinary_two_way_traffic_never_triggers),
        cmocka_unit_test(who_fails_to_see_crashes),
        cmocka_unit_test(who_overtakes_riskily_is_at_fault),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
