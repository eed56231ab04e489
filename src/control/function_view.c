/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_view.h"

#include "control/function_road.h"

#include <math.h>
#include <stdlib.h>

#define NOT_YET (-1.0)

// ---- looking -------------------------------------------------------------------------------

static crashpulse_object object_of(const cp_vehicle_motion *own, const cp_vehicle_motion *other,
                                   double in_view_s)
{
    cp_vec2 axis = cp_vec2_heading(own->after.yaw_rad);
    cp_vec2 there_m = {other->after.front_x_m - own->after.front_x_m,
                       other->after.front_y_m - own->after.front_y_m};
    return (crashpulse_object){
        .id = other->after.vehicle,
        .ahead_m = cp_vec2_dot(there_m, axis),
        .left_m = cp_vec2_cross(axis, there_m),
        .heading_rad = cp_wrap_angle(other->after.yaw_rad - own->after.yaw_rad),
        .speed_m_s = other->after.speed_m_s,
        .acceleration_m_s2 = other->after.acceleration_m_s2,
        .yaw_rate_rad_s = cp_turns_too_fast(other) ? 0.0 : other->yaw_rate_rad_s,
        .length_m = other->after.length_m,
        .width_m = other->after.width_m,
        .in_view_s = in_view_s,
    };
}

// Those of the targets in view that are known.
static size_t tell_objects(cp_function_senses *senses)
{
    const cp_vehicle_motion *own = senses->own;
    const cp_tracks tracks = cp_lookout_tracks_of(&senses->lookout, own->after.vehicle);
    double now_s = cp_traffic_time_s(senses->traffic);
    size_t count = 0;
    if (tracks.count > senses->object_room) {
        crashpulse_object *more =
            realloc(senses->objects, 2 * tracks.count * sizeof *senses->objects);
        if (more == NULL) {
            senses->status = cp_fail_memory(&senses->error, "objects");
            return 0;
        }
        senses->objects = more;
        senses->object_room = 2 * tracks.count;
    }
    for (size_t k = 0; k < tracks.count; k++) {
        const cp_track *track = &tracks.track[k];
        const cp_vehicle_motion *other = cp_traffic_motion_of(senses->traffic, track->vehicle);
        if (other != NULL && cp_lookout_is_known(&senses->lookout, track))
            senses->objects[count++] = object_of(own, other, now_s - track->seen_since_s);
    }
    return count;
}

static size_t look(const crashpulse_view *view, const crashpulse_object **objects)
{
    cp_function_senses *senses = view->handle;
    double now_s = cp_traffic_time_s(senses->traffic);
    if (senses->status == CP_OK && senses->stepped_s != now_s) {
        senses->status = cp_lookout_step(&senses->lookout, &senses->error);
        senses->stepped_s = now_s;
    }
    if (senses->status == CP_OK && !senses->has_looked)
        senses->status = cp_lookout_track(&senses->lookout, senses->own, &senses->error);
    senses->has_looked = senses->status == CP_OK;
    size_t count = senses->has_looked && objects != NULL ? tell_objects(senses) : 0;
    if (objects != NULL)
        *objects = senses->objects;
    return count;
}

// ---- threats and danger --------------------------------------------------------------------

static bool threat(const crashpulse_view *view, crashpulse_threat *told)
{
    cp_function_senses *senses = view->handle;
    bool found = false;
    if (!senses->has_looked || senses->status != CP_OK)
        return false;
    senses->status =
        cp_lookout_threat(&senses->lookout, senses->own, &found, &senses->threat, &senses->error);
    senses->has_threat = found && senses->status == CP_OK;
    if (!senses->has_threat)
        return false;
    *told = (crashpulse_threat){.id = senses->threat.vehicle,
                                .class_of = (crashpulse_class)senses->threat.class,
                                .ttc_s = senses->threat.ttc_s,
                                .instant_s = senses->threat.instant_s};
    return true;
}

static bool is_danger(const crashpulse_view *view, double horizon_s)
{
    cp_function_senses *senses = view->handle;
    bool found = false;
    if (!senses->has_looked || senses->status != CP_OK || !(horizon_s >= 0.0))
        return false;
    senses->status =
        cp_lookout_is_danger(&senses->lookout, senses->own, horizon_s, &found, &senses->error);
    return found && senses->status == CP_OK;
}

static bool road(const crashpulse_view *view, crashpulse_road *told)
{
    cp_function_senses *senses = view->handle;
    bool is_known = false;
    if (senses->status == CP_OK)
        senses->status = cp_function_road(senses->traffic, senses->view, senses->own, told,
                                          &is_known, &senses->error);
    return is_known && senses->status == CP_OK;
}

static double lane_width_m(const crashpulse_view *view)
{
    cp_function_senses *senses = view->handle;
    double width_m = 3.2;
    if (senses->status == CP_OK)
        senses->status =
            cp_traffic_lane_width(senses->traffic, &senses->own->after, &width_m, &senses->error);
    return width_m;
}

static const crashpulse_host HOST = {look, threat, is_danger, road, lane_width_m};

// ---- public --------------------------------------------------------------------------------

cp_function_senses cp_function_senses_create(const cp_lookout_settings *settings,
                                             const cp_control_context *context)
{
    return (cp_function_senses){.traffic = context->traffic,
                                .view = context->view,
                                .lookout = cp_lookout_create(settings, context->traffic),
                                .stepped_s = NOT_YET};
}

void cp_function_senses_destroy(cp_function_senses *senses)
{
    cp_lookout_destroy(&senses->lookout);
    free(senses->objects);
    *senses = (cp_function_senses){0};
}

crashpulse_view cp_function_view(cp_function_senses *senses, const cp_vehicle_motion *motion)
{
    const cp_vehicle_state *state = &motion->after;
    cp_lateral_overlay overlay =
        cp_lateral_overlay_get(cp_traffic_overlays(senses->traffic), state->vehicle);
    senses->own = motion;
    senses->has_looked = senses->has_threat = false;
    return (crashpulse_view){
        .id = cp_traffic_vehicle_id(senses->traffic, state->vehicle),
        .time_s = cp_traffic_time_s(senses->traffic),
        .step_s = cp_traffic_step_length_s(senses->traffic),
        .speed_m_s = state->speed_m_s,
        .acceleration_m_s2 = state->acceleration_m_s2,
        .yaw_rate_rad_s = motion->yaw_rate_rad_s,
        .length_m = state->length_m,
        .width_m = state->width_m,
        .drift_m = overlay.offset_m,
        .drift_1 = overlay.slope_1,
        .host = &HOST,
        .handle = senses,
    };
}

cp_status cp_function_senses_end(cp_function_senses *senses, cp_error *error)
{
    if (!senses->has_looked)
        cp_lookout_forget(&senses->lookout, senses->own->after.vehicle);
    cp_status status = senses->status;
    if (status != CP_OK)
        *error = senses->error;
    return status;
}

cp_target_class cp_function_class_of(const cp_function_senses *senses, const cp_vehicle_motion *own,
                                     uint32_t target)
{
    if (senses->has_threat && senses->threat.vehicle == target)
        return senses->threat.class;
    const cp_vehicle_motion *other = cp_traffic_motion_of(senses->traffic, target);
    if (other == NULL)
        return CP_TARGET_CROSSING;
    cp_moving_rectangle one = cp_moving_rectangle_of(own), two = cp_moving_rectangle_of(other);
    return cp_target_class_of(&one, &two);
}
