/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "control/brake.h"
#include "control/scripted_road.h"
#include "core/units.h"

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
#define LENGTH_M 4.5
#define POINTS_MAX 400
#define LANE_WIDTH_M 3.2

/* Two lanes, one the other way beside it, by their corners. */
static struct bend {
    cp_lane_point point[2][POINTS_MAX];
    size_t count;
    cp_lane_map *map;
    double at_m[ROAD_CARS];   /* of fronts along lane 0; of cars on lane 1 along that */
    double sign_1[ROAD_CARS]; /* -1: against the lane */
    uint32_t lane[ROAD_CARS];
} bend;

// A straight piece, an arc of 100 degrees in pieces, a straight piece.
static void lay_bend(double radius_m, double piece_deg, double leg_m)
{
    memset(&bend, 0, sizeof bend);
    size_t pieces = (size_t)round(100.0 / piece_deg);
    for (int lane = 0; lane < 2; lane++) {
        double r_m = radius_m + (lane == 0 ? 0.5 : -0.5) * LANE_WIDTH_M, at_m = 0.0;
        cp_lane_point corners[POINTS_MAX];
        size_t count = 0;
        corners[count++] = (cp_lane_point){-leg_m, -r_m, 0.0, 0.0};
        for (size_t k = 0; k <= pieces; k++) {
            double turned_rad = cp_rad_from_deg(100.0) * (double)k / (double)pieces;
            corners[count++] =
                (cp_lane_point){r_m * sin(turned_rad), -r_m * cos(turned_rad), 0.0, 0.0};
        }
        double end_rad = cp_rad_from_deg(100.0);
        corners[count] = corners[count - 1];
        corners[count].x_m += leg_m * cos(end_rad);
        corners[count++].y_m += leg_m * sin(end_rad);
        for (size_t k = 0; k < count; k++) {
            cp_lane_point *point = &bend.point[lane][k];
            *point = corners[lane == 0 ? k : count - 1 - k];
            if (k > 0)
                at_m += hypot(point->x_m - point[-1].x_m, point->y_m - point[-1].y_m);
            point->at_m = at_m;
        }
        bend.count = count;
    }
    const cp_lane lanes[2] = {
        {.point = bend.point[0], .point_count = bend.count, .width_m = LANE_WIDTH_M, .edge = 0},
        {.point = bend.point[1], .point_count = bend.count, .width_m = LANE_WIDTH_M, .edge = 1}};
    cp_error error = {0};
    assert_int_equal(cp_lane_map_create(lanes, 2, &bend.map, &error), CP_OK);
}

static cp_vec2 place_on(uint32_t lane, double at_m)
{
    const cp_lane_point *point = bend.point[lane];
    size_t k = 0;
    while (k + 2 < bend.count && point[k + 1].at_m <= at_m)
        k++;
    double share_1 = (at_m - point[k].at_m) / (point[k + 1].at_m - point[k].at_m);
    return (cp_vec2){point[k].x_m + share_1 * (point[k + 1].x_m - point[k].x_m),
                     point[k].y_m + share_1 * (point[k + 1].y_m - point[k].y_m)};
}

static cp_rectangle body_at(uint32_t car, double at_m)
{
    cp_vec2 front_m = place_on(bend.lane[car], at_m);
    cp_vec2 rear_m = place_on(bend.lane[car], at_m - bend.sign_1[car] * LENGTH_M);
    double yaw_rad = atan2(front_m.y - rear_m.y, front_m.x - rear_m.x);
    cp_vec2 half_m = cp_vec2_scale(cp_vec2_heading(yaw_rad), 0.5 * LENGTH_M);
    return (cp_rectangle){cp_vec2_sub(front_m, half_m), yaw_rad, LENGTH_M, 1.8};
}

static void put(uint32_t car)
{
    cp_rectangle body = body_at(car, bend.at_m[car]);
    cp_vehicle_state *state = &road.cars[car].state;
    cp_vec2 front_m = place_on(bend.lane[car], bend.at_m[car]);
    state->front_x_m = front_m.x;
    state->front_y_m = front_m.y;
    state->yaw_rad = body.yaw_rad;
    state->lane = bend.lane[car];
    state->lane_position_m = bend.at_m[car];
}

static cp_status bend_step(const cp_vehicle_state **states, size_t *count, cp_error *error)
{
    // The scripted road keeps speeds and commands; the places are the lane's.
    double before_m_s[ROAD_CARS];
    uint32_t announced = road.announced;
    for (uint32_t k = 0; k < road.count; k++)
        before_m_s[k] = road.cars[k].state.speed_m_s;
    cp_status status = road_step(states, count, error);
    for (uint32_t k = 0; k < road.count; k++) {
        double way_m = 0.5 * (before_m_s[k] + road.cars[k].state.speed_m_s) * road.step_s;
        if (k < announced)
            bend.at_m[k] += bend.sign_1[k] * way_m;
        put(k);
        road.states[k] = road.cars[k].state;
    }
    return status;
}

static cp_status bend_lane_map(const cp_lane_map **map, cp_error *error)
{
    (void)error;
    *map = bend.map;
    return CP_OK;
}

static cp_status bend_next_lanes(uint32_t vehicle, uint32_t *lanes, size_t room, size_t *count,
                                 cp_error *error)
{
    (void)vehicle, (void)lanes, (void)room, (void)error;
    *count = 0;
    return CP_OK;
}

static cp_traffic *open_bend(double required_m_s2, double ttc_s, cp_controls **controls)
{
    static cp_traffic_source source;
    static const char *const names[] = {
        "ttc_s",     "required_deceleration_m_s2", "dead_time_s",    "sensor_latency_s",
        "jerk_m_s3", "deceleration_m_s2",          "sensor_range_m", NULL};
    const double values[] = {ttc_s,     required_m_s2,     DEAD_TIME_S, LATENCY_S,
                             JERK_M_S3, DECELERATION_M_S2, 150.0};
    cp_error error = {0};
    cp_traffic *traffic = NULL;
    memset(&road, 0, sizeof road);
    road.step_s = STEP_S;
    source = ROAD;
    source.step = bend_step;
    source.lane_map = bend_lane_map;
    source.next_lanes = bend_next_lanes;
    assert_int_equal(cp_traffic_create_from(&source, STEP_S, &traffic, &error), CP_OK);
    cp_control_settings settings = road_settings(CP_CONTROL_FUNCTION, "aeb", names, values);
    const char *const ids[2] = {"own", "own"};
    assert_int_equal(cp_controls_create(NULL, 0, 5, 1, traffic, controls, &error), CP_OK);
    assert_int_equal(cp_controls_add_treatment(*controls, &settings, 1, 5, 1, ids, &error), CP_OK);
    return traffic;
}

static void add_car(const char *id, uint32_t lane, double at_m, double sign_1, double speed_m_s)
{
    uint32_t car = road.count;
    road_add(id, 0.0, 0.0, 0.0, speed_m_s);
    bend.lane[car] = lane;
    bend.at_m[car] = at_m;
    bend.sign_1[car] = sign_1;
    put(car);
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
    cp_brake brake = {LATENCY_S + DEAD_TIME_S, JERK_M_S3, DECELERATION_M_S2};
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
