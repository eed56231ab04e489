/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/lookout.h"

#include "control/scripted_road.h"
#include "core/units.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

static cp_lookout_settings plain(void)
{
    return (cp_lookout_settings){.sensor = {100.0, CP_PI, 0.0},
                                 .detection_probability_1 = 1.0,
                                 .has_class = {true, true, true, true},
                                 .ttc_s = 1.5,
                                 .horizon_s = 4.0,
                                 .key = cp_rng_key_seed(3)};
}

/* Step the cars on the road, drive before each step, until car 0 has a threat; false after 5 s
 * without. */
static bool find_threat_driving(cp_traffic *traffic, const cp_lookout_settings *settings,
                                void (*drive)(void), cp_threat *threat)
{
    cp_lookout lookout = cp_lookout_create(settings, traffic);
    cp_error error = {0};
    bool found = false;
    while (!found && road.time_s < 5.0) {
        drive();
        assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
        assert_int_equal(cp_lookout_step(&lookout, &error), CP_OK);
        const cp_vehicle_motion *own = cp_traffic_motion_of(traffic, 0);
        assert_int_equal(cp_lookout_track(&lookout, own, &error), CP_OK);
        assert_int_equal(cp_lookout_threat(&lookout, own, &found, threat, &error), CP_OK);
    }
    cp_lookout_destroy(&lookout);
    return found;
}

static void drive_on(void)
{
}

static bool find_threat(cp_traffic *traffic, const cp_lookout_settings *settings, cp_threat *threat)
{
    return find_threat_driving(traffic, settings, drive_on, threat);
}

static void the_instant_lies_inside_the_step(void **unused)
{
    (void)unused;
    // 20 m/s to a standing car, gap 50.3 m from 0.1 s on: 1.5 s are left at 0.1 + 1.015 s.
    cp_lookout_settings settings = plain();
    const double steps_s[] = {0.1, 0.05, 0.02};
    for (size_t k = 0; k < 3; k++) {
        cp_threat threat;
        cp_traffic *traffic = road_open(steps_s[k]);
        road_add("own", 0.0, 0.0, 0.0, 20.0);
        road_add("standing", 50.3 + 4.5, 0.0, 0.0, 0.0);
        assert_true(find_threat(traffic, &settings, &threat));
        assert_true(fabs(threat.instant_s - (steps_s[k] + 1.015)) < 1e-9);
        assert_int_equal(threat.class, CP_TARGET_REAR_END);
        assert_int_equal(threat.vehicle, 1);
        cp_traffic_destroy(traffic);
    }
}

static void required_deceleration_comes_on_top(void **unused)
{
    (void)unused;
    // v / (2 TTC) >= 8 m/s^2 from TTC = 1.25 s on.
    cp_lookout_settings settings = plain();
    settings.required_m_s2 = 8.0;
    cp_threat threat;
    cp_traffic *traffic = road_open(0.05);
    road_add("own", 0.0, 0.0, 0.0, 20.0);
    road_add("standing", 50.3 + 4.5, 0.0, 0.0, 0.0);
    assert_true(find_threat(traffic, &settings, &threat));
    assert_true(fabs(threat.instant_s - (0.05 + 1.265)) < 1e-9);
    cp_traffic_destroy(traffic);
}

static void confirmation_takes_its_time(void **unused)
{
    (void)unused;
    // In range from the first step on, a threat at once, known 0.3 s later.
    cp_lookout_settings settings = plain();
    settings.confirmation_s = 0.3;
    cp_threat threat;
    cp_traffic *traffic = road_open(0.05);
    road_add("own", 0.0, 0.0, 0.0, 20.0);
    road_add("standing", 25.0 + 4.5, 0.0, 0.0, 0.0);
    assert_true(find_threat(traffic, &settings, &threat));
    assert_true(fabs(threat.instant_s - 0.35) < 1e-9);
    cp_traffic_destroy(traffic);
}

static void classes_are_switched_one_by_one(void **unused)
{
    (void)unused;
    static const struct {
        double x_m, y_m, yaw_rad, speed_m_s, curvature_1_m;
        cp_target_class class;
    } TARGETS[] = {
        {44.5, 0.0, 0.0, 2.0, 0.0, CP_TARGET_REAR_END},
        {60.0, 0.5, CP_PI, 5.0, 0.0, CP_TARGET_ONCOMING},
        {40.0, -4.0, 0.5 * CP_PI, 1.5, 0.0, CP_TARGET_CROSSING},
        {44.0, 4.0, CP_PI, 3.0, 0.1, CP_TARGET_TURNING},
    };
    for (size_t k = 0; k < sizeof TARGETS / sizeof *TARGETS; k++) {
        for (int is_on = 0; is_on < 2; is_on++) {
            cp_lookout_settings settings = plain();
            for (int class = 0; class < CP_TARGET_CLASSES; class ++)
                settings.has_class[class] = ((cp_target_class) class == TARGETS[k].class) == is_on;
            cp_threat threat;
            cp_traffic *traffic = road_open(0.05);
            road_add("own", 0.0, 0.0, 0.0, 15.0);
            road_add("target", TARGETS[k].x_m, TARGETS[k].y_m, TARGETS[k].yaw_rad,
                     TARGETS[k].speed_m_s)
                ->curvature_1_m = TARGETS[k].curvature_1_m;
            bool found = find_threat(traffic, &settings, &threat);
            if (found != (bool)is_on)
                fail_msg("target %zu, class on: %d", k, is_on);
            if (found)
                assert_int_equal(threat.class, TARGETS[k].class);
            cp_traffic_destroy(traffic);
        }
    }
}

static void cars_waiting_beside_a_turn_are_no_threat(void **unused)
{
    (void)unused;
    // Own left turn of radius 10 m, 90 degrees; a car waits where the circle would lead on to.
    cp_lookout_settings settings = plain();
    cp_threat threat;
    cp_traffic *traffic = road_open(0.05);
    road_add("own", 0.0, 0.0, 0.0, 7.0)->curvature_1_m = 0.1;
    road_add("waiting", 3.0, 15.5, 0.0, 0.0);
    assert_false(find_threat(traffic, &settings, &threat));
    cp_traffic_destroy(traffic);

    // Straight into it, it is one.
    traffic = road_open(0.05);
    road_add("own", -20.0, 15.5, 0.0, 7.0);
    road_add("waiting", 3.0, 15.5, 0.0, 0.0);
    assert_true(find_threat(traffic, &settings, &threat));
    cp_traffic_destroy(traffic);
}

static void brake(road_car *car, double deceleration_m_s2)
{
    if (road.time_s > 0.0)
        car->command_m_s = fmax(0.0, car->state.speed_m_s - deceleration_m_s2 * road.step_s);
}

static void brake_to_a_stop(void)
{
    brake(&road.cars[1], 3.0);
}

static void brake_a_little(void)
{
    brake(&road.cars[1], 0.5);
}

static void a_car_that_stops_beside_the_way_is_no_threat(void **unused)
{
    (void)unused;
    // From the other direction, about to turn across the own way: it comes to rest 0.4 m short of
    // it, or goes on into it.
    for (int stops = 0; stops < 2; stops++) {
        cp_lookout_settings settings = plain();
        cp_threat threat;
        cp_traffic *traffic = road_open(0.05);
        road_add("own", 0.0, 0.0, 0.0, 20.0);
        road_add("turning", 40.0, 2.7, -2.57, 2.5);
        assert_int_equal(find_threat_driving(traffic, &settings,
                                             stops ? brake_to_a_stop : brake_a_little, &threat),
                         !stops);
        cp_traffic_destroy(traffic);
    }
}

static void gain_speed(void)
{
    brake(&road.cars[1], -2.5);
}

static void a_car_that_will_be_past_is_no_threat(void **unused)
{
    (void)unused;
    // Crossing from the right at 4 m/s, its tail in the way in 1.5 s; gaining speed it is past by
    // then.
    for (int gains = 0; gains < 2; gains++) {
        cp_lookout_settings settings = plain();
        cp_threat threat;
        cp_traffic *traffic = road_open(0.05);
        road_add("own", 0.0, 0.0, 0.0, 12.0);
        road_add("crossing", 22.0, -3.2, 0.5 * CP_PI, 4.0);
        assert_int_equal(
            find_threat_driving(traffic, &settings, gains ? gain_speed : drive_on, &threat),
            !gains);
        cp_traffic_destroy(traffic);
    }
}

static void brake_hard(void)
{
    brake(&road.cars[0], 6.0);
}

static void a_driver_who_brakes_enough_needs_nobody(void **unused)
{
    (void)unused;
    // 20 m/s, 38 m to a standing car: 5.3 m/s^2 are enough. An oncoming one comes all the same.
    for (int oncoming = 0; oncoming < 2; oncoming++) {
        cp_lookout_settings settings = plain();
        settings.ttc_s = 2.4;
        settings.required_m_s2 = 3.5;
        settings.confirmation_s = 0.2;
        cp_threat threat;
        cp_traffic *traffic = road_open(0.05);
        road_add("own", 0.0, 0.0, 0.0, 20.0);
        road_add("ahead", oncoming ? 80.0 : 38.0 + 4.5, 0.0, oncoming ? CP_PI : 0.0,
                 oncoming ? 20.0 : 0.0);
        assert_int_equal(find_threat_driving(traffic, &settings, brake_hard, &threat), oncoming);
        if (oncoming)
            assert_true(threat.instant_s < 0.3);
        cp_traffic_destroy(traffic);
    }
}

static void where_a_tight_corner_leads_is_not_known(void **unused)
{
    (void)unused;
    // 7 m/s round a corner of 4 m, 1.2 g, past a car waiting straight ahead; the same without a
    // corner.
    for (int turns = 0; turns < 2; turns++) {
        cp_lookout_settings settings = plain();
        settings.confirmation_s = 0.1;
        cp_threat threat;
        cp_traffic *traffic = road_open(0.05);
        road_add("own", 0.0, 0.0, 0.0, 7.0)->curvature_1_m = turns ? 0.25 : 0.0;
        road_add("waiting", turns ? 6.0 : 10.0, turns ? 4.2 : 0.0, CP_PI, 0.0);
        road.time_s = turns ? 4.3 : 0.0; // the first 0.7 s of the corner
        assert_int_equal(find_threat(traffic, &settings, &threat), !turns);
        cp_traffic_destroy(traffic);
    }
}

// To the left and straight again.
static void move_within_the_lane(void)
{
    double time_s = road.time_s;
    road.cars[1].curvature_1_m = time_s < 0.4 ? 0.002 : time_s < 0.8 ? -0.002 : 0.0;
}

static void moving_a_little_within_the_lane_is_no_threat(void **unused)
{
    (void)unused;
    // An oncoming car with 1.3 m of air between, and one that comes over.
    for (int comes_over = 0; comes_over < 2; comes_over++) {
        cp_lookout_settings settings = plain();
        settings.ttc_s = 2.4;
        cp_threat threat;
        cp_traffic *traffic = road_open(0.05);
        road_add("own", 0.0, 0.0, 0.0, 18.0);
        road_add("oncoming", 84.0, 3.1, CP_PI + 0.06 * comes_over, 22.0);
        assert_int_equal(find_threat_driving(traffic, &settings, move_within_the_lane, &threat),
                         comes_over);
        cp_traffic_destroy(traffic);
    }
}

static void what_is_hidden_is_not_known(void **unused)
{
    (void)unused;
    // A standing row of cars beside the way hides one that comes out from behind it.
    for (int is_hidden = 0; is_hidden < 2; is_hidden++) {
        cp_lookout_settings settings = plain();
        settings.has_occlusion = is_hidden;
        cp_threat threat;
        cp_traffic *traffic = road_open(0.05);
        road_add("own", 0.0, 0.0, 0.0, 10.0);
        road_add("crossing", 42.0, -24.0, 0.5 * CP_PI, 6.0);
        for (int k = 0; k < 6; k++)
            road_add("parked", 10.0 + 5.0 * k, -2.2, 0.0, 0.0);
        settings.confirmation_s = 0.5;
        assert_true(find_threat(traffic, &settings, &threat));
        assert_int_equal(threat.vehicle, 1);
        // In the open it is known long before it is a threat.
        assert_true(is_hidden ? threat.ttc_s < 1.2 : threat.ttc_s > 1.4);
        cp_traffic_destroy(traffic);
    }
}

static void some_targets_are_never_detected(void **unused)
{
    (void)unused;
    int found = 0;
    for (int k = 0; k < 60; k++) {
        cp_lookout_settings settings = plain();
        settings.detection_probability_1 = 0.5;
        cp_threat threat;
        cp_traffic *traffic = road_open(0.1);
        char id[16];
        snprintf(id, sizeof id, "standing%d", k);
        road_add("own", 0.0, 0.0, 0.0, 20.0);
        road_add(id, 40.0, 0.0, 0.0, 0.0);
        found += find_threat(traffic, &settings, &threat);
        cp_traffic_destroy(traffic);
    }
    assert_true(found > 15 && found < 45);
}

// ---- a junction with a sign --------------------------------------------------------------

static cp_lane_map *sign_map;
static cp_next_light sign_light; /* of car 0 */

static cp_status sign_lane_map(const cp_lane_map **map, cp_error *error)
{
    (void)error;
    *map = sign_map;
    return CP_OK;
}

static cp_status sign_next_lanes(uint32_t vehicle, uint32_t *lanes, size_t room, size_t *count,
                                 cp_error *error)
{
    (void)room, (void)error;
    lanes[0] = 1;
    *count = vehicle == 0 ? 1 : 0;
    return CP_OK;
}

static cp_status sign_next_light(uint32_t vehicle, cp_next_light *light, cp_error *error)
{
    (void)error;
    *light = sign_light;
    if (vehicle != 0)
        *light = (cp_next_light){.distance_m = INFINITY, .number = CP_NO_NUMBER};
    else if (sign_light.is_red)
        light->distance_m = 100.0 - road.cars[0].state.front_x_m;
    return CP_OK;
}

/* Car 0 comes at 15 m/s along a road whose end, where the sign would be, is at x = 100 m; a slow
 * one crosses behind it. Place at which it became a threat. */
static double threat_at_m(bool gives_way, bool is_red)
{
    static const cp_lane_point own[] = {{0, 0, 0, 0}, {100, 0, 0, 100}};
    static const cp_lane_point on[] = {{100, 0, 0, 0}, {200, 0, 0, 100}};
    static const cp_lane_point across[] = {{110, -50, 0, 0}, {110, 50, 0, 100}};
    const cp_lane_link link[] = {{1, CP_LANE_NONE, gives_way}};
    const cp_lane lanes[] = {{.point = own, .point_count = 2, .link = link, .link_count = 1},
                             {.point = on, .point_count = 2, .edge = 1},
                             {.point = across, .point_count = 2, .edge = 2}};
    cp_traffic_source source = ROAD;
    cp_lookout_settings settings = plain();
    cp_traffic *traffic = NULL;
    cp_threat threat;
    cp_error error = {0};
    assert_int_equal(cp_lane_map_create(lanes, 3, &sign_map, &error), CP_OK);
    source.lane_map = sign_lane_map;
    source.next_lanes = sign_next_lanes;
    source.next_light = sign_next_light;
    sign_light = (cp_next_light){.distance_m = INFINITY, .is_red = is_red};
    settings.ttc_s = 3.0;
    memset(&road, 0, sizeof road);
    road.step_s = 0.05;
    assert_int_equal(cp_traffic_create_from(&source, 0.05, &traffic, &error), CP_OK);
    assert_int_equal(cp_road_view_create(traffic, &settings.view, &error), CP_OK);
    road_add("own", 30.0, 0.0, 0.0, 15.0);
    road_add("across", 110.0, -6.0, CP_PI / 2.0, 1.5)->state.lane = 2;
    assert_true(find_threat(traffic, &settings, &threat));
    cp_road_view_destroy(settings.view);
    cp_traffic_destroy(traffic);
    cp_lane_map_destroy(sign_map);
    return 30.0 + 15.0 * (threat.instant_s - 0.05);
}

static void who_can_still_wait_at_ease_is_left_alone(void **unused)
{
    (void)unused;
    // 3 s before the contact at x = 109.1 m.
    assert_true(fabs(threat_at_m(false, false) - (109.1 - 45.0)) < 0.1);
    // From 15 m/s he stops within 25 m at ease: a threat when the line is nearer.
    assert_true(fabs(threat_at_m(true, false) - 75.0) < 0.1);
    assert_true(fabs(threat_at_m(false, true) - 75.0) < 1.0);
}

static void who_brakes_at_ease_for_a_queue_is_left_alone(void **unused)
{
    (void)unused;
    // A standing car 24 m ahead takes 4.7 m/s2 from 15 m/s, one 26 m ahead 4.3, for which braking
    // with 3 m/s2 will do, for now. (road_step: the command holds for the step before the look.)
    for (int is_far = 0; is_far < 2; is_far++) {
        cp_lookout_settings settings = plain();
        cp_error error = {0};
        cp_threat threat;
        bool found = false;
        settings.required_m_s2 = 3.0;
        settings.ttc_s = 2.4;
        cp_traffic *traffic = road_open(0.1);
        cp_lookout lookout = cp_lookout_create(&settings, traffic);
        road_car *own = road_add("own", 0.0, 0.0, 0.0, 15.3);
        road_add("standing", 1.515 + (is_far ? 26.0 : 24.0) + 4.5, 0.0, 0.0, 0.0);
        assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
        own->command_m_s = 15.0;
        assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
        assert_int_equal(cp_lookout_step(&lookout, &error), CP_OK);
        const cp_vehicle_motion *motion = cp_traffic_motion_of(traffic, 0);
        assert_int_equal(cp_lookout_track(&lookout, motion, &error), CP_OK);
        assert_int_equal(cp_lookout_threat(&lookout, motion, &found, &threat, &error), CP_OK);
        assert_int_equal(found, !is_far);
        cp_lookout_destroy(&lookout);
        cp_traffic_destroy(traffic);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_instant_lies_inside_the_step),
        cmocka_unit_test(required_deceleration_comes_on_top),
        cmocka_unit_test(confirmation_takes_its_time),
        cmocka_unit_test(classes_are_switched_one_by_one),
        cmocka_unit_test(cars_waiting_beside_a_turn_are_no_threat),
        cmocka_unit_test(a_car_that_stops_beside_the_way_is_no_threat),
        cmocka_unit_test(a_car_that_will_be_past_is_no_threat),
        cmocka_unit_test(a_driver_who_brakes_enough_needs_nobody),
        cmocka_unit_test(where_a_tight_corner_leads_is_not_known),
        cmocka_unit_test(moving_a_little_within_the_lane_is_no_threat),
        cmocka_unit_test(what_is_hidden_is_not_known),
        cmocka_unit_test(who_can_still_wait_at_ease_is_left_alone),
        cmocka_unit_test(who_brakes_at_ease_for_a_queue_is_left_alone),
        cmocka_unit_test(some_targets_are_never_detected),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
