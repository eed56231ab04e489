/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control.h"

#include "control/scripted_road.h"
#include "core/units.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

#include "builders/assert_near.h"

/* Always to the left at exactly 0.5 m/s, looking away 4 s at a time, on average 30 s after
 * entering. */
static cp_controls *create(const cp_traffic *traffic, uint64_t seed)
{
    const char *const names[] = {"rate_per_h",      "duration_mean_s", "duration_sd_s", "left_1",
                                 "lateral_min_m_s", "lateral_max_m_s", "return_s",      NULL};
    const double values[] = {120.0, 4.0, 0.0, 1.0, 0.5, 0.5, 2.0};
    cp_control_settings settings =
        road_settings(CP_CONTROL_DRIVER_ERROR, "lane_drift", names, values);
    cp_controls *controls;
    cp_error error = {0};
    if (cp_controls_create(&settings, 1, 5, seed, traffic, &controls, &error) != CP_OK)
        fail_msg("%s", error.text);
    return controls;
}

static void step(cp_traffic *traffic, cp_controls *controls)
{
    cp_error error = {0};
    assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
    assert_int_equal(cp_controls_step(controls, &error), CP_OK);
}

static cp_lateral_overlay overlay(const cp_traffic *traffic, uint32_t vehicle)
{
    return cp_lateral_overlay_get(cp_traffic_overlays(traffic), vehicle);
}

/* One car's first drift: when it begins and how far it gets. */
typedef struct drift {
    double begin_s, look_up_s, back_s, furthest_m;
} drift;

static drift first_drift(double step_s, int companions)
{
    cp_traffic *traffic = road_open(step_s);
    cp_controls *controls = create(traffic, 1);
    for (int k = 0; k < companions; k++) {
        char id[32];
        snprintf(id, sizeof id, "companion%d", k);
        road_add(id, 0.0, 1000.0 * (k + 1), 0.0, 20.0);
    }
    road_add("ego", 0.0, 0.0, 0.0, 20.0);
    uint32_t ego = (uint32_t)companions;
    drift found = {0};
    double last_m = 0.0;
    for (int k = 0; k < lround(400.0 / step_s) && found.back_s == 0.0; k++) {
        step(traffic, controls);
        cp_lateral_overlay now = overlay(traffic, ego);
        double time_s = cp_traffic_time_s(traffic);
        if (now.offset_m > 0.0 && found.begin_s == 0.0)
            found.begin_s = time_s - now.offset_m / 0.5;
        if (found.begin_s > 0.0 && found.look_up_s == 0.0 && now.slope_1 < 0.0249)
            found.look_up_s = time_s;
        if (found.begin_s > 0.0 && now.offset_m == 0.0 && last_m > 0.0)
            found.back_s = time_s;
        found.furthest_m = fmax(found.furthest_m, now.offset_m);
        if (found.look_up_s == 0.0 && found.begin_s > 0.0)
            assert_near(cp_traffic_motion_of(traffic, ego)->after.front_y_m,
                        0.5 * (time_s - found.begin_s), 1e-9);
        last_m = now.offset_m;
    }
    assert_true(found.back_s > 0.0);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
    return found;
}

static void a_driver_drifts_looks_up_and_steers_back(void **unused)
{
    (void)unused;
    drift found = first_drift(0.05, 0);
    assert_near(found.look_up_s - found.begin_s, 4.0, 0.101);
    assert_near(found.back_s - found.begin_s, 6.0, 0.101);
    // 2 m when he looks up, a little more until the car points back: a cubic, at most 4/27 of
    // 0.5 m/s over 2 s more (rate alone) and never below that.
    assert_true(found.furthest_m > 2.0 && found.furthest_m < 2.15);
}

static void neither_step_length_nor_company_changes_a_draw(void **unused)
{
    (void)unused;
    drift fine = first_drift(0.05, 0), coarse = first_drift(0.1, 0), company = first_drift(0.05, 3);
    // The clock of the first step differs by the step.
    assert_near(coarse.begin_s - 0.1, fine.begin_s - 0.05, 1e-9);
    assert_near(company.begin_s, fine.begin_s, 1e-9);
}

static void who_takes_the_wheel_ends_the_error(void **unused)
{
    (void)unused;
    cp_traffic *traffic = road_open(0.05);
    cp_controls *controls = create(traffic, 1);
    road_add("ego", 0.0, 0.0, 0.0, 20.0);
    while (overlay(traffic, 0).offset_m < 0.5)
        step(traffic, controls);
    assert_true(cp_controls_is_at_fault(controls, 0));
    // A function holds the car where it is from now on.
    cp_error error = {0};
    double held_m = overlay(traffic, 0).offset_m;
    assert_int_equal(cp_lateral_overlay_steer(cp_traffic_overlays(traffic), 0, 0.0, 0.0, &error),
                     CP_OK);
    step(traffic, controls);
    assert_false(cp_controls_is_at_fault(controls, 0));
    for (int k = 0; k < 20; k++)
        step(traffic, controls);
    assert_near(overlay(traffic, 0).offset_m, held_m, 1e-12);
    char *counters;
    assert_int_equal(cp_controls_counters_json(controls, &counters, &error), CP_OK);
    assert_non_null(strstr(counters, "\"lane_drift.taken_over\":1.0"));
    free(counters);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

static void oncoming_drivers_brake_after_their_reaction_time(void **unused)
{
    (void)unused;
    // The first drift is known by now; let somebody come the other way, 5 s away at its middle.
    drift known = first_drift(0.05, 0);
    cp_traffic *traffic = road_open(0.05);
    cp_controls *controls = create(traffic, 1);
    road_add("ego", 0.0, 0.0, 0.0, 20.0);
    double meet_s = known.begin_s + 5.0;
    road_add("oncoming", 40.0 * (meet_s - 0.05), 3.5, CP_PI, 20.0);
    double noticed_s = 0.0, braked_s = 0.0, drifted_m = 0.0;
    for (int k = 0; cp_traffic_time_s(traffic) < meet_s + 0.5; k++) {
        step(traffic, controls);
        cp_error error = {0};
        char *counters;
        assert_int_equal(cp_controls_counters_json(controls, &counters, &error), CP_OK);
        if (noticed_s == 0.0 && strstr(counters, "\"lane_drift.reactions_of_oncoming\":1.0"))
            noticed_s = cp_traffic_time_s(traffic);
        free(counters);
        if (braked_s == 0.0 && cp_traffic_motion_of(traffic, 1)->after.speed_m_s < 20.0)
            braked_s = cp_traffic_time_s(traffic);
        drifted_m = fmax(drifted_m, overlay(traffic, 0).offset_m);
    }
    // Not before they are on a collision course; then after 0.5 s at least.
    assert_true(noticed_s > known.begin_s && drifted_m > 1.5);
    assert_true(braked_s >= noticed_s + 0.4 && braked_s < noticed_s + 3.1);
    assert_true(road.cars[0].command_m_s < 0.0);

    // The danger past, he drives on.
    for (int k = 0; k < 100; k++)
        step(traffic, controls);
    assert_true(road.cars[1].command_m_s < 0.0);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_driver_drifts_looks_up_and_steers_back),
        cmocka_unit_test(neither_step_length_nor_company_changes_a_draw),
        cmocka_unit_test(who_takes_the_wheel_ends_the_error),
        cmocka_unit_test(oncoming_drivers_brake_after_their_reaction_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
