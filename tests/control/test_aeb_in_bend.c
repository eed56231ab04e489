/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "control/bend_road.h"
#include "control/brake.h"

/* A true threat in a bend is met as on a straight road. Cars drive on the centre line of one lane
 * that bends, front and rear both on it, as SUMO has them: a standing one ahead, or one that comes
 * against it. The own car has AEB; its speed at the contact is the closed form's for a straight
 * road, within 0.3 m/s, in wide and tight bends of fine and coarse pieces. A car on the lane beside
 * it is met by nobody. */

#define STEP_S 0.05
#define DEAD_TIME_S 0.1
#define LATENCY_S 0.1
#define JERK_M_S3 40.0
#define DECELERATION_M_S2 8.0
#define REQUIRED_M_S2 4.5
#define TOLERANCE_M_S 0.3
static cp_traffic *open_bend(double required_m_s2, double ttc_s, cp_controls **controls)
{
    static const char *const names[] = {
        "ttc_s",     "required_deceleration_m_s2", "dead_time_s",    "sensor_latency_s",
        "jerk_m_s3", "deceleration_m_s2",          "sensor_range_m", NULL};
    const double values[] = {ttc_s,     required_m_s2,     DEAD_TIME_S, LATENCY_S,
                             JERK_M_S3, DECELERATION_M_S2, 150.0};
    cp_error error = {0};
    cp_traffic *traffic = open_bend_road(STEP_S);
    cp_control_settings settings = road_settings(CP_CONTROL_FUNCTION, "aeb", names, values);
    const char *const ids[2] = {"own", "own"};
    assert_int_equal(cp_controls_create(NULL, 0, 5, 1, traffic, controls, &error), CP_OK);
    assert_int_equal(cp_controls_add_treatment(*controls, &settings, 1, 5, 1, ids, &error), CP_OK);
    return traffic;
}

// Own speed at the first touch; 0 when the own car comes to rest before, NAN when nothing happens.
static double drive_to_contact_m_s(cp_traffic *traffic, cp_controls *controls)
{
    cp_error error = {0};
    while (road.time_s < 20.0) {
        double from_m[2] = {bend.at_m[0], bend.at_m[1]}, from_m_s = road.cars[0].state.speed_m_s;
        assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
        double to_m_s = road.cars[0].state.speed_m_s;
        for (int k = 0; k <= 100; k++) {
            double time_s = STEP_S * k / 100.0;
            double way_m = time_s * (from_m_s + 0.5 * (to_m_s - from_m_s) * time_s / STEP_S);
            double other_m = bend.sign_1[1] * road.cars[1].state.speed_m_s * time_s;
            cp_rectangle own = body_at(0, from_m[0] + way_m),
                         other = body_at(1, from_m[1] + other_m);
            if (cp_rectangle_separation(&own, &other) <= 0.0)
                return from_m_s + (to_m_s - from_m_s) * k / 100.0;
        }
        if (to_m_s < 0.01)
            return 0.0;
        assert_int_equal(cp_controls_step(controls, &error), CP_OK);
    }
    return NAN;
}

// The closed form on a straight road: the request at the threshold, constant jerk, constant
// deceleration, the other at its speed.
static double straight_m_s(double own_m_s, double other_m_s, double ttc_s)
{
    double request_s = fmin(ttc_s, own_m_s / (2.0 * REQUIRED_M_S2));
    double gap_m = request_s * (own_m_s + other_m_s), fine_s = 1e-4;
    cp_brake brake = {LATENCY_S + DEAD_TIME_S, JERK_M_S3, DECELERATION_M_S2, 0.0};
    for (double time_s = 0.0;; time_s += fine_s) {
        double speed_m_s = own_m_s - cp_brake_speed_loss_m_s(&brake, time_s);
        if (speed_m_s <= 0.0)
            return 0.0;
        if (gap_m <= 0.0)
            return speed_m_s;
        gap_m -= fine_s * (speed_m_s + other_m_s);
    }
}

static const struct {
    double radius_m, piece_deg;
} BENDS[] = {{30, 1},  {30, 5},  {30, 15},  {100, 1},  {100, 5},  {100, 15},
             {300, 1}, {300, 5}, {300, 15}, {1000, 1}, {1000, 5}, {1000, 15}};

static double speed_in(double radius_m)
{
    return fmin(sqrt(3.0 * radius_m), 33.0);
}

// A car ahead at that speed against the lane (0: it stands), met within the arc.
static void assert_met_as_on_a_straight(double other_share_1)
{
    for (size_t k = 0; k < sizeof BENDS / sizeof *BENDS; k++) {
        double own_m_s = speed_in(BENDS[k].radius_m), other_m_s = other_share_1 * own_m_s;
        for (double ttc_s = 0.6; ttc_s < 1.5; ttc_s += 0.2) {
            cp_controls *controls;
            double leg_m = 10.0 * own_m_s, middle_m = leg_m + 0.8 * BENDS[k].radius_m;
            lay_bend(BENDS[k].radius_m, BENDS[k].piece_deg, leg_m);
            cp_traffic *traffic = open_bend(REQUIRED_M_S2, ttc_s, &controls);
            add_car("own", 0, middle_m - 4.0 * own_m_s, 1.0, own_m_s);
            // It stands turned the way it came, or comes from ahead.
            add_car("other", 0, middle_m + 4.0 * other_m_s + (other_m_s > 0.0 ? 0.0 : LENGTH_M),
                    other_m_s > 0.0 ? -1.0 : 1.0, other_m_s);
            double found_m_s = drive_to_contact_m_s(traffic, controls);
            double expected_m_s = straight_m_s(own_m_s, other_m_s, ttc_s);
            if (!(fabs(found_m_s - expected_m_s) <= TOLERANCE_M_S))
                fail_msg("R %g m, pieces of %g deg, TTC %.1f s: %.3f m/s, on a straight %.3f",
                         BENDS[k].radius_m, BENDS[k].piece_deg, ttc_s, found_m_s, expected_m_s);
            cp_controls_destroy(controls);
            cp_traffic_destroy(traffic);
            cp_lane_map_destroy(bend.map);
        }
    }
}

static void a_standing_car_is_met_as_on_a_straight(void **unused)
{
    (void)unused;
    assert_met_as_on_a_straight(0.0);
}

static void an_oncoming_car_in_the_own_lane_is_met_as_on_a_straight(void **unused)
{
    (void)unused;
    assert_met_as_on_a_straight(0.6);
}

static void who_keeps_to_the_other_lane_is_met_by_nobody(void **unused)
{
    (void)unused;
    for (size_t k = 0; k < sizeof BENDS / sizeof *BENDS; k++) {
        cp_controls *controls;
        double speed_m_s = speed_in(BENDS[k].radius_m), leg_m = 10.0 * speed_m_s;
        lay_bend(BENDS[k].radius_m, BENDS[k].piece_deg, leg_m);
        cp_traffic *traffic = open_bend(0.0, 3.0, &controls);
        cp_error error = {0};
        add_car("own", 0, leg_m, 1.0, speed_m_s);
        add_car("other", 1, leg_m, 1.0, speed_m_s);
        while (road.time_s < 2.5 * BENDS[k].radius_m / speed_m_s) {
            assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
            assert_int_equal(cp_controls_step(controls, &error), CP_OK);
        }
        if (road.commands > 0)
            fail_msg("R %g m, pieces of %g deg: braked", BENDS[k].radius_m, BENDS[k].piece_deg);
        cp_controls_destroy(controls);
        cp_traffic_destroy(traffic);
        cp_lane_map_destroy(bend.map);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_standing_car_is_met_as_on_a_straight),
        cmocka_unit_test(an_oncoming_car_in_the_own_lane_is_met_as_on_a_straight),
        cmocka_unit_test(who_keeps_to_the_other_lane_is_met_by_nobody),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
