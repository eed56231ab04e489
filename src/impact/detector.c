/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/detector.h"

#include "core/array.h"
#include "impact/approach.h"
#include "impact/broad_phase.h"
#include "impact/confirmation.h"
#include "impact/footprint.h"
#include "impact/pair_set.h"
#include "impact/step_box.h"

#include <stdlib.h>
#include <string.h>

// Two that touched have parted when there is this much between them.
#define PARTED_M 0.1

// A longer vehicle turns in a way of its own: SUMO lays a rigid rectangle from front to rear along
// the lane, so that behind this much of its front it is not where a bus or a trailer would be.
#define LONG_M 9.0
#define FRONT_PART_M 6.0

// A lane bends under a vehicle when it leaves the rectangle's axis by this much.
#define BENT_M 0.15

// Slower is standing.
#define STANDING_M_S 0.1

struct cp_detector {
    cp_pair_set crashed;      /* confirmed: never reported again */
    cp_pair_set touching;     /* in contact at the end of the last step */
    cp_pair_set touching_now; /* the same of the step being looked at */
    cp_broad_phase broad_phase;
    cp_box *box; /* one a vehicle: where its rectangle is during the step */
    size_t box_capacity;
    cp_kept_heading *heading; /* by place among the motions, of the last step */
    size_t heading_count;
    size_t heading_capacity;
    cp_impact *impact; /* of this step */
    size_t impact_capacity;
    size_t impact_count;
};

cp_status cp_detector_create(cp_detector **detector, cp_error *error)
{
    *detector = calloc(1, sizeof **detector);
    return *detector != NULL ? CP_OK : cp_fail_memory(error, "contact detector");
}

void cp_detector_destroy(cp_detector *detector)
{
    if (detector == NULL)
        return;
    cp_pair_set_destroy(&detector->crashed);
    cp_pair_set_destroy(&detector->touching);
    cp_pair_set_destroy(&detector->touching_now);
    cp_broad_phase_destroy(&detector->broad_phase);
    free(detector->box);
    free(detector->heading);
    free(detector->impact);
    free(detector);
}

// Separation at the end of the step.
static double separation_after(const cp_vehicle_motion *const motion[2])
{
    cp_rectangle one = cp_vehicle_rectangle(&motion[0]->after);
    cp_rectangle other = cp_vehicle_rectangle(&motion[1]->after);
    return cp_rectangle_separation(&one, &other);
}

// Moment of the first touch as a fraction of the step; a vehicle that jumped is only where it is
// at the end. False when the two do not touch.
static bool find_touch(const cp_vehicle_motion *const motion[2], double step_length_s,
                       double *fraction)
{
    bool after_jump =
        cp_motion_is_jump(motion[0], step_length_s) || cp_motion_is_jump(motion[1], step_length_s);
    if (!after_jump)
        return cp_first_contact(motion[0], motion[1], step_length_s, fraction);
    *fraction = 1.0;
    return separation_after(motion) <= 0.0;
}

static const char *id_of(const cp_detector_scene *scene, uint32_t vehicle)
{
    return scene->vehicle_id(scene->id_context, vehicle);
}

// Which of two vehicles, the smaller id first, is a: the one whose front is struck; else the one
// at fault; else the first.
static int role_a(const cp_detector_scene *scene, const cp_vehicle_motion *const motion[2],
                  const cp_contact_side side[2])
{
    bool front[2] = {side[0] == CP_SIDE_FRONT, side[1] == CP_SIDE_FRONT};
    if (front[0] != front[1])
        return front[1];
    if (scene->is_at_fault == NULL)
        return 0;
    bool at_fault[2];
    for (int k = 0; k < 2; k++)
        at_fault[k] = scene->is_at_fault(scene->fault_context, motion[k]->after.vehicle);
    return at_fault[1] && !at_fault[0];
}

// Whether the touched point lies on the part of a long vehicle that bends away from its rectangle:
// behind its front part, while it is turning or its rear has not left a junction.
static bool is_on_bent_part(const cp_vehicle_state *state, double yaw_rate_rad_s, cp_vec2 point_m)
{
    if (state->length_m <= LONG_M)
        return false;
    cp_pose front = {{state->front_x_m, state->front_y_m}, state->yaw_rad};
    bool is_behind = cp_pose_to_local(front, point_m).x < -FRONT_PART_M;
    bool is_bent = fabs(yaw_rate_rad_s) > 0.01 || state->lane_position_m < state->length_m;
    return is_behind && is_bent;
}

// The same of one whose lane bends under it, moving or standing: buses, trailers and trams follow
// the road. Where the point is farther from the middle of the lane than their half width, or behind
// the front part, it is touched by the rectangle only.
static cp_status is_off_bent_lane(const cp_detector_scene *scene, const cp_vehicle_state *state,
                                  cp_vec2 point_m, bool *is_off, cp_error *error)
{
    const cp_lane_map *map = NULL;
    *is_off = false;
    cp_status status = CP_OK;
    if (state->length_m > LONG_M && scene->lane_map != NULL)
        status = scene->lane_map(scene->road_context, &map, error);
    const cp_lane *lane = map != NULL ? cp_lane_map_lane(map, state->lane) : NULL;
    if (lane == NULL)
        return status;
    cp_pose front = {{state->front_x_m, state->front_y_m}, state->yaw_rad};
    double rear_at_m = state->lane_position_m - state->length_m;
    double bend_m = 0.0, nearest_m = INFINITY;
    for (size_t k = 0; k < lane->point_count; k++) {
        const cp_lane_point *corner = &lane->point[k];
        cp_vec2 corner_m = {corner->x_m, corner->y_m};
        bool is_under = corner->at_m > rear_at_m && corner->at_m < state->lane_position_m;
        if (is_under)
            bend_m = fmax(bend_m, fabs(cp_pose_to_local(front, corner_m).y));
        if (k == 0)
            continue;
        cp_vec2 from_m = {corner[-1].x_m, corner[-1].y_m};
        cp_vec2 piece_m = cp_vec2_sub(corner_m, from_m), off_m = cp_vec2_sub(point_m, from_m);
        double share_1 = cp_vec2_dot(off_m, piece_m) / cp_vec2_dot(piece_m, piece_m);
        cp_vec2 foot_m = cp_vec2_scale(piece_m, fmin(fmax(share_1, 0.0), 1.0));
        nearest_m = fmin(nearest_m, cp_vec2_length(cp_vec2_sub(off_m, foot_m)));
    }
    bool is_behind = cp_pose_to_local(front, point_m).x < -FRONT_PART_M;
    *is_off = bend_m > BENT_M && (is_behind || nearest_m > 0.5 * state->width_m + BENT_M);
    return status;
}

static cp_touching_body body_of(const cp_impact *impact, int role)
{
    return (cp_touching_body){.rectangle = cp_vehicle_rectangle(&impact->state[role]),
                              .front_velocity_m_s = impact->front_velocity_m_s[role],
                              .yaw_rate_rad_s = impact->yaw_rate_rad_s[role]};
}

// A corner of a car that stands in wait lies in the other's way, and nobody errs.
static bool is_clipped_waiting(const cp_detector_scene *scene, const cp_impact *impact)
{
    int waiting = fabs(impact->state[0].speed_m_s) < STANDING_M_S ? 0 : 1;
    if (!(fabs(impact->state[waiting].speed_m_s) < STANDING_M_S))
        return false;
    cp_rectangle moving = cp_vehicle_rectangle(&impact->state[1 - waiting]);
    cp_rectangle standing = cp_vehicle_rectangle(&impact->state[waiting]);
    if (cp_width_in_way_m(&moving, &standing) >= 0.5 * fmin(moving.width_m, standing.width_m))
        return false;
    for (int role = 0; role < 2; role++)
        if (scene->is_at_fault != NULL &&
            scene->is_at_fault(scene->fault_context, impact->vehicle[role]))
            return false;
    return true;
}

// Leave out what no vehicle can do; false when it would be no crash then.
static bool is_crash_without_impossible(cp_impact *impact)
{
    cp_touching_body body[2] = {body_of(impact, 0), body_of(impact, 1)};
    bool is_any = false;
    for (int role = 0; role < 2; role++) {
        if (!cp_motion_is_impossible(&body[role]))
            continue;
        body[role] = cp_touching_body_possible(&body[role]);
        is_any = true;
    }
    cp_touch touch = {impact->contact_m, {impact->side[0], impact->side[1]}};
    if (is_any && !cp_contact_is_crash(body, &touch))
        return false;
    for (int role = 0; role < 2; role++) {
        impact->front_velocity_m_s[role] = body[role].front_velocity_m_s;
        impact->yaw_rate_rad_s[role] = body[role].yaw_rate_rad_s;
    }
    return true;
}

// What of SUMO's ways makes a crash of two rectangles an artefact; CONFIRMED when nothing does.
static cp_contact_verdict filter_motion(const cp_detector_scene *scene,
                                        const cp_vehicle_motion *const motion[2], cp_impact *impact)
{
    if (!motion[0]->was_present || !motion[1]->was_present)
        return CP_CONTACT_AT_INSERTION;
    if (cp_motion_is_jump(motion[0], scene->step_length_s) ||
        cp_motion_is_jump(motion[1], scene->step_length_s))
        return CP_CONTACT_LANE_CHANGE_JUMP;
    if (impact->verdict == CP_CONTACT_GRAZE)
        return CP_CONTACT_GRAZE;
    if (!is_crash_without_impossible(impact))
        return CP_CONTACT_IMPOSSIBLE_MOTION;
    for (int role = 0; role < 2; role++)
        if (is_on_bent_part(&impact->state[role], impact->yaw_rate_rad_s[role], impact->contact_m))
            return CP_CONTACT_LONG_TURNING;
    return is_clipped_waiting(scene, impact) ? CP_CONTACT_CLIPPED_WAITING : CP_CONTACT_CONFIRMED;
}

// How their roads lie where they touched: at the end of a long step they may have passed each other
// by far. What each drove between is taken off its place; of one that drives against its lane, as
// overtakers do, added to it.
static cp_status relate_at_contact(const cp_detector_scene *scene, const cp_vehicle_state end[2],
                                   const double way_m[2], cp_road_relation *relation,
                                   cp_error *error)
{
    cp_status status = CP_OK;
    *relation = CP_ROADS_APART;
    for (int k = 0; status == CP_OK && *relation == CP_ROADS_APART && k < 4; k++) {
        cp_vehicle_state at[2] = {end[0], end[1]};
        at[0].lane_position_m += k & 1 ? way_m[0] : -way_m[0];
        at[1].lane_position_m += k & 2 ? way_m[1] : -way_m[1];
        status = scene->road_relation(scene->road_context, &at[0], &at[1], relation, error);
    }
    return status;
}

// Verdict on an impact that is a crash or a graze by the motion of its rectangles alone.
static cp_status judge(const cp_detector_scene *scene, const cp_vehicle_motion *const motion[2],
                       cp_impact *impact, cp_error *error)
{
    cp_road_relation relation = CP_ROADS_MEET;
    cp_status status = CP_OK;

    // Where on the road they are at the end of the step, and how much of it they drove after.
    cp_vehicle_state ends[2];
    double way_m[2];
    for (int role = 0; status == CP_OK && role < 2; role++) {
        const cp_vehicle_motion *own = motion[motion[0]->after.vehicle != impact->vehicle[role]];
        cp_vehicle_state end = own->after;
        if (scene->place != NULL)
            status = scene->place(scene->road_context, &end, error);
        impact->state[role].lane = end.lane;
        impact->state[role].lane_position_m = end.lane_position_m;
        impact->state[role].is_in_junction = end.is_in_junction;
        ends[role] = impact->state[role];
        way_m[role] = hypot(end.front_x_m - impact->state[role].front_x_m,
                            end.front_y_m - impact->state[role].front_y_m);
    }
    if (status == CP_OK && scene->road_relation != NULL)
        status = relate_at_contact(scene, ends, way_m, &relation, error);
    if (relation == CP_ROADS_APART)
        impact->verdict = CP_CONTACT_ROADS_APART;
    else if (relation == CP_ROADS_OTHER_LEVEL)
        impact->verdict = CP_CONTACT_OTHER_LEVEL;
    else
        impact->verdict = filter_motion(scene, motion, impact);
    for (int role = 0; status == CP_OK && role < 2; role++) {
        bool is_off = false;
        if (impact->verdict == CP_CONTACT_CONFIRMED)
            status = is_off_bent_lane(scene, &ends[role], impact->contact_m, &is_off, error);
        if (is_off)
            impact->verdict = CP_CONTACT_LONG_TURNING;
    }
    return status;
}

// All there is to say about a touch at that fraction of the step.
static cp_impact impact_of(const cp_detector_scene *scene, const cp_vehicle_motion *const motion[2],
                           double fraction)
{
    // Bodies at first touch, the smaller id first, so that nothing depends on SUMO's order.
    cp_vehicle_state state[2];
    cp_touching_body body[2];
    for (int k = 0; k < 2; k++) {
        bool jumped = cp_motion_is_jump(motion[k], scene->step_length_s);
        state[k] = cp_motion_at(motion[k], scene->step_length_s, fraction);
        body[k] = (cp_touching_body){.rectangle = cp_vehicle_rectangle(&state[k]),
                                     .front_velocity_m_s = cp_motion_front_velocity(
                                         motion[k], scene->step_length_s, fraction),
                                     .yaw_rate_rad_s = jumped ? 0.0 : motion[k]->yaw_rate_rad_s};
    }
    cp_touch touch = cp_touch_of(body);

    // Into roles.
    int a = role_a(scene, motion, touch.side);
    cp_touching_body by_role[2] = {body[a], body[1 - a]};
    cp_touch touch_by_role = {touch.point_m, {touch.side[a], touch.side[1 - a]}};
    cp_impact impact = {.time_s = scene->time_s - (1.0 - fraction) * scene->step_length_s,
                        .contact_m = touch.point_m,
                        .verdict = cp_contact_is_crash(by_role, &touch_by_role)
                                       ? CP_CONTACT_CONFIRMED
                                       : CP_CONTACT_GRAZE};
    for (int role = 0; role < 2; role++) {
        int k = role == 0 ? a : 1 - a;
        impact.vehicle[role] = state[k].vehicle;
        impact.state[role] = state[k];
        impact.yaw_rate_rad_s[role] = body[k].yaw_rate_rad_s;
        impact.front_velocity_m_s[role] = body[k].front_velocity_m_s;
        impact.side[role] = touch.side[k];
    }
    return impact;
}

// Whether one impact comes before another: by time, then by the ids of a and b.
static bool is_before(const cp_detector_scene *scene, const cp_impact *one, const cp_impact *other)
{
    if (one->time_s != other->time_s)
        return one->time_s < other->time_s;
    int order = strcmp(id_of(scene, one->vehicle[0]), id_of(scene, other->vehicle[0]));
    if (order == 0)
        order = strcmp(id_of(scene, one->vehicle[1]), id_of(scene, other->vehicle[1]));
    return order < 0;
}

static cp_status report(cp_detector *detector, const cp_detector_scene *scene,
                        const cp_impact *impact, cp_error *error)
{
    cp_status status = cp_array_reserve(detector->impact, detector->impact_capacity,
                                        detector->impact_count + 1, "impacts of a step", error);
    if (status == CP_OK && impact->verdict == CP_CONTACT_CONFIRMED)
        status = cp_pair_set_add(&detector->crashed, impact->vehicle[0], impact->vehicle[1], error);
    if (status != CP_OK)
        return status;

    // In order: there are few in a step.
    size_t place = detector->impact_count++;
    for (; place > 0 && is_before(scene, impact, &detector->impact[place - 1]); place--)
        detector->impact[place] = detector->impact[place - 1];
    detector->impact[place] = *impact;
    return CP_OK;
}

static cp_status examine(cp_detector *detector, const cp_detector_scene *scene, cp_box_pair pair,
                         cp_error *error)
{
    const cp_vehicle_motion *motion[2] = {&scene->motions[pair.first],
                                          &scene->motions[pair.second]};
    uint32_t one = motion[0]->after.vehicle, other = motion[1]->after.vehicle;
    if (one == other || cp_pair_set_contains(&detector->crashed, one, other))
        return CP_OK;

    // A contact that goes on is the same contact.
    if (cp_pair_set_contains(&detector->touching, one, other))
        return separation_after(motion) <= PARTED_M
                   ? cp_pair_set_add(&detector->touching_now, one, other, error)
                   : CP_OK;
    double fraction;
    if (!find_touch(motion, scene->step_length_s, &fraction))
        return CP_OK;

    // A new one.
    if (strcmp(id_of(scene, one), id_of(scene, other)) > 0) {
        const cp_vehicle_motion *swap = motion[0];
        motion[0] = motion[1];
        motion[1] = swap;
    }
    cp_impact impact = impact_of(scene, motion, fraction);
    cp_status status = judge(scene, motion, &impact, error);
    if (status == CP_OK)
        status = cp_pair_set_add(&detector->touching_now, one, other, error);
    return status == CP_OK ? report(detector, scene, &impact, error) : status;
}

// Boxes of all vehicles, half of what parts two that touched wider on every side.
static cp_status enclose_vehicles(cp_detector *detector, const cp_detector_scene *scene,
                                  cp_error *error)
{
    const char *what = "boxes of vehicles";
    cp_status status =
        cp_array_reserve(detector->box, detector->box_capacity, scene->count, what, error);
    if (status == CP_OK)
        status = cp_array_reserve(detector->heading, detector->heading_capacity, scene->count, what,
                                  error);
    if (status != CP_OK)
        return status;
    for (; detector->heading_count < scene->count; detector->heading_count++)
        detector->heading[detector->heading_count] = (cp_kept_heading){.unit = {1.0, 0.0}};
    for (size_t k = 0; k < scene->count; k++)
        detector->box[k] = cp_step_box(&scene->motions[k], scene->step_length_s, 0.5 * PARTED_M,
                                       &detector->heading[k]);
    return CP_OK;
}

cp_status cp_detector_scan(cp_detector *detector, const cp_detector_scene *scene,
                           const cp_impact **impacts, size_t *count, cp_error *error)
{
    *impacts = NULL;
    *count = 0;
    detector->impact_count = 0;
    cp_status status = enclose_vehicles(detector, scene, error);
    if (status != CP_OK)
        return status;

    // Near pairs first, then each of them closely.
    const cp_box_pair *pair;
    size_t pair_count;
    status = cp_broad_phase_pairs(&detector->broad_phase, detector->box, scene->count, &pair,
                                  &pair_count, error);
    for (size_t k = 0; k < pair_count && status == CP_OK; k++)
        status = examine(detector, scene, pair[k], error);
    if (status != CP_OK)
        return status;
    cp_pair_set last = detector->touching;
    detector->touching = detector->touching_now;
    detector->touching_now = last;
    cp_pair_set_clear(&detector->touching_now);
    *impacts = detector->impact;
    *count = detector->impact_count;
    return CP_OK;
}

static const char *id_in_traffic(const void *context, uint32_t vehicle)
{
    return cp_traffic_vehicle_id(context, vehicle);
}

static cp_status relation_in_traffic(const void *context, const cp_vehicle_state *one,
                                     const cp_vehicle_state *other, cp_road_relation *relation,
                                     cp_error *error)
{
    return cp_traffic_road_relation(context, one, other, relation, error);
}

static cp_status lanes_in_traffic(const void *context, const cp_lane_map **map, cp_error *error)
{
    return cp_traffic_lane_map(context, map, error);
}

static cp_status place_in_traffic(const void *context, cp_vehicle_state *state, cp_error *error)
{
    return cp_traffic_place(context, state, error);
}

cp_status cp_detector_step(cp_detector *detector, const cp_traffic *traffic,
                           bool (*is_at_fault)(void *context, uint32_t vehicle), void *context,
                           const cp_impact **impacts, size_t *count, cp_error *error)
{
    cp_detector_scene scene = {.step_length_s = cp_traffic_step_length_s(traffic),
                               .time_s = cp_traffic_time_s(traffic),
                               .vehicle_id = id_in_traffic,
                               .id_context = traffic,
                               .is_at_fault = is_at_fault,
                               .fault_context = context,
                               .place = place_in_traffic,
                               .road_relation = relation_in_traffic,
                               .lane_map = lanes_in_traffic,
                               .road_context = traffic};
    scene.motions = cp_traffic_motions(traffic, &scene.count);
    return cp_detector_scan(detector, &scene, impacts, count, error);
}
