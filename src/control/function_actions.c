/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_actions.h"

#include "control/acts.h"

#include <math.h>

#define BEARS_OUT_S 2.0 /* a warning has come true within the TTC and this */
#define HARDER_M_S2 0.1 /* than at ease: rounding */

// A warning goes on, or begins, and is counted by what it is for.
static cp_status warn(cp_function_actions *self, const cp_control_context *context,
                      cp_function_car *car, uint32_t vehicle, const crashpulse_request *request,
                      cp_error *error)
{
    bool is_new = request->warned_s != CRASHPULSE_NONE && !car->is_warned;
    car->is_warned = request->warned_s != CRASHPULSE_NONE;
    if (is_new) {
        double ttc_s = request->target_ttc_s != CRASHPULSE_NONE ? request->target_ttc_s : 0.0;
        self->counts.warnings++;
        self->counts.warnings_without_error +=
            request->target == CRASHPULSE_NOBODY ||
            !cp_controls_has_cause(context->controls, vehicle, request->target);
        car->warned_of = request->target;
        car->until_s = cp_traffic_time_s(self->traffic) + ttc_s + BEARS_OUT_S;
        if (!car->braking.is_requesting)
            car->braking = (cp_braking){0};
    }
    if (!car->is_warned)
        return CP_OK;
    return cp_acts_note(context->acts, vehicle, CP_ACT_WARNING, request->warned_s, error);
}

// Braking is asked for, for the first time after it was not.
static void begin_braking(cp_function_actions *self, const cp_control_context *context,
                          cp_function_car *car, const cp_vehicle_motion *motion,
                          const crashpulse_request *request)
{
    double now_s = cp_traffic_time_s(self->traffic);
    double since_s = request->since_s != CRASHPULSE_NONE ? request->since_s : now_s;
    cp_brake brake = {.start_s = since_s + self->brake_delay_s,
                      .jerk_m_s3 = self->jerk_m_s3,
                      .deceleration_m_s2 = fmin(-request->acceleration_m_s2, self->friction_m_s2)};
    cp_braking_begin(&car->braking, &brake);
    car->requested_s = brake.start_s - self->brake_delay_s;
    car->has_target = request->target != CRASHPULSE_NOBODY;
    car->has_cause =
        car->has_target &&
        cp_controls_has_cause(context->controls, motion->after.vehicle, request->target);
    if (car->has_target)
        car->class_of = cp_function_class_of(self->senses, motion, request->target);
}

static void count_activation(cp_function_counts *counts, const cp_function_car *car)
{
    counts->activations++;
    counts->activations_without_error += !car->has_cause;
    if (car->has_target)
        counts->of_class[car->class_of]++;
    else
        counts->for_nothing++;
}

static cp_status brake(cp_function_actions *self, const cp_control_context *context,
                       cp_function_car *car, const cp_vehicle_motion *motion,
                       const crashpulse_request *request, cp_error *error)
{
    double asked_m_s2 = fmin(-request->acceleration_m_s2, self->friction_m_s2);
    double now_s = cp_traffic_time_s(self->traffic);
    cp_status status = CP_OK;
    if (!car->braking.is_requesting)
        begin_braking(self, context, car, motion, request);
    else if (asked_m_s2 != car->braking.brake.deceleration_m_s2)
        cp_braking_change(&car->braking, now_s, asked_m_s2);
    if (self->does & CRASHPULSE_BRAKES)
        status = cp_acts_note(context->acts, motion->after.vehicle, CP_ACT_REQUEST,
                              car->requested_s, error);
    if (status != CP_OK)
        return status;
    bool was_braking = car->braking.is_braking;
    status = cp_braking_command(&car->braking, self->traffic, motion, context->actuation, error);
    if (car->braking.is_braking) {
        self->counts.braking_s += cp_traffic_step_length_s(self->traffic);
        if (!was_braking)
            count_activation(&self->counts, car);
    }
    return status;
}

static cp_status accelerate(cp_function_actions *self, const cp_control_context *context,
                            cp_function_car *car, const cp_vehicle_motion *motion,
                            const crashpulse_request *request, cp_error *error)
{
    if (request->acceleration_m_s2 < 0.0 && request->acceleration_m_s2 != CRASHPULSE_NONE)
        return brake(self, context, car, motion, request, error);
    car->braking.is_requesting = false;
    if (request->acceleration_m_s2 == CRASHPULSE_NONE)
        return CP_OK;
    double gain_m_s = request->acceleration_m_s2 * cp_traffic_step_length_s(self->traffic);
    return cp_actuation_request(context->actuation, motion->after.vehicle,
                                motion->after.speed_m_s + gain_m_s, 0.0, error);
}

static cp_status steer(cp_function_actions *self, const cp_control_context *context,
                       cp_function_car *car, uint32_t vehicle, const crashpulse_request *request,
                       cp_error *error)
{
    cp_lateral_overlays *overlays = cp_traffic_overlays(self->traffic);
    bool is_steered = request->is_back || request->steer_end_1 != CRASHPULSE_NONE;
    double now_s = cp_traffic_time_s(self->traffic);
    double since_s = request->steer_since_s != CRASHPULSE_NONE ? request->steer_since_s : now_s;
    cp_status status = CP_OK;
    if (is_steered)
        status = cp_acts_note(context->acts, vehicle, CP_ACT_STEERING, since_s, error);
    else if (request->announced_s != CRASHPULSE_NONE)
        status = cp_acts_note(context->acts, vehicle, CP_ACT_REQUEST, request->announced_s, error);
    self->counts.interventions += is_steered && !car->is_steering;
    car->is_steering = is_steered && !request->is_back;
    if (status != CP_OK || !is_steered)
        return status;
    if (request->is_back) {
        cp_lateral_overlay_end(overlays, vehicle);
        return CP_OK;
    }
    double mean_1 = request->steer_mean_1;
    if (mean_1 == CRASHPULSE_NONE)
        mean_1 = 0.5 * (cp_lateral_overlay_get(overlays, vehicle).slope_1 + request->steer_end_1);
    return cp_lateral_overlay_steer(overlays, vehicle, mean_1, request->steer_end_1, error);
}

// The speed factor is told to SUMO when it changes.
static cp_status limit(cp_function_actions *self, const cp_control_context *context,
                       cp_function_car *car, uint32_t vehicle, const crashpulse_request *request,
                       cp_error *error)
{
    const cp_traffic_source *commands = cp_traffic_commands(self->traffic);
    bool is_limit = request->speed_factor_1 != CRASHPULSE_NONE;
    double asked_1 = is_limit ? request->speed_factor_1 : car->driver_factor_1;
    cp_status status = CP_OK;
    if (!is_limit && car->factor_1 == 0.0)
        return CP_OK;
    if (car->driver_factor_1 == 0.0)
        status = commands->speed_factor(vehicle, &car->driver_factor_1, error);
    double factor_1 = fmin(asked_1, car->driver_factor_1);
    double set_1 = car->factor_1 != 0.0 ? car->factor_1 : car->driver_factor_1;
    if (status != CP_OK || factor_1 == set_1)
        return status;
    if (car->factor_1 == 0.0) {
        self->counts.limited++;
        status = cp_acts_note(context->acts, vehicle, CP_ACT_LIMITING,
                              cp_traffic_time_s(self->traffic), error);
    }
    car->factor_1 = factor_1;
    return status == CP_OK ? commands->set_speed_factor(vehicle, factor_1, error) : status;
}

cp_status cp_function_carry_out(cp_function_actions *self, const cp_control_context *context,
                                cp_function_car *car, const cp_vehicle_motion *motion,
                                const crashpulse_request *request, cp_error *error)
{
    uint32_t vehicle = motion->after.vehicle, does = self->does;
    cp_status status = CP_OK;
    if (does & CRASHPULSE_WARNS)
        status = warn(self, context, car, vehicle, request, error);
    if (status == CP_OK && does & CRASHPULSE_STEERS)
        status = steer(self, context, car, vehicle, request, error);
    if (status == CP_OK && does & CRASHPULSE_LIMITS)
        status = limit(self, context, car, vehicle, request, error);
    return status == CP_OK ? accelerate(self, context, car, motion, request, error) : status;
}

// ---- what came of it -----------------------------------------------------------------------

// Whether two bodies touched in the step that has ended, looked at four times.
static bool have_touched(const cp_vehicle_motion *one, const cp_vehicle_motion *other)
{
    bool is_whole = one->was_present && other->was_present;
    for (double fraction = is_whole ? 0.25 : 1.0; fraction <= 1.0; fraction += 0.25) {
        cp_rectangle body = cp_moving_rectangle_inside(one, fraction).rectangle;
        cp_rectangle other_body = cp_moving_rectangle_inside(other, fraction).rectangle;
        if (cp_rectangle_separation(&body, &other_body) <= 0.0)
            return true;
    }
    return false;
}

// Whether what the car was warned of comes: the two touch, or one of the drivers brakes harder than
// at ease. The own car's braking counts as long as it is not for the warning.
void cp_function_look_back(cp_function_actions *self, const cp_vehicle_motion *motion,
                           cp_function_car *car)
{
    const double hard_m_s2 = CP_LOOKOUT_EASY_BRAKING_M_S2 + HARDER_M_S2;
    if (!(cp_traffic_time_s(self->traffic) <= car->until_s))
        return;
    const cp_vehicle_motion *target = car->warned_of != CRASHPULSE_NOBODY
                                          ? cp_traffic_motion_of(self->traffic, car->warned_of)
                                          : NULL;
    bool comes = !car->braking.is_braking && motion->after.acceleration_m_s2 < -hard_m_s2;
    if (target != NULL)
        comes |= target->after.acceleration_m_s2 < -hard_m_s2 || have_touched(motion, target);
    self->counts.warnings_borne_out += comes;
    if (comes || target == NULL)
        car->until_s = 0.0;
}

// Deceleration that the host holds for the function at the end of the step.
double cp_function_held_m_s2(const cp_function_car *car, double now_s)
{
    return car->braking.is_requesting ? cp_brake_deceleration_m_s2(&car->braking.brake, now_s)
                                      : 0.0;
}
