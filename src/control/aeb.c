/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control_types.h"

#include "control/brake.h"
#include "control/neighbourhood.h"
#include "control/sensor.h"
#include "control/ttc.h"
#include "core/units.h"

#include <stdlib.h>
#include <string.h>

/* Automatic emergency braking: when the time to collision with anything in view falls below a
 * threshold, brake. Request at the first instant the TTC is below ttc_s inside the step, brake
 * after sensor latency and dead time, deceleration rising with limited jerk to what is asked or
 * what the tyres hold. A request is withdrawn when the TTC is above the threshold again before
 * deceleration has begun. SUMO's driver stays in charge of everything else and may brake harder. */

enum {
    PENETRATION_1,
    TTC_S,
    DECELERATION_M_S2,
    DEAD_TIME_S,
    JERK_M_S3,
    FRICTION_1,
    SPEED_MIN_M_S,
    SPEED_MAX_M_S,
    RANGE_M,
    FIELD_OF_VIEW_DEG,
    LATENCY_S,
    RELEASE_TTC_S,
    HOLD_S
};

static const cp_control_parameter PARAMETERS[] = {
    [PENETRATION_1] = CP_CONTROL_PENETRATION,
    [TTC_S] = {"ttc_s", 1.2, 0.1, 5.0, "brake request below this time to collision, s (assumed)"},
    [DECELERATION_M_S2] = {"deceleration_m_s2", 8.0, 0.5, 12.0,
                           "deceleration asked for, m/s^2 (assumed; UN Regulation 152 asks for 5 "
                           "at least)"},
    [DEAD_TIME_S] = {"dead_time_s", 0.1, 0.0, 2.0,
                     "from request to the first deceleration, s (assumed)"},
    [JERK_M_S3] = {"jerk_m_s3", 40.0, 1.0, 1000.0, "rise of deceleration, m/s^3 (assumed)"},
    [FRICTION_1] = {"friction_1", 0.9, 0.05, 1.5,
                    "friction coefficient; deceleration stays below friction times 9.80665 m/s^2 "
                    "(assumed: dry road)"},
    [SPEED_MIN_M_S] = {"speed_min_m_s", 2.78, 0.0, 100.0,
                       "no request below this own speed, m/s (10 km/h as in UN Regulation 152)"},
    [SPEED_MAX_M_S] = {"speed_max_m_s", 60.0, 0.0, 200.0,
                       "no request above this own speed, m/s (assumed)"},
    [RANGE_M] = {"sensor_range_m", 80.0, 1.0, 500.0, "how far the sensor sees, m (assumed)"},
    [FIELD_OF_VIEW_DEG] = {"sensor_field_of_view_deg", 60.0, 1.0, 360.0,
                           "whole opening angle of the sensor, degrees (assumed)"},
    [LATENCY_S] = {"sensor_latency_s", 0.1, 0.0, 2.0, "age of what the sensor tells, s (assumed)"},
    [RELEASE_TTC_S] = {"release_ttc_s", 3.0, 0.1, 20.0,
                       "brakes until no time to collision is below this, s; at least ttc_s "
                       "(assumed)"},
    [HOLD_S] = {"hold_s", 0.5, 0.0, 10.0,
                "keeps braking this long after the danger has passed or the car stands, s "
                "(assumed)"},
};

/* The function in one car. */
typedef struct aeb_car {
    bool is_requesting; /* from the request to the release */
    bool is_braking;    /* speeds have been asked for */
    double brake_start_s;
    double commanded_until_s; /* the speed loss up to here has been commanded */
    double calm_since_s;      /* no danger, or standing, since then; INFINITY while in danger */
} aeb_car;

typedef struct aeb {
    const cp_traffic *traffic;
    cp_sensor sensor;
    double deceleration_m_s2;
    double release_ttc_s;
    aeb_car *cars; /* by vehicle number */
    size_t numbers;
    cp_neighbourhood neighbourhood;
    size_t activations;
    double braking_s;
} aeb;

static cp_status create(const cp_control_context *context, void **state, cp_error *error)
{
    aeb *created = calloc(1, sizeof *created);
    if (!created)
        return cp_fail_memory(error, "aeb");
    const double *parameter = context->parameter;
    created->traffic = context->traffic;
    created->sensor = (cp_sensor){parameter[RANGE_M], cp_rad_from_deg(parameter[FIELD_OF_VIEW_DEG]),
                                  parameter[LATENCY_S]};
    created->deceleration_m_s2 =
        fmin(parameter[DECELERATION_M_S2], parameter[FRICTION_1] * CP_G0_M_S2);
    created->release_ttc_s = fmax(parameter[RELEASE_TTC_S], parameter[TTC_S]);
    *state = created;
    return CP_OK;
}

static void destroy(void *state)
{
    aeb *self = state;
    cp_neighbourhood_clear(&self->neighbourhood);
    free(self->cars);
    free(self);
}

static cp_status reserve(aeb *self, uint32_t vehicle, cp_error *error)
{
    if (vehicle < self->numbers)
        return CP_OK;
    size_t numbers = 2 * ((size_t)vehicle + 1);
    aeb_car *cars = realloc(self->cars, numbers * sizeof *cars);
    if (!cars)
        return cp_fail_memory(error, "aeb");
    memset(&cars[self->numbers], 0, (numbers - self->numbers) * sizeof *cars);
    self->cars = cars;
    self->numbers = numbers;
    return CP_OK;
}

// What the sensor's tracker makes of a vehicle. SUMO's heading jumps where a lane change begins or
// ends; a yaw rate that no tyre could follow is such a jump and not a turn.
static cp_moving_rectangle track(const cp_vehicle_motion *motion, double friction_1)
{
    const cp_vehicle_state *state = &motion->after;
    cp_vec2 heading = cp_vec2_heading(state->yaw_rad);
    cp_vec2 front_m = {state->front_x_m, state->front_y_m};
    cp_moving_rectangle moving = {
        .rectangle = {cp_vec2_sub(front_m, cp_vec2_scale(heading, 0.5 * state->length_m)),
                      state->yaw_rad, state->length_m, state->width_m},
        .velocity_m_s = cp_vec2_scale(heading, state->speed_m_s),
        .yaw_rate_rad_s = motion->yaw_rate_rad_s,
    };
    if (fabs(moving.yaw_rate_rad_s * state->speed_m_s) > friction_1 * CP_G0_M_S2)
        moving.yaw_rate_rad_s = 0.0;
    return moving;
}

/* A look round from one car. */
typedef struct look {
    const aeb *self;
    uint32_t vehicle;
    double friction_1;
    double horizon_s;
    cp_moving_rectangle own;
    double ttc_s; /* smallest so far */
} look;

static void look_at(void *context, const cp_vehicle_motion *motion)
{
    look *looking = context;
    if (motion->after.vehicle == looking->vehicle)
        return;
    cp_moving_rectangle target = track(motion, looking->friction_1);
    double ttc_s = cp_ttc_s(&looking->own, &target, looking->horizon_s);
    // Few are on a collision course: whether they are in view is asked last.
    if (ttc_s < looking->ttc_s &&
        cp_sensor_sees(&looking->self->sensor, &looking->own.rectangle, &target.rectangle))
        looking->ttc_s = ttc_s;
}

static double smallest_ttc_s(const aeb *self, const cp_control_context *context,
                             const cp_vehicle_motion *motion, double horizon_s)
{
    double friction_1 = context->parameter[FRICTION_1];
    look looking = {self,      motion->after.vehicle,     friction_1,
                    horizon_s, track(motion, friction_1), INFINITY};
    cp_neighbourhood_visit(&self->neighbourhood, motion->after.front_x_m, motion->after.front_y_m,
                           look_at, &looking);
    return looking.ttc_s;
}

// The danger has passed before the brakes took hold: withdraw the request.
static bool is_withdrawn(const aeb *self, const cp_control_context *context,
                         const cp_vehicle_motion *motion, const aeb_car *car)
{
    double threshold_s = context->parameter[TTC_S];
    return cp_traffic_time_s(self->traffic) < car->brake_start_s &&
           !(smallest_ttc_s(self, context, motion, threshold_s) < threshold_s);
}

// Free driving: request braking when the TTC has fallen below the threshold. It falls by a second
// each second while both keep on, so the instant it crossed lies threshold - TTC back, in this
// step.
static void watch(aeb *self, const cp_control_context *context, const cp_vehicle_motion *motion,
                  aeb_car *car)
{
    const double *parameter = context->parameter;
    double speed_m_s = motion->after.speed_m_s;
    if (speed_m_s < parameter[SPEED_MIN_M_S] || speed_m_s > parameter[SPEED_MAX_M_S])
        return;
    double ttc_s = smallest_ttc_s(self, context, motion, parameter[TTC_S]);
    if (!(ttc_s < parameter[TTC_S]))
        return;
    double back_s = fmin(parameter[TTC_S] - ttc_s, cp_traffic_step_length_s(self->traffic));
    double request_s = cp_traffic_time_s(self->traffic) - back_s;
    car->is_requesting = true;
    car->brake_start_s = request_s + self->sensor.latency_s + parameter[DEAD_TIME_S];
    car->commanded_until_s = car->brake_start_s;
    car->calm_since_s = INFINITY;
}

// Whether the car may be handed back to its driver.
static bool is_over(const aeb *self, const cp_control_context *context,
                    const cp_vehicle_motion *motion, aeb_car *car)
{
    double now_s = cp_traffic_time_s(self->traffic);
    if (now_s < car->brake_start_s)
        return false;
    bool is_standing = motion->after.speed_m_s < 0.1;
    bool is_calm =
        is_standing || smallest_ttc_s(self, context, motion, self->release_ttc_s) == INFINITY;
    if (!is_calm)
        car->calm_since_s = INFINITY;
    else if (car->calm_since_s == INFINITY)
        car->calm_since_s = now_s;
    return is_calm && now_s - car->calm_since_s >= context->parameter[HOLD_S];
}

// Command the speed at the end of the coming step. What was lost of the first step between trigger
// and command is caught up, so that the speed is the profile's at the end of every step.
static cp_status brake(aeb *self, const cp_control_context *context,
                       const cp_vehicle_motion *motion, aeb_car *car, cp_error *error)
{
    uint32_t vehicle = motion->after.vehicle;
    double step_s = cp_traffic_step_length_s(self->traffic);
    double end_s = cp_traffic_time_s(self->traffic) + step_s;
    cp_brake profile = {car->brake_start_s, context->parameter[JERK_M_S3], self->deceleration_m_s2};
    double loss_m_s = cp_brake_speed_loss_m_s(&profile, end_s) -
                      cp_brake_speed_loss_m_s(&profile, car->commanded_until_s);
    if (loss_m_s <= 0.0)
        return CP_OK;

    self->activations += !car->is_braking;
    car->is_braking = true;
    car->commanded_until_s = end_s;
    self->braking_s += step_s;
    return cp_actuation_request(context->actuation, vehicle,
                                fmax(motion->after.speed_m_s - loss_m_s, 0.0), loss_m_s / step_s,
                                error);
}

static cp_status step_car(aeb *self, const cp_control_context *context,
                          const cp_vehicle_motion *motion, cp_error *error)
{
    aeb_car *car = &self->cars[motion->after.vehicle];
    if (!car->is_requesting)
        watch(self, context, motion, car);
    else if (is_withdrawn(self, context, motion, car))
        car->is_requesting = false;
    else if (is_over(self, context, motion, car))
        car->is_requesting = car->is_braking = false;
    return car->is_requesting ? brake(self, context, motion, car, error) : CP_OK;
}

static cp_status step(void *state, const cp_control_context *context, cp_error *error)
{
    aeb *self = state;
    if (!cp_equipment_is_any(context->equipment))
        return CP_OK;
    size_t count;
    const cp_vehicle_motion *motions = cp_traffic_motions(self->traffic, &count);
    // Fronts lie at most one sensor range and a long vehicle apart when the target is in view.
    double cell_m = self->sensor.range_m + 20.0;
    cp_status status = cp_neighbourhood_fill(&self->neighbourhood, cell_m, motions, count, error);
    for (size_t k = 0; k < count && status == CP_OK; k++) {
        status = reserve(self, motions[k].after.vehicle, error);
        if (status != CP_OK)
            return status;
        bool has = false;
        status = cp_equipment_has(context->equipment, self->traffic, motions[k].after.vehicle, &has,
                                  error);
        if (status == CP_OK && has)
            status = step_car(self, context, &motions[k], error);
    }
    return status;
}

static size_t counters(const void *state, const char **names, double *values, size_t room)
{
    const aeb *self = state;
    if (room < 2)
        return 0;
    names[0] = "activations";
    values[0] = (double)self->activations;
    names[1] = "braking_s";
    values[1] = self->braking_s;
    return 2;
}

const cp_control_type CP_CONTROL_AEB = {
    .name = "aeb",
    .kind = CP_CONTROL_FUNCTION,
    .what = "automatic emergency braking triggered by time to collision",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .create = create,
    .step = step,
    .counters = counters,
    .destroy = destroy,
};
