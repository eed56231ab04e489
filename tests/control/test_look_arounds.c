/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "control/bend_road.h"
#include "control/road_view.h"

#include <jansson.h>

/* Drivers who look round (who react to a drifting car, look up when it gets dangerous, misjudge a
 * gap) see what is to come along the lanes, and nobody on a road that does not lead there. */

#define STEP_S 0.1

// Two cars come towards each other in a bend of 100 m, the second on a lane; TTC the first sees.
static double ttc_in_bend_s(uint32_t lane, double sign_1, cp_road_relation relation)
{
    cp_road_view *view;
    cp_error error = {0};
    double ttc_s = 0.0;
    lay_bend(100.0, 5.0, 100.0);
    bend.relation = relation;
    cp_traffic *traffic = open_bend_road(STEP_S);
    assert_int_equal(cp_road_view_create(traffic, &view, &error), CP_OK);
    // 40 m apart along the lanes.
    double other_m = lane == 0 ? 180.0 : bend.point[1][bend.count - 1].at_m - 180.0;
    add_car("own", 0, 140.0, 1.0, 10.0);
    add_car("other", lane, other_m, sign_1, 10.0);
    for (int k = 0; k < 3; k++)
        assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
    assert_int_equal(cp_road_view_ttc_s(view, cp_traffic_motion_of(traffic, 0),
                                        cp_traffic_motion_of(traffic, 1), 5.0, &ttc_s, &error),
                     CP_OK);
    cp_road_view_destroy(view);
    cp_traffic_destroy(traffic);
    cp_lane_map_destroy(bend.map);
    return ttc_s;
}

static void who_comes_in_the_own_lane_is_seen_round_the_bend(void **unused)
{
    (void)unused;
    // Two steps have gone.
    double found_s = ttc_in_bend_s(0, -1.0, CP_ROADS_MEET);
    assert_true(fabs(found_s - (40.0 / 20.0 - 0.2)) < 0.05);
}

static void who_comes_in_the_other_lane_is_no_danger(void **unused)
{
    (void)unused;
    assert_true(ttc_in_bend_s(1, 1.0, CP_ROADS_MEET) == INFINITY);
}

static void nobody_on_another_road_is_a_danger(void **unused)
{
    (void)unused;
    assert_true(ttc_in_bend_s(0, -1.0, CP_ROADS_APART) == INFINITY);
    assert_true(ttc_in_bend_s(0, -1.0, CP_ROADS_OTHER_LEVEL) == INFINITY);
}

// Gaps misjudged while another comes towards a driver.
static double misjudged(cp_road_relation relation)
{
    static const char *const names[] = {"probability_1", NULL};
    const double values[] = {1.0};
    cp_control_settings settings =
        road_settings(CP_CONTROL_DRIVER_ERROR, "misjudged_gap", names, values);
    cp_controls *controls;
    cp_error error = {0};
    char *json = NULL;
    lay_bend(1000.0, 5.0, 200.0);
    bend.relation = relation;
    cp_traffic *traffic = open_bend_road(STEP_S);
    assert_int_equal(cp_controls_create(&settings, 1, 5, 1, traffic, &controls, &error), CP_OK);
    add_car("waits", 0, 150.0, 1.0, 0.0);
    add_car("comes", 0, 200.0, -1.0, 15.0);
    for (int k = 0; k < 25; k++) {
        assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
        assert_int_equal(cp_controls_step(controls, &error), CP_OK);
    }
    assert_int_equal(cp_controls_counters_json(controls, &json, &error), CP_OK);
    json_t *counters = json_loads(json, 0, NULL);
    double found = json_number_value(json_object_get(counters, "misjudged_gap.misjudged"));
    json_decref(counters);
    free(json);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
    cp_lane_map_destroy(bend.map);
    return found;
}

static void gaps_are_misjudged_before_those_who_can_come_here(void **unused)
{
    (void)unused;
    assert_true(misjudged(CP_ROADS_MEET) == 1.0);
    assert_true(misjudged(CP_ROADS_APART) == 0.0);
    assert_true(misjudged(CP_ROADS_OTHER_LEVEL) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(who_comes_in_the_own_lane_is_seen_round_the_bend),
        cmocka_unit_test(who_comes_in_the_other_lane_is_no_danger),
        cmocka_unit_test(nobody_on_another_road_is_a_danger),
        cmocka_unit_test(gaps_are_misjudged_before_those_who_can_come_here),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
