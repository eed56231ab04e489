/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_BEND_ROAD_H
#define CONTROL_BEND_ROAD_H

#include "control/scripted_road.h"
#include "core/units.h"

/* A scripted road that knows its lanes: two of them round a bend, cars on their centre lines, front
 * and rear both on them, as SUMO has them. Include after cmocka.h. */

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
    cp_road_relation relation; /* of any two of its cars */
} bend;

// A straight piece, an arc of 100 degrees in pieces, a straight piece.
static inline void lay_bend(double radius_m, double piece_deg, double leg_m)
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

static inline cp_vec2 place_on(uint32_t lane, double at_m)
{
    const cp_lane_point *point = bend.point[lane];
    size_t k = 0;
    while (k + 2 < bend.count && point[k + 1].at_m <= at_m)
        k++;
    double share_1 = (at_m - point[k].at_m) / (point[k + 1].at_m - point[k].at_m);
    return (cp_vec2){point[k].x_m + share_1 * (point[k + 1].x_m - point[k].x_m),
                     point[k].y_m + share_1 * (point[k + 1].y_m - point[k].y_m)};
}

static inline cp_rectangle body_at(uint32_t car, double at_m)
{
    cp_vec2 front_m = place_on(bend.lane[car], at_m);
    cp_vec2 rear_m = place_on(bend.lane[car], at_m - bend.sign_1[car] * LENGTH_M);
    double yaw_rad = atan2(front_m.y - rear_m.y, front_m.x - rear_m.x);
    cp_vec2 half_m = cp_vec2_scale(cp_vec2_heading(yaw_rad), 0.5 * LENGTH_M);
    return (cp_rectangle){cp_vec2_sub(front_m, half_m), yaw_rad, LENGTH_M, 1.8};
}

static inline void put(uint32_t car)
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

static inline cp_status bend_step(const cp_vehicle_state **states, size_t *count, cp_error *error)
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

static inline cp_status bend_lane_map(const cp_lane_map **map, cp_error *error)
{
    (void)error;
    *map = bend.map;
    return CP_OK;
}

static inline cp_status bend_next_lanes(uint32_t vehicle, uint32_t *lanes, size_t room,
                                        size_t *count, cp_error *error)
{
    (void)vehicle, (void)lanes, (void)room, (void)error;
    *count = 0;
    return CP_OK;
}

static inline cp_status bend_relation(const cp_vehicle_state *one, const cp_vehicle_state *other,
                                      cp_road_relation *relation, cp_error *error)
{
    (void)one, (void)other, (void)error;
    *relation = bend.relation;
    return CP_OK;
}

/* Traffic on the bend that lay_bend has laid; the caller destroys it, and bend.map after it. */
static inline cp_traffic *open_bend_road(double step_s)
{
    static cp_traffic_source source;
    cp_error error = {0};
    cp_traffic *traffic = NULL;
    memset(&road, 0, sizeof road);
    road.step_s = step_s;
    source = ROAD;
    source.step = bend_step;
    source.lane_map = bend_lane_map;
    source.next_lanes = bend_next_lanes;
    source.road_relation = bend_relation;
    assert_int_equal(cp_traffic_create_from(&source, step_s, &traffic, &error), CP_OK);
    return traffic;
}

static inline void add_car(const char *id, uint32_t lane, double at_m, double sign_1,
                           double speed_m_s)
{
    uint32_t car = road.count;
    road_add(id, 0.0, 0.0, 0.0, speed_m_s);
    bend.lane[car] = lane;
    bend.at_m[car] = at_m;
    bend.sign_1[car] = sign_1;
    put(car);
}

#endif
