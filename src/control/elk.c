/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control_types.h"

#include "control/lookout.h"
#include "core/units.h"

#include <stdlib.h>
#include <string.h>

/* Emergency lane keeping against drifting into oncoming traffic. It watches cars that drift off
 * their path (traffic/lateral_overlay.h). When the side that drifts is about to cross the edge of
 * its lane while a known oncoming vehicle is about to pass, it takes over the steering after
 * latency and dead time and leads the car back to its path, along a cubic as short as its lateral
 * acceleration allows; then the driver, alert again, has the steering back. It does not brake. */

enum {
    PENETRATION_1,
    LINE_CROSSING_S,
    ONCOMING_S,
    LATERAL_ACCELERATION_M_S2,
    DEAD_TIME_S,
    SPEED_MIN_M_S,
    SPEED_MAX_M_S,
    RANGE_M,
    FIELD_OF_VIEW_DEG,
    LATENCY_S,
    CONFIRMATION_S,
    DETECTION_PROBABILITY_1,
    OCCLUSION_1
};

static const cp_control_parameter PARAMETERS[] = {
    [PENETRATION_1] = CP_CONTROL_PENETRATION,
    [LINE_CROSSING_S] = {"line_crossing_s", 0.3, -2.0, 5.0,
                         "acts when the drifting side crosses the edge of its lane within this, s; "
                         "below 0: has crossed it that long ago (assumed)"},
    [ONCOMING_S] = {"oncoming_s", 6.0, 0.1, 30.0,
                    "and a known oncoming vehicle is abreast within this at the speeds of now, s "
                    "(assumed)"},
    [LATERAL_ACCELERATION_M_S2] = {"lateral_acceleration_m_s2", 3.0, 0.5, 9.0,
                                   "largest lateral acceleration on the way back, m/s^2 (assumed; "
                                   "UN Regulation 79 allows 3)"},
    [DEAD_TIME_S] = {"dead_time_s", 0.1, 0.0, 2.0, "from request to steering, s (assumed)"},
    [SPEED_MIN_M_S] = {"speed_min_m_s", 16.0, 0.0, 100.0,
                       "does not act below this own speed, m/s (assumed; Euro NCAP tests at 20)"},
    [SPEED_MAX_M_S] = {"speed_max_m_s", 50.0, 0.0, 200.0,
                       "does not act above this own speed, m/s (assumed)"},
    [RANGE_M] = {"sensor_range_m", 200.0, 1.0, 500.0, "how far the sensor sees, m (assumed)"},
    [FIELD_OF_VIEW_DEG] = {"sensor_field_of_view_deg", 60.0, 1.0, 360.0,
                           "whole opening angle of the sensor, degrees (assumed)"},
    [LATENCY_S] = {"sensor_latency_s", 0.1, 0.0, 2.0, "age of what the sensor tells, s (assumed)"},
    [CONFIRMATION_S] = {"sensor_confirmation_s", 0.2, 0.0, 5.0,
                        "a target is known after this long in view without a break, s (assumed)"},
    [DETECTION_PROBABILITY_1] = {"sensor_detection_probability_1", 1.0, 0.0, 1.0,
                                 "chance that one particular target is ever detected, drawn once "
                                 "per pair of vehicles (assumed)"},
    [OCCLUSION_1] = {"sensor_occlusion_1", 1.0, 0.0, 1.0,
                     "1: other vehicles hide what is behind them; 0: nothing hides anything"},
};

typedef enum phase { WATCHING, REQUESTING, STEERING } phase;

/* The function in one car. */
typedef struct elk_car {
    phase phase;
    double steer_from_s;  /* clock */
    double return_left_m; /* way until back on the path */
} elk_car;

typedef struct elk {
    const cp_traffic *traffic;
    cp_lookout lookout;
    cp_vehicle_table cars; /* an elk_car of each */
    size_t interventions;
} elk;

static cp_status create(const cp_control_context *context, void **state, cp_error *error)
{
    elk *created = calloc(1, sizeof *created);
    if (!created)
        return cp_fail_memory(error, "elk");
    const double *parameter = context->parameter;
    cp_lookout_settings settings = {
        .sensor = {parameter[RANGE_M], cp_rad_from_deg(parameter[FIELD_OF_VIEW_DEG]),
                   parameter[LATENCY_S]},
        .confirmation_s = parameter[CONFIRMATION_S],
        .detection_probability_1 = parameter[DETECTION_PROBABILITY_1],
        .has_occlusion = parameter[OCCLUSION_1] >= 0.5,
        .horizon_s = parameter[ONCOMING_S],
        .key = context->seed_key,
        .view = context->view,
    };
    created->traffic = context->traffic;
    created->lookout = cp_lookout_create(&settings, context->traffic);
    created->cars = cp_vehicle_table_create(sizeof(elk_car), NULL);
    *state = created;
    return CP_OK;
}

static void destroy(void *state)
{
    elk *self = state;
    cp_lookout_destroy(&self->lookout);
    cp_vehicle_table_destroy(&self->cars);
    free(self);
}

// Time until the drifting side crosses the edge of its lane, negative since when; INFINITY when the
// car does not drift outwards. The path is taken to be the middle of the lane.
static cp_status line_crossing(const elk *self, const cp_vehicle_motion *motion,
                               cp_lateral_overlay overlay, double *crossing_s, cp_error *error)
{
    double outwards_m_s = overlay.slope_1 * motion->after.speed_m_s, width_m;
    *crossing_s = INFINITY;
    if (outwards_m_s == 0.0 || outwards_m_s * overlay.offset_m < 0.0)
        return CP_OK;
    cp_status status = cp_traffic_lane_width(self->traffic, &motion->after, &width_m, error);
    double margin_m = 0.5 * (width_m - motion->after.width_m);
    *crossing_s = (margin_m - fabs(overlay.offset_m)) / fabs(outwards_m_s);
    return status;
}

// Whether the drift leads to the side on which a known oncoming vehicle is about to pass.
static bool is_oncoming(const elk *self, const cp_control_context *context,
                        const cp_vehicle_motion *own, double drift_1)
{
    cp_vec2 axis = cp_vec2_heading(own->after.yaw_rad);
    const cp_tracks tracks = cp_lookout_tracks_of(&self->lookout, own->after.vehicle);
    for (size_t k = 0; k < tracks.count; k++) {
        const cp_vehicle_motion *other =
            cp_traffic_motion_of(self->traffic, tracks.track[k].vehicle);
        if (!other || !cp_lookout_is_known(&self->lookout, &tracks.track[k]))
            continue;
        double apart_rad = fabs(cp_wrap_angle(other->after.yaw_rad - own->after.yaw_rad));
        cp_vec2 there_m = {other->after.front_x_m - own->after.front_x_m,
                           other->after.front_y_m - own->after.front_y_m};
        double ahead_m = cp_vec2_dot(there_m, axis), left_m = cp_vec2_cross(axis, there_m);
        double closing_m_s = own->after.speed_m_s + other->after.speed_m_s;
        if (apart_rad > 0.75 * CP_PI && ahead_m > 0.0 && left_m * drift_1 > 0.0 &&
            ahead_m < closing_m_s * context->parameter[ONCOMING_S])
            return true;
    }
    return false;
}

// The shortest way back that keeps within the lateral acceleration. Of the cubic with offset y and
// slope k over the length l the second derivative is largest at one of its ends: |6 y / l^2 + 4 k /
// l| or |6 y / l^2 + 2 k / l|, times v^2.
static double return_way_m(cp_lateral_overlay overlay, double speed_m_s, double limit_m_s2)
{
    double way_m = fmax(speed_m_s, 1.0) * 0.2;
    for (; way_m < 1000.0; way_m *= 1.02) {
        double base_1_m = 6.0 * overlay.offset_m / (way_m * way_m);
        double at_start_1_m = fabs(base_1_m + 4.0 * overlay.slope_1 / way_m);
        double at_end_1_m = fabs(base_1_m + 2.0 * overlay.slope_1 / way_m);
        if (fmax(at_start_1_m, at_end_1_m) * speed_m_s * speed_m_s <= limit_m_s2)
            break;
    }
    return way_m;
}

static cp_status watch(elk *self, const cp_control_context *context,
                       const cp_vehicle_motion *motion, cp_lateral_overlay overlay, elk_car *car,
                       cp_error *error)
{
    const double *parameter = context->parameter;
    double speed_m_s = motion->after.speed_m_s;
    double crossing_s;
    cp_status status = line_crossing(self, motion, overlay, &crossing_s, error);
    if (status != CP_OK || speed_m_s < parameter[SPEED_MIN_M_S] ||
        speed_m_s > parameter[SPEED_MAX_M_S] || !(crossing_s < parameter[LINE_CROSSING_S]) ||
        !is_oncoming(self, context, motion, overlay.slope_1))
        return status;
    // It falls by a second each second: the threshold was crossed inside the step.
    double back_s =
        fmin(parameter[LINE_CROSSING_S] - crossing_s, cp_traffic_step_length_s(self->traffic));
    car->phase = REQUESTING;
    car->steer_from_s =
        cp_traffic_time_s(self->traffic) - back_s + parameter[LATENCY_S] + parameter[DEAD_TIME_S];
    return CP_OK;
}

static cp_status steer(elk *self, const cp_control_context *context,
                       const cp_vehicle_motion *motion, elk_car *car, cp_error *error)
{
    cp_lateral_overlays *overlays = cp_traffic_overlays(self->traffic);
    uint32_t vehicle = motion->after.vehicle;
    double speed_m_s = motion->after.speed_m_s, mean_slope_1, end_slope_1;
    cp_lateral_overlay now = cp_lateral_overlay_get(overlays, vehicle);
    if (car->phase == REQUESTING) {
        car->phase = STEERING;
        car->return_left_m =
            return_way_m(now, speed_m_s, context->parameter[LATERAL_ACCELERATION_M_S2]);
        self->interventions++;
    }
    if (car->return_left_m <= 0.0) {
        cp_lateral_overlay_end(overlays, vehicle);
        car->phase = WATCHING;
        return CP_OK;
    }
    double way_m = speed_m_s * cp_traffic_step_length_s(self->traffic);
    cp_lateral_overlay_return(now, car->return_left_m, way_m, &mean_slope_1, &end_slope_1);
    car->return_left_m -= way_m;
    return cp_lateral_overlay_steer(overlays, vehicle, mean_slope_1, end_slope_1, error);
}

// Instant of the request.
static double requested_s(const cp_control_context *context, const elk_car *car)
{
    return car->steer_from_s - context->parameter[LATENCY_S] - context->parameter[DEAD_TIME_S];
}

static cp_status step_car(elk *self, const cp_control_context *context,
                          const cp_vehicle_motion *motion, elk_car *car, cp_error *error)
{
    cp_status status = CP_OK;
    cp_lateral_overlay overlay =
        cp_lateral_overlay_get(cp_traffic_overlays(self->traffic), motion->after.vehicle);
    if (car->phase == WATCHING && overlay.slope_1 == 0.0) {
        cp_lookout_forget(&self->lookout, motion->after.vehicle);
    } else if (car->phase == WATCHING) {
        status = cp_lookout_track(&self->lookout, motion, error);
        if (status == CP_OK)
            status = watch(self, context, motion, overlay, car, error);
    }
    double end_s = cp_traffic_time_s(self->traffic) + cp_traffic_step_length_s(self->traffic);
    bool is_steering = car->phase != WATCHING && car->steer_from_s < end_s;
    if (status == CP_OK && car->phase != WATCHING)
        status = cp_acts_note(context->acts, motion->after.vehicle,
                              is_steering ? CP_ACT_STEERING : CP_ACT_REQUEST,
                              is_steering ? car->steer_from_s : requested_s(context, car), error);
    if (status == CP_OK && is_steering)
        status = steer(self, context, motion, car, error);
    return status;
}

static cp_status step_equipped(void *state, const void *context, const cp_vehicle_motion *motion,
                               cp_error *error)
{
    elk *self = state;
    void *car;
    cp_status status = cp_vehicle_table_take(&self->cars, motion->after.vehicle, &car, error);
    return status == CP_OK ? step_car(self, context, motion, car, error) : status;
}

static cp_status step(void *state, const cp_control_context *context, cp_error *error)
{
    elk *self = state;
    if (!cp_equipment_is_any(context->equipment))
        return CP_OK;
    cp_status status = cp_vehicle_table_prune(&self->cars, self->traffic, error);
    if (status == CP_OK)
        status = cp_lookout_step(&self->lookout, error);
    return status == CP_OK ? cp_equipment_each(context->equipment, self->traffic, step_equipped,
                                               self, context, error)
                           : status;
}

static size_t counters(const void *state, const char **names, double *values, size_t room)
{
    const elk *self = state;
    if (room < 1)
        return 0;
    names[0] = "interventions";
    values[0] = (double)self->interventions;
    return 1;
}

const cp_control_type CP_CONTROL_ELK = {
    .name = "elk",
    .kind = CP_CONTROL_FUNCTION,
    .what = "emergency lane keeping against drifting into oncoming traffic",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .create = create,
    .step = step,
    .counters = counters,
    .destroy = destroy,
};
