/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_road.h"

#include <math.h>

#define CLOSE_M 1e-3

// The point of a lane's centre line at a place along it; straight on beyond its ends.
static cp_vec2 centre_at(const cp_lane *lane, double at_m)
{
    size_t k = 0;
    while (k + 2 < lane->point_count && lane->point[k + 1].at_m < at_m)
        k++;
    const cp_lane_point *from = &lane->point[k], *to = from + 1;
    double length_m = to->at_m - from->at_m;
    double share_1 = length_m > 0.0 ? (at_m - from->at_m) / length_m : 0.0;
    cp_vec2 one = {from->x_m, from->y_m}, other = {to->x_m, to->y_m};
    return cp_vec2_add(one, cp_vec2_scale(cp_vec2_sub(other, one), share_1));
}

// Of the circle through three points: four times their triangle over the product of its sides.
static double curvature_1_m(cp_vec2 one, cp_vec2 two, cp_vec2 three)
{
    cp_vec2 in = cp_vec2_sub(two, one), out = cp_vec2_sub(three, two);
    double sides =
        cp_vec2_length(in) * cp_vec2_length(out) * cp_vec2_length(cp_vec2_sub(three, one));
    return sides > 0.0 ? 2.0 * cp_vec2_cross(in, out) / sides : 0.0;
}

static cp_vec2 point_of(const crashpulse_road *road, size_t k)
{
    return (cp_vec2){road->point[k].ahead_m, road->point[k].left_m};
}

static void add(crashpulse_road *road, cp_pose frame, cp_vec2 point_m)
{
    cp_vec2 local_m = cp_pose_to_local(frame, point_m);
    double way_m = 0.0;
    if (road->count > 0) {
        double step_m = cp_vec2_length(cp_vec2_sub(local_m, point_of(road, road->count - 1)));
        if (step_m < CLOSE_M)
            return;
        way_m = road->point[road->count - 1].way_m + step_m;
    }
    size_t k = road->count++;
    road->point[k].ahead_m = local_m.x;
    road->point[k].left_m = local_m.y;
    road->point[k].way_m = way_m;
    road->point[k].curvature_1_m = 0.0;
}

// The corner of the lane's line behind a place on it, as it is driven; the place itself without
// one.
static cp_vec2 corner_behind(const cp_lane *lane, double at_m, double step_1)
{
    const cp_lane_point *found = NULL;
    for (size_t k = 0; k < lane->point_count; k++) {
        double behind_m = step_1 * (at_m - lane->point[k].at_m);
        if (behind_m > CLOSE_M && (found == NULL || behind_m < step_1 * (at_m - found->at_m)))
            found = &lane->point[k];
    }
    return found != NULL ? (cp_vec2){found->x_m, found->y_m} : centre_at(lane, at_m);
}

// At corners by the pieces on both sides, of which the first begins behind the car.
static void tell_curvature(crashpulse_road *road, cp_vec2 behind)
{
    for (size_t k = 1; k + 1 < road->count; k++)
        road->point[k].curvature_1_m = curvature_1_m(k > 1 ? point_of(road, k - 1) : behind,
                                                     point_of(road, k), point_of(road, k + 1));
    if (road->count > 2) {
        road->point[0].curvature_1_m = road->point[1].curvature_1_m;
        road->point[road->count - 1].curvature_1_m = road->point[road->count - 2].curvature_1_m;
    }
}

// How far left of the line the car's front, the origin, lies: its first piece goes on to both ends.
static double left_of_line_m(const crashpulse_road *road)
{
    cp_vec2 from = point_of(road, 0), along = cp_vec2_sub(point_of(road, 1), from);
    return cp_vec2_cross(along, cp_vec2_scale(from, -1.0)) / cp_vec2_length(along);
}

cp_status cp_function_road(const cp_traffic *traffic, cp_road_view *view,
                           const cp_vehicle_motion *own, crashpulse_road *road, bool *is_known,
                           cp_error *error)
{
    const cp_lane_ahead *way = NULL;
    const cp_lane_map *map = NULL;
    *road = (crashpulse_road){.speed_limit_m_s = INFINITY};
    *is_known = false;
    cp_status status = cp_road_view_way(view, own, CP_WAY_ROUTE, &way, error);
    if (status == CP_OK && way != NULL)
        status = cp_traffic_lane_map(traffic, &map, error);
    const cp_lane *lane = map != NULL ? cp_lane_map_lane(map, own->after.lane) : NULL;
    if (status != CP_OK || lane == NULL)
        return status;
    cp_pose frame = {{own->after.front_x_m, own->after.front_y_m}, own->after.yaw_rad};
    for (size_t k = way->front; k < way->count && road->count < CRASHPULSE_ROAD_POINTS; k++) {
        const cp_lane *of = cp_lane_map_lane(map, way->corner[k].lane);
        if (of != NULL && of->point_count > 1)
            add(road, frame, centre_at(of, way->corner[k].lane_at_m));
    }
    if (road->count < 2)
        return CP_OK;
    const cp_way_point *front = &way->corner[way->front];
    const cp_lane *first = cp_lane_map_lane(map, front->lane);
    bool is_laid = first != NULL && first->point_count > 1;
    cp_vec2 behind = point_of(road, 0);
    if (is_laid)
        behind = cp_pose_to_local(frame, corner_behind(first, front->lane_at_m, way->lane_step_1));
    tell_curvature(road, behind);
    road->lane_left_m = left_of_line_m(road);
    road->lane_width_m = lane->width_m;
    if (lane->speed_limit_m_s > 0.0)
        road->speed_limit_m_s = lane->speed_limit_m_s;
    *is_known = true;
    return CP_OK;
}
