/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/detector.h"

#include "core/rng.h"
#include "core/units.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "builders/assert_near.h"
#include "builders/drive.h"

#define CARS_MAX 400

/* Names by vehicle number; a test may set its own. */
typedef struct names {
    const char *of[CARS_MAX];
} names;

static const char *name_of(const void *context, uint32_t vehicle)
{
    const names *list = context;
    return list->of[vehicle];
}

static const names ALPHABETIC = {.of = {"a", "b", "c", "d", "e", "f"}};

/* What a detector reported over a whole drive. */
typedef struct findings {
    cp_impact impact[32];
    size_t count;
} findings;

/* Drive count cars (numbered 0, 1, ...) from time 0 to end_s and collect what is reported. */
static findings watch(const drive *car, uint32_t count, const names *list, double end_s,
                      double dt_s, bool (*is_at_fault)(void *, uint32_t))
{
    findings found = {0};
    cp_detector *detector;
    assert_int_equal(cp_detector_create(&detector, NULL), CP_OK);
    cp_vehicle_motion motion[CARS_MAX];
    for (int step = 1; step <= lround(end_s / dt_s); step++) {
        double time_s = step * dt_s;
        cp_detector_scene scene = {.motions = motion,
                                   .step_length_s = dt_s,
                                   .time_s = time_s,
                                   .vehicle_id = name_of,
                                   .id_context = list,
                                   .is_at_fault = is_at_fault};
        for (uint32_t k = 0; k < count; k++)
            if (time_s >= car[k].inserted_s)
                motion[scene.count++] = drive_motion(&car[k], k, time_s, dt_s);
        const cp_impact *impact;
        size_t impact_count;
        assert_int_equal(cp_detector_scan(detector, &scene, &impact, &impact_count, NULL), CP_OK);
        for (size_t k = 0; k < impact_count; k++) {
            assert_true(found.count < 32);
            assert_true(impact[k].time_s >= time_s - dt_s - 1e-12 &&
                        impact[k].time_s <= time_s + 1e-12);
            found.impact[found.count++] = impact[k];
        }
    }
    cp_detector_destroy(detector);
    return found;
}

static cp_impact watch_pair(drive one, drive other, double dt_s)
{
    drive car[2] = {one, other};
    findings found = watch(car, 2, &ALPHABETIC, 3.0, dt_s, NULL);
    assert_int_equal(found.count, 1);
    return found.impact[0];
}

static void oncoming_cars_at_any_step_length(void **state)
{
    (void)state;
    drive a = {.speed_m_s = 15.0};
    drive b = {.x_m = 31.0, .y_m = 0.6, .yaw_rad = CP_PI, .speed_m_s = 10.0};
    static const double STEP_S[] = {0.1, 0.05, 0.01};
    for (int k = 0; k < 3; k++) {
        cp_impact impact = watch_pair(a, b, STEP_S[k]);
        assert_near(impact.time_s, 1.24, 1e-9);
        assert_near(impact.contact_m.x, 18.6, 1e-9);
        assert_near(impact.contact_m.y, 0.3, 1e-9);
        assert_near(impact.state[0].front_x_m, 18.6, 1e-9);
        assert_near(impact.front_velocity_m_s[1].x, -10.0, 1e-9);
        assert_int_equal(impact.vehicle[0], 0);
        assert_int_equal(impact.side[0], CP_SIDE_FRONT);
        assert_int_equal(impact.side[1], CP_SIDE_FRONT);
        assert_int_equal(impact.verdict, CP_CONTACT_CONFIRMED);
    }
}

static void the_car_whose_front_is_struck_is_a(void **state)
{
    (void)state;
    // b drives square into the left side of a, which crosses northwards.
    drive crossing = {.x_m = 10.9, .y_m = -9.75, .yaw_rad = CP_PI / 2, .speed_m_s = 12.0};
    drive through = {.speed_m_s = 10.0};
    cp_impact impact = watch_pair(crossing, through, 0.1);
    assert_near(impact.time_s, 1.0, 1e-9);
    assert_int_equal(impact.vehicle[0], 1);
    assert_int_equal(impact.side[0], CP_SIDE_FRONT);
    assert_int_equal(impact.side[1], CP_SIDE_LEFT);
    assert_int_equal(impact.verdict, CP_CONTACT_CONFIRMED);

    // And into the rear of a car ahead, 10 m away and 5 m/s slower.
    drive ahead = {.x_m = 14.5, .speed_m_s = 5.0};
    impact = watch_pair(ahead, through, 0.1);
    assert_near(impact.time_s, 2.0, 1e-9);
    assert_int_equal(impact.vehicle[0], 1);
    assert_int_equal(impact.side[1], CP_SIDE_REAR);
}

static bool number_one_errs(void *context, uint32_t vehicle)
{
    (void)context;
    return vehicle == 1;
}

static bool all_err(void *context, uint32_t vehicle)
{
    (void)context;
    (void)vehicle;
    return true;
}

static void between_two_fronts_fault_decides_and_then_the_id(void **state)
{
    (void)state;
    drive car[2] = {{.speed_m_s = 15.0}, {.x_m = 31.0, .yaw_rad = CP_PI, .speed_m_s = 10.0}};
    names reversed = {.of = {"veh10", "veh1"}};
    assert_int_equal(watch(car, 2, &ALPHABETIC, 2.0, 0.1, NULL).impact[0].vehicle[0], 0);
    assert_int_equal(watch(car, 2, &ALPHABETIC, 2.0, 0.1, number_one_errs).impact[0].vehicle[0], 1);
    assert_int_equal(watch(car, 2, &ALPHABETIC, 2.0, 0.1, all_err).impact[0].vehicle[0], 0);
    assert_int_equal(watch(car, 2, &reversed, 2.0, 0.1, NULL).impact[0].vehicle[0], 1);
    assert_int_equal(watch(car, 2, &reversed, 2.0, 0.1, all_err).impact[0].vehicle[0], 1);
}

static void a_well_braked_touch_is_a_confirmed_crash(void **state)
{
    (void)state;
    // From 15 m/s at 8 m/s^2 into a standing car at 1, 2, 3 m/s, whatever the step.
    static const double STEP_S[] = {0.2, 0.1, 0.05, 0.01};
    for (int touch_m_s = 1; touch_m_s <= 3; touch_m_s++)
        for (int k = 0; k < 4; k++) {
            drive braking = {.speed_m_s = 15.0, .acceleration_m_s2 = -8.0};
            double way_m = (225.0 - touch_m_s * touch_m_s) / 16.0;
            drive standing = {.x_m = way_m + 4.5, .y_m = 0.3};
            cp_impact impact = watch_pair(braking, standing, STEP_S[k]);
            assert_near(impact.time_s, (15.0 - touch_m_s) / 8.0, 1e-9);
            assert_near(impact.state[0].speed_m_s, touch_m_s, 1e-9);
            assert_int_equal(impact.verdict, CP_CONTACT_CONFIRMED);
        }
}

static void a_touch_at_walking_pace_from_behind_is_a_graze(void **state)
{
    (void)state;
    drive creeping = {.speed_m_s = 0.7}, standing = {.x_m = 4.5 + 1.0};
    assert_int_equal(watch_pair(creeping, standing, 0.1).verdict, CP_CONTACT_GRAZE);
}

static void cars_set_down_on_each_other_did_not_crash(void **state)
{
    (void)state;
    // The second appears on the first at 1 s; they stay there and are told once.
    drive car[2] = {{.speed_m_s = 10.0}, {.x_m = 1.0, .speed_m_s = 10.0, .inserted_s = 1.0}};
    findings found = watch(car, 2, &ALPHABETIC, 3.0, 0.1, NULL);
    assert_int_equal(found.count, 1);
    assert_int_equal(found.impact[0].verdict, CP_CONTACT_AT_INSERTION);
    assert_near(found.impact[0].time_s, 1.0, 1e-9);

    // Appearing beside the other is no contact; driving into it afterwards is a crash.
    car[1] = (drive){.x_m = 20.0, .speed_m_s = 2.0, .inserted_s = 1.0};
    found = watch(car, 2, &ALPHABETIC, 3.0, 0.1, NULL);
    assert_int_equal(found.count, 1);
    assert_int_equal(found.impact[0].verdict, CP_CONTACT_CONFIRMED);
}

static void an_instant_lane_change_onto_another_car_did_not_crash(void **state)
{
    (void)state;
    drive car[2] = {{.speed_m_s = 20.0}, {.y_m = 3.2, .speed_m_s = 20.0}};
    cp_vehicle_motion motion[2] = {drive_motion(&car[0], 0, 0.1, 0.1),
                                   drive_motion(&car[1], 1, 0.1, 0.1)};
    motion[1].after.front_y_m = 0.0;
    cp_detector_scene scene = {.motions = motion,
                               .count = 2,
                               .step_length_s = 0.1,
                               .time_s = 0.1,
                               .vehicle_id = name_of,
                               .id_context = &ALPHABETIC};
    cp_detector *detector;
    const cp_impact *impact;
    size_t count;
    assert_int_equal(cp_detector_create(&detector, NULL), CP_OK);
    assert_int_equal(cp_detector_scan(detector, &scene, &impact, &count, NULL), CP_OK);
    assert_int_equal(count, 1);
    assert_int_equal(impact[0].verdict, CP_CONTACT_LANE_CHANGE_JUMP);
    assert_near(impact[0].front_velocity_m_s[1].y, 0.0, 1e-12);
    cp_detector_destroy(detector);
}

/* A pair that creeps together (graze), parts, and meets again: one row a time and distance. */
static size_t creep_and_crash(double parted_m, cp_impact found[4])
{
    // b stands; a's front goes 2 cm into it at 0.1 m/s, back to parted_m before it, then in at 10.
    const double dt_s = 0.1;
    double front_m = -0.05, speed_m_s = 0.1;
    size_t count = 0;
    cp_detector *detector;
    assert_int_equal(cp_detector_create(&detector, NULL), CP_OK);
    drive standing = {.x_m = 4.5};
    for (int step = 1; step <= 200; step++) {
        if (front_m > 0.02)
            speed_m_s = -0.1;
        if (speed_m_s < 0.0 && front_m < -parted_m)
            speed_m_s = 10.0;
        drive creeping = {.x_m = front_m, .speed_m_s = speed_m_s};
        cp_vehicle_motion motion[2] = {drive_motion(&creeping, 0, dt_s, dt_s),
                                       drive_motion(&standing, 1, dt_s, dt_s)};
        front_m += speed_m_s * dt_s;
        cp_detector_scene scene = {.motions = motion,
                                   .count = 2,
                                   .step_length_s = dt_s,
                                   .time_s = step * dt_s,
                                   .vehicle_id = name_of,
                                   .id_context = &ALPHABETIC};
        const cp_impact *impact;
        size_t impact_count;
        assert_int_equal(cp_detector_scan(detector, &scene, &impact, &impact_count, NULL), CP_OK);
        for (size_t k = 0; k < impact_count && count < 4; k++)
            found[count++] = impact[k];
        if (front_m > 3.0)
            break;
    }
    cp_detector_destroy(detector);
    return count;
}

static void after_a_graze_a_pair_that_parted_can_crash(void **state)
{
    (void)state;
    cp_impact found[4];
    assert_int_equal(creep_and_crash(0.2, found), 2);
    assert_int_equal(found[0].verdict, CP_CONTACT_GRAZE);
    assert_int_equal(found[1].verdict, CP_CONTACT_CONFIRMED);
    assert_near(found[1].state[0].speed_m_s, 10.0, 1e-9);

    // Not parted: it is still the first contact.
    assert_int_equal(creep_and_crash(0.03, found), 1);
}

static void a_corner_of_a_waiting_car_is_clipped_unless_somebody_errs(void **state)
{
    (void)state;
    // A bus passes a standing, turned car whose corner lies 0.5 m in its way; and 1.3 m.
    static const double Y_M[] = {1.2, 0.4};
    for (int k = 0; k < 2; k++) {
        drive car[2] = {{.x_m = 20.0, .y_m = Y_M[k], .yaw_rad = CP_PI + 0.35},
                        {.speed_m_s = 12.0, .length_m = 12.0, .width_m = 2.5}};
        findings found = watch(car, 2, &ALPHABETIC, 3.0, 0.1, NULL);
        assert_int_equal(found.count, 1);
        assert_int_equal(found.impact[0].verdict,
                         k == 0 ? CP_CONTACT_CLIPPED_WAITING : CP_CONTACT_CONFIRMED);
        found = watch(car, 2, &ALPHABETIC, 3.0, 0.1, all_err);
        assert_int_equal(found.impact[0].verdict, CP_CONTACT_CONFIRMED);
    }
}

static void what_turns_on_the_spot_is_struck_like_what_stands(void **state)
{
    (void)state;
    // A car that has braked to rest in a lane change, as SUMO turns it, and an oncoming one.
    drive turning = {.yaw_rate_rad_s = 0.4}, oncoming = {.x_m = 6.0, .yaw_rad = CP_PI};
    oncoming.speed_m_s = 5.0;
    cp_impact struck = watch_pair(turning, oncoming, 0.05);
    assert_int_equal(struck.verdict, CP_CONTACT_CONFIRMED);
    assert_int_equal(struck.side[0], CP_SIDE_FRONT);
    assert_true(struck.yaw_rate_rad_s[0] == 0.0);
    assert_near(struck.front_velocity_m_s[1].x, -5.0, 1e-9);

    // Its rear swings into one that passes: nobody drove into anybody.
    drive swinging = {.yaw_rate_rad_s = -0.4};
    drive passing = {.x_m = -1.0, .y_m = 1.95, .speed_m_s = 5.0};
    assert_int_equal(watch_pair(swinging, passing, 0.05).verdict, CP_CONTACT_IMPOSSIBLE_MOTION);
}

static cp_status relation_of_test(const void *context, const cp_vehicle_state *one,
                                  const cp_vehicle_state *other, cp_road_relation *relation,
                                  cp_error *error)
{
    (void)one;
    (void)other;
    (void)error;
    *relation = *(const cp_road_relation *)context;
    return CP_OK;
}

static cp_impact watch_crossing(const cp_road_relation *relation, cp_vehicle_motion motion[2])
{
    cp_detector_scene scene = {.motions = motion,
                               .count = 2,
                               .step_length_s = 0.1,
                               .time_s = 0.1,
                               .vehicle_id = name_of,
                               .id_context = &ALPHABETIC,
                               .road_relation = relation_of_test,
                               .road_context = relation};
    cp_detector *detector;
    const cp_impact *impact;
    size_t count;
    assert_int_equal(cp_detector_create(&detector, NULL), CP_OK);
    assert_int_equal(cp_detector_scan(detector, &scene, &impact, &count, NULL), CP_OK);
    assert_int_equal(count, 1);
    cp_impact found = impact[0];
    cp_detector_destroy(detector);
    return found;
}

static void what_drives_over_a_bridge_hits_nobody_below(void **state)
{
    (void)state;
    drive car[2] = {{.x_m = -0.5, .speed_m_s = 20.0},
                    {.x_m = 1.9, .y_m = 2.0, .yaw_rad = CP_PI / 2, .speed_m_s = 20.0}};
    cp_vehicle_motion motion[2] = {drive_motion(&car[0], 0, 0.1, 0.1),
                                   drive_motion(&car[1], 1, 0.1, 0.1)};
    static const struct {
        cp_road_relation relation;
        cp_contact_verdict verdict;
    } CASE[] = {{CP_ROADS_MEET, CP_CONTACT_CONFIRMED},
                {CP_ROADS_APART, CP_CONTACT_ROADS_APART},
                {CP_ROADS_OTHER_LEVEL, CP_CONTACT_OTHER_LEVEL}};
    for (int k = 0; k < 3; k++)
        assert_int_equal(watch_crossing(&CASE[k].relation, motion).verdict, CASE[k].verdict);
}

static void a_trailing_part_counts_where_it_follows_the_front(void **state)
{
    (void)state;
    // A car drives into the flank of a 16.5 m vehicle, 15 m or 5 m behind its front.
    static const struct {
        double behind_m, lane_position_m;
        cp_contact_verdict verdict;
    } CASE[] = {{15.0, 8.0, CP_CONTACT_LONG_TURNING},
                {15.0, 100.0, CP_CONTACT_CONFIRMED},
                {5.0, 8.0, CP_CONTACT_CONFIRMED}};
    for (int k = 0; k < 3; k++) {
        drive car[2] = {{.x_m = CASE[k].behind_m, .length_m = 16.5, .width_m = 2.5},
                        {.y_m = -1.75, .yaw_rad = CP_PI / 2, .speed_m_s = 10.0}};
        cp_vehicle_motion motion[2] = {drive_motion(&car[0], 0, 0.1, 0.1),
                                       drive_motion(&car[1], 1, 0.1, 0.1)};
        motion[0].after.lane_position_m = motion[0].before.lane_position_m =
            CASE[k].lane_position_m;
        cp_road_relation meet = CP_ROADS_MEET;
        assert_int_equal(watch_crossing(&meet, motion).verdict, CASE[k].verdict);
    }
}

static void a_confirmed_pair_is_reported_once_for_ever(void **state)
{
    (void)state;
    // c circles and runs through a standing car again and again.
    drive car[2] = {{.y_m = -20.0}, {.speed_m_s = 20.0, .yaw_rate_rad_s = -1.0, .y_m = 0.0}};
    car[0].x_m = 20.0; // on the circle about (0, -20)
    findings found = watch(car, 2, &ALPHABETIC, 30.0, 0.05, NULL);
    assert_int_equal(found.count, 1);
}

static void neighbours_never_touch(void **state)
{
    (void)state;
    // Lanes 2.1 m apart, 0.3 m between the cars: overtaking and oncoming.
    drive car[3] = {{.speed_m_s = 30.0},
                    {.x_m = -20.0, .y_m = 2.1, .speed_m_s = 35.0},
                    {.x_m = 300.0, .y_m = 4.2, .yaw_rad = CP_PI, .speed_m_s = 33.0}};
    assert_int_equal(watch(car, 3, &ALPHABETIC, 10.0, 0.1, NULL).count, 0);
}

static void what_swings_out_between_the_ends_of_a_step_counts(void **state)
{
    (void)state;
    // A bus turns about its front: half-way its tail reaches 9 cm further back than at both ends.
    drive car[2] = {{.yaw_rad = -0.25, .yaw_rate_rad_s = 1.0, .length_m = 12.0, .width_m = 2.5},
                    {.x_m = -12.03, .length_m = 2.0, .width_m = 0.6}};
    findings found = watch(car, 2, &ALPHABETIC, 0.5, 0.5, NULL);
    assert_int_equal(found.count, 1);
    assert_true(found.impact[0].time_s > 0.1 && found.impact[0].time_s < 0.15);
}

static void crashes_of_a_step_come_by_time_then_by_id(void **state)
{
    (void)state;
    // Three head-on pairs far apart; the last pair first, the other two at the same moment.
    drive car[6];
    for (int pair = 0; pair < 3; pair++) {
        car[2 * pair] = (drive){.y_m = 100.0 * pair, .speed_m_s = 10.0};
        car[2 * pair + 1] = (drive){
            .x_m = pair == 2 ? 1.0 : 1.5, .y_m = 100.0 * pair, .yaw_rad = CP_PI, .speed_m_s = 10.0};
    }
    findings found = watch(car, 6, &ALPHABETIC, 0.1, 0.1, NULL);
    assert_int_equal(found.count, 3);
    assert_int_equal(found.impact[0].vehicle[0], 4);
    assert_int_equal(found.impact[1].vehicle[0], 0);
    assert_int_equal(found.impact[2].vehicle[0], 2);
    names reversed = {.of = {"z", "y", "a", "b", "d", "e"}};
    found = watch(car, 6, &reversed, 0.1, 0.1, NULL);
    assert_int_equal(found.impact[0].vehicle[0], 4);
    assert_int_equal(found.impact[1].vehicle[0], 2);
    assert_int_equal(found.impact[2].vehicle[0], 1); // "y" before "z"
}

/* A random encounter near the origin after about 1.5 s. */
static void random_encounter(cp_rng_key key, uint64_t run, drive car[2])
{
    for (uint64_t k = 0; k < 2; k++) {
        double yaw_rad = 2.0 * CP_PI * (cp_rng_uniform(key, 16 * run + 8 * k) - 0.5);
        double speed_m_s = 3.0 + 25.0 * cp_rng_uniform(key, 16 * run + 8 * k + 1);
        double braking_m_s2 = -2.0 * cp_rng_uniform(key, 16 * run + 8 * k + 2);
        double way_m = 1.5 * speed_m_s + 0.5 * 2.25 * braking_m_s2;
        double aside_m = 3.0 * (cp_rng_uniform(key, 16 * run + 8 * k + 3) - 0.5);
        car[k] = (drive){.x_m = -way_m * cos(yaw_rad) - aside_m * sin(yaw_rad),
                         .y_m = -way_m * sin(yaw_rad) + aside_m * cos(yaw_rad),
                         .yaw_rad = yaw_rad,
                         .speed_m_s = speed_m_s,
                         .acceleration_m_s2 = braking_m_s2};
    }
}

static void the_step_length_does_not_matter(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_seed(21);
    int crashes = 0;
    for (uint64_t run = 0; run < 200; run++) {
        drive car[2];
        random_encounter(key, run, car);
        findings coarse = watch(car, 2, &ALPHABETIC, 3.0, 0.1, NULL);
        findings fine = watch(car, 2, &ALPHABETIC, 3.0, 0.01, NULL);
        assert_int_equal(coarse.count, fine.count);
        for (size_t k = 0; k < coarse.count; k++) {
            assert_near(coarse.impact[k].time_s, fine.impact[k].time_s, 1e-9);
            assert_near(coarse.impact[k].contact_m.x, fine.impact[k].contact_m.x, 1e-6);
            assert_near(coarse.impact[k].contact_m.y, fine.impact[k].contact_m.y, 1e-6);
            assert_int_equal(coarse.impact[k].vehicle[0], fine.impact[k].vehicle[0]);
            assert_int_equal(coarse.impact[k].side[0], fine.impact[k].side[0]);
            assert_int_equal(coarse.impact[k].side[1], fine.impact[k].side[1]);
            assert_int_equal(coarse.impact[k].verdict, fine.impact[k].verdict);
            crashes++;
        }
    }
    assert_true(crashes > 100);
}

static cp_contact_side mirrored(cp_contact_side side)
{
    return side == CP_SIDE_LEFT ? CP_SIDE_RIGHT : side == CP_SIDE_RIGHT ? CP_SIDE_LEFT : side;
}

static void a_mirrored_road_gives_mirrored_crashes(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_seed(22);
    for (uint64_t run = 0; run < 200; run++) {
        drive car[2], mirror[2];
        random_encounter(key, run, car);
        for (int k = 0; k < 2; k++) {
            mirror[k] = car[k];
            mirror[k].y_m = -car[k].y_m;
            mirror[k].yaw_rad = -car[k].yaw_rad;
        }
        findings plain = watch(car, 2, &ALPHABETIC, 3.0, 0.1, NULL);
        findings flipped = watch(mirror, 2, &ALPHABETIC, 3.0, 0.1, NULL);
        assert_int_equal(plain.count, flipped.count);
        for (size_t k = 0; k < plain.count; k++) {
            const cp_impact *one = &plain.impact[k], *other = &flipped.impact[k];
            assert_near(one->time_s, other->time_s, 1e-9);
            assert_near(one->contact_m.x, other->contact_m.x, 1e-9);
            assert_near(one->contact_m.y, -other->contact_m.y, 1e-9);
            assert_int_equal(one->verdict, other->verdict);
            for (int role = 0; role < 2; role++) {
                assert_int_equal(one->vehicle[role], other->vehicle[role]);
                assert_int_equal(one->side[role], mirrored(other->side[role]));
            }
        }
    }
}

static void the_order_of_the_vehicles_does_not_matter(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_seed(23);
    names swapped = {.of = {"b", "a"}};
    for (uint64_t run = 0; run < 200; run++) {
        drive car[2], swap[2];
        random_encounter(key, run, car);
        swap[0] = car[1];
        swap[1] = car[0];
        findings plain = watch(car, 2, &ALPHABETIC, 3.0, 0.1, NULL);
        findings turned = watch(swap, 2, &swapped, 3.0, 0.1, NULL);
        assert_int_equal(plain.count, turned.count);
        for (size_t k = 0; k < plain.count; k++) {
            const cp_impact *one = &plain.impact[k], *other = &turned.impact[k];
            assert_true(one->time_s == other->time_s); // to the bit
            assert_true(one->contact_m.x == other->contact_m.x);
            assert_int_equal(one->vehicle[0], 1 - other->vehicle[0]);
            assert_int_equal(one->side[0], other->side[0]);
            assert_int_equal(one->verdict, other->verdict);
        }
    }
}

static void crowded_traffic_matches_all_pairs(void **state)
{
    (void)state;
    // 400 cars criss-cross on 200 m x 200 m for a step: as many contacts as one by one.
    enum { COUNT = 400 };
    cp_rng_key key = cp_rng_key_seed(24);
    static char text[COUNT][8];
    names list = {0};
    drive car[COUNT];
    cp_vehicle_motion motion[COUNT];
    for (uint32_t k = 0; k < COUNT; k++) {
        snprintf(text[k], sizeof text[k], "%u", (unsigned)k);
        list.of[k] = text[k];
        car[k] = (drive){.x_m = 200.0 * cp_rng_uniform(key, 4 * k),
                         .y_m = 200.0 * cp_rng_uniform(key, 4 * k + 1),
                         .yaw_rad = 6.28 * cp_rng_uniform(key, 4 * k + 2),
                         .speed_m_s = 30.0 * cp_rng_uniform(key, 4 * k + 3)};
        motion[k] = drive_motion(&car[k], k, 0.1, 0.1);
    }
    cp_detector_scene scene = {.motions = motion,
                               .count = COUNT,
                               .step_length_s = 0.1,
                               .time_s = 0.1,
                               .vehicle_id = name_of,
                               .id_context = &list};
    cp_detector *all, *single;
    const cp_impact *impact;
    size_t together, one, expected = 0;
    assert_int_equal(cp_detector_create(&all, NULL), CP_OK);
    assert_int_equal(cp_detector_create(&single, NULL), CP_OK);
    assert_int_equal(cp_detector_scan(all, &scene, &impact, &together, NULL), CP_OK);
    for (uint32_t i = 0; i < COUNT; i++)
        for (uint32_t j = i + 1; j < COUNT; j++) {
            cp_vehicle_motion two[2] = {motion[i], motion[j]};
            cp_detector_scene pair = scene;
            pair.motions = two;
            pair.count = 2;
            assert_int_equal(cp_detector_scan(single, &pair, &impact, &one, NULL), CP_OK);
            expected += one;
        }
    assert_int_equal(together, expected);
    assert_true(together > 50);
    assert_int_equal(cp_detector_scan(all, &scene, &impact, &together, NULL), CP_OK);
    assert_int_equal(together, 0); // all told
    cp_detector_destroy(all);
    cp_detector_destroy(single);
}

/* A road that plays two oncoming cars, in place of SUMO. */
static int scripted_step;

static cp_status play(const cp_vehicle_state **states, size_t *count, cp_error *error)
{
    static cp_vehicle_state playing[2];
    (void)error;
    drive a = {.speed_m_s = 15.0};
    drive b = {.x_m = 31.0, .yaw_rad = CP_PI, .speed_m_s = 10.0};
    scripted_step++;
    playing[0] = drive_state(&a, 0, 0.1 * scripted_step);
    playing[1] = drive_state(&b, 1, 0.1 * scripted_step);
    *states = playing;
    *count = 2;
    return CP_OK;
}

static cp_status nobody_departs(const uint32_t **vehicles, size_t *count, cp_error *error)
{
    (void)error;
    *vehicles = NULL;
    *count = 0;
    return CP_OK;
}

static double scripted_time_s(void)
{
    return 0.1 * scripted_step;
}

static const char *scripted_name(uint32_t vehicle)
{
    return vehicle == 0 ? "z" : "b";
}

static void stop_playing(void)
{
}

static void traffic_is_watched_step_by_step(void **state)
{
    (void)state;
    cp_traffic_source source = {.step = play,
                                .departed = nobody_departs,
                                .time_s = scripted_time_s,
                                .vehicle_id = scripted_name,
                                .stop = stop_playing};
    cp_traffic *traffic;
    cp_detector *detector;
    assert_int_equal(cp_traffic_create_from(&source, 0.1, &traffic, NULL), CP_OK);
    assert_int_equal(cp_detector_create(&detector, NULL), CP_OK);
    size_t total = 0;
    for (int step = 0; step < 15; step++) {
        const cp_impact *impact;
        size_t count;
        assert_int_equal(cp_traffic_step(traffic, NULL), CP_OK);
        assert_int_equal(cp_detector_step(detector, traffic, NULL, NULL, &impact, &count, NULL),
                         CP_OK);
        total += count;
        if (count == 0)
            continue;
        assert_near(impact[0].time_s, 1.24, 1e-9);
        assert_int_equal(impact[0].vehicle[0], 1); // "b" before "z"
    }
    assert_int_equal(total, 1);
    cp_detector_destroy(detector);
    cp_detector_destroy(NULL);
    cp_traffic_destroy(traffic);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(oncoming_cars_at_any_step_length),
        cmocka_unit_test(the_car_whose_front_is_struck_is_a),
        cmocka_unit_test(between_two_fronts_fault_decides_and_then_the_id),
        cmocka_unit_test(a_well_braked_touch_is_a_confirmed_crash),
        cmocka_unit_test(a_touch_at_walking_pace_from_behind_is_a_graze),
        cmocka_unit_test(cars_set_down_on_each_other_did_not_crash),
        cmocka_unit_test(an_instant_lane_change_onto_another_car_did_not_crash),
        cmocka_unit_test(a_confirmed_pair_is_reported_once_for_ever),
        cmocka_unit_test(after_a_graze_a_pair_that_parted_can_crash),
        cmocka_unit_test(a_corner_of_a_waiting_car_is_clipped_unless_somebody_errs),
        cmocka_unit_test(what_turns_on_the_spot_is_struck_like_what_stands),
        cmocka_unit_test(what_drives_over_a_bridge_hits_nobody_below),
        cmocka_unit_test(a_trailing_part_counts_where_it_follows_the_front),
        cmocka_unit_test(neighbours_never_touch),
        cmocka_unit_test(what_swings_out_between_the_ends_of_a_step_counts),
        cmocka_unit_test(crashes_of_a_step_come_by_time_then_by_id),
        cmocka_unit_test(the_step_length_does_not_matter),
        cmocka_unit_test(a_mirrored_road_gives_mirrored_crashes),
        cmocka_unit_test(the_order_of_the_vehicles_does_not_matter),
        cmocka_unit_test(crowded_traffic_matches_all_pairs),
        cmocka_unit_test(traffic_is_watched_step_by_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
