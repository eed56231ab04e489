/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control_types.h"

#include "control/brake.h"
#include "control/lookout.h"
#include "core/units.h"

#include <stdlib.h>
#include <string.h>

/* Forward collision warning. At the first instant inside the step at which a known target is a
 * threat (lookout.h), by default of the same direction or oncoming, the driver is warned; a share
 * of drivers heeds it and brakes after a log-normally distributed reaction time, until the danger
 * has passed. SUMO's driver stays in charge of everything else and may brake earlier or harder.
 *
 * A warning is borne out when the two bodies touch, or one of the two drivers brakes harder than at
 * ease, within the TTC and BEARS_OUT_S more. The own car's braking counts as long as the warned
 * driver does not brake for the warning: with compliance_1 0 the traffic is as without the
 * function, and what is not borne out was for nothing. */
#define BEARS_OUT_S 2.0
#define HARDER_M_S2 0.1 /* than at ease: rounding */

enum {
    PENETRATION_1,
    TTC_S,
    REQUIRED_M_S2,
    REACTION_MEDIAN_S,
    REACTION_SPREAD_1,
    COMPLIANCE_1,
    DECELERATION_M_S2,
    JERK_M_S3,
    FRICTION_1,
    SPEED_MIN_M_S,
    RANGE_M,
    FIELD_OF_VIEW_DEG,
    LATENCY_S,
    CONFIRMATION_S,
    DETECTION_PROBABILITY_1,
    OCCLUSION_1,
    REAR_END_1,
    ONCOMING_1,
    CROSSING_1,
    TURNING_1,
    RELEASE_TTC_S,
    HOLD_S
};

static const cp_control_parameter PARAMETERS[] = {
    [PENETRATION_1] = CP_CONTROL_PENETRATION,
    [TTC_S] = {"ttc_s", 2.4, 0.1, 10.0, "warning below this time to collision, s (assumed)"},
    [REQUIRED_M_S2] = {"required_deceleration_m_s2", CP_LOOKOUT_EASY_BRAKING_M_S2, 0.0, 20.0,
                       "and when avoiding the contact takes at least this deceleration, m/s^2 "
                       "(assumed: what SUMO's drivers brake at ease by default)"},
    [REACTION_MEDIAN_S] = {"reaction_median_s", 1.0, 0.0, 5.0,
                           "median of the drivers' reaction time from warning to brake, s "
                           "(assumed)"},
    [REACTION_SPREAD_1] = {"reaction_spread_1", 0.3, 0.0, 2.0,
                           "standard deviation of its logarithm (assumed)"},
    [COMPLIANCE_1] = {"compliance_1", 0.8, 0.0, 1.0,
                      "share of drivers who heed warnings, drawn once per vehicle (assumed)"},
    [DECELERATION_M_S2] = {"deceleration_m_s2", 6.0, 0.5, 12.0,
                           "how hard a warned driver brakes, m/s^2 (assumed)"},
    [JERK_M_S3] = {"jerk_m_s3", 20.0, 1.0, 1000.0, "rise of deceleration, m/s^3 (assumed)"},
    [FRICTION_1] = {"friction_1", 0.9, 0.05, 1.5,
                    "friction coefficient; deceleration stays below friction times 9.80665 m/s^2 "
                    "(assumed: dry road)"},
    [SPEED_MIN_M_S] = {"speed_min_m_s", 8.0, 0.0, 100.0,
                       "no warning below this own speed, m/s (assumed)"},
    [RANGE_M] = {"sensor_range_m", 120.0, 1.0, 500.0, "how far the sensor sees, m (assumed)"},
    [FIELD_OF_VIEW_DEG] = {"sensor_field_of_view_deg", 40.0, 1.0, 360.0,
                           "whole opening angle of the sensor, degrees (assumed)"},
    [LATENCY_S] = {"sensor_latency_s", 0.1, 0.0, 2.0, "age of what the sensor tells, s (assumed)"},
    [CONFIRMATION_S] = {"sensor_confirmation_s", 0.2, 0.0, 5.0,
                        "a target is known after this long in view without a break, s (assumed)"},
    [DETECTION_PROBABILITY_1] = {"sensor_detection_probability_1", 1.0, 0.0, 1.0,
                                 "chance that one particular target is ever detected, drawn once "
                                 "per pair of vehicles (assumed)"},
    [OCCLUSION_1] = {"sensor_occlusion_1", 1.0, 0.0, 1.0,
                     "1: other vehicles hide what is behind them; 0: nothing hides anything"},
    [REAR_END_1] = {"rear_end_1", 1.0, 0.0, 1.0,
                    "1: warns of targets heading the same way; 0: not"},
    [ONCOMING_1] = {"oncoming_1", 1.0, 0.0, 1.0, "1: warns of oncoming targets; 0: not"},
    [CROSSING_1] = {"crossing_1", 0.0, 0.0, 1.0, "1: warns of crossing targets; 0: not"},
    [TURNING_1] = {"turning_1", 0.0, 0.0, 1.0,
                   "1: warns when one of the two turns across the other's way; 0: not"},
    [RELEASE_TTC_S] = {"release_ttc_s", 4.0, 0.1, 20.0,
                       "the driver brakes until no time to collision is below this, s; at least "
                       "ttc_s (assumed)"},
    [HOLD_S] = {"hold_s", 0.5, 0.0, 10.0,
                "and this long after the danger has passed or the car stands, s (assumed)"},
};

/* The function, and the warned driver, in one car. */
typedef struct fcw_car {
    cp_braking braking;
    bool is_warned; /* from the warning until the danger has passed */
    double warned_s;
    uint64_t warnings;
    uint32_t target; /* of the last warning, */
    double until_s;  /* looked at until then, SUMO clock */
} fcw_car;

typedef struct fcw {
    const cp_traffic *traffic;
    cp_lookout lookout;
    cp_brake brake; /* but for its start */
    double release_ttc_s;
    cp_vehicle_table cars; /* an fcw_car of each */
    size_t warnings;
    size_t heeded;
    size_t without_error;
    size_t borne_out;
    double braking_s;
} fcw;

static cp_status create(const cp_control_context *context, void **state, cp_error *error)
{
    fcw *created = calloc(1, sizeof *created);
    if (!created)
        return cp_fail_memory(error, "fcw");
    const double *parameter = context->parameter;
    double release_ttc_s = fmax(parameter[RELEASE_TTC_S], parameter[TTC_S]);
    cp_lookout_settings settings = {
        .sensor = {parameter[RANGE_M], cp_rad_from_deg(parameter[FIELD_OF_VIEW_DEG]),
                   parameter[LATENCY_S]},
        .confirmation_s = parameter[CONFIRMATION_S],
        .detection_probability_1 = parameter[DETECTION_PROBABILITY_1],
        .has_occlusion = parameter[OCCLUSION_1] >= 0.5,
        .has_class = {[CP_TARGET_REAR_END] = parameter[REAR_END_1] >= 0.5,
                      [CP_TARGET_ONCOMING] = parameter[ONCOMING_1] >= 0.5,
                      [CP_TARGET_CROSSING] = parameter[CROSSING_1] >= 0.5,
                      [CP_TARGET_TURNING] = parameter[TURNING_1] >= 0.5},
        .ttc_s = parameter[TTC_S],
        .required_m_s2 = parameter[REQUIRED_M_S2],
        .horizon_s = fmax(release_ttc_s, parameter[TTC_S] + parameter[CONFIRMATION_S] + 0.5),
        .key = context->seed_key,
        .view = context->view,
    };
    created->traffic = context->traffic;
    created->lookout = cp_lookout_create(&settings, context->traffic);
    created->cars = cp_vehicle_table_create(sizeof(fcw_car), NULL);
    created->brake.jerk_m_s3 = parameter[JERK_M_S3];
    created->brake.deceleration_m_s2 =
        fmin(parameter[DECELERATION_M_S2], parameter[FRICTION_1] * CP_G0_M_S2);
    created->release_ttc_s = release_ttc_s;
    *state = created;
    return CP_OK;
}

static void destroy(void *state)
{
    fcw *self = state;
    cp_lookout_destroy(&self->lookout);
    cp_vehicle_table_destroy(&self->cars);
    free(self);
}

// Warn, and see whether and when this driver brakes.
static cp_status watch(fcw *self, const cp_control_context *context,
                       const cp_vehicle_motion *motion, fcw_car *car, cp_error *error)
{
    const double *parameter = context->parameter;
    cp_threat threat;
    bool found = false;
    cp_status status = CP_OK;
    if (motion->after.speed_m_s >= parameter[SPEED_MIN_M_S])
        status = cp_lookout_threat(&self->lookout, motion, &found, &threat, error);
    if (status != CP_OK || !found)
        return status;
    const char *id = cp_traffic_vehicle_id(self->traffic, motion->after.vehicle);
    cp_rng_key key = cp_rng_key_text(context->seed_key, id);
    bool heeds = cp_rng_uniform(cp_rng_key_text(key, "compliance"), 0) < parameter[COMPLIANCE_1];
    double reaction_s = parameter[REACTION_MEDIAN_S] *
                        exp(parameter[REACTION_SPREAD_1] *
                            cp_rng_normal(cp_rng_key_text(key, "reaction"), car->warnings++));
    self->warnings++;
    self->heeded += heeds;
    self->without_error +=
        !cp_controls_has_cause(context->controls, motion->after.vehicle, threat.vehicle);
    car->is_warned = true;
    car->target = threat.vehicle;
    car->until_s = cp_traffic_time_s(self->traffic) + threat.ttc_s + BEARS_OUT_S;
    car->warned_s = threat.instant_s + parameter[LATENCY_S];
    car->braking = (cp_braking){0};
    if (!heeds)
        return CP_OK;
    cp_brake brake = self->brake;
    brake.start_s = car->warned_s + reaction_s;
    cp_braking_begin(&car->braking, &brake);
    return CP_OK;
}

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

// Whether what the car was warned of comes.
static void look_back(fcw *self, const cp_vehicle_motion *motion, fcw_car *car)
{
    const double hard_m_s2 = CP_LOOKOUT_EASY_BRAKING_M_S2 + HARDER_M_S2;
    if (!(cp_traffic_time_s(self->traffic) <= car->until_s))
        return;
    const cp_vehicle_motion *target = cp_traffic_motion_of(self->traffic, car->target);
    bool comes = !car->braking.is_braking && motion->after.acceleration_m_s2 < -hard_m_s2;
    if (target != NULL)
        comes |= target->after.acceleration_m_s2 < -hard_m_s2 || have_touched(motion, target);
    self->borne_out += comes;
    if (comes || target == NULL)
        car->until_s = 0.0;
}

static cp_status step_car(fcw *self, const cp_control_context *context,
                          const cp_vehicle_motion *motion, fcw_car *car, cp_error *error)
{
    look_back(self, motion, car);
    // Too slow to act: nothing is looked for, which spares the queues at junctions.
    if (!car->is_warned && motion->after.speed_m_s < context->parameter[SPEED_MIN_M_S]) {
        cp_lookout_forget(&self->lookout, motion->after.vehicle);
        return CP_OK;
    }
    cp_status status = cp_lookout_track(&self->lookout, motion, error);
    if (status != CP_OK)
        return status;
    if (!car->is_warned) {
        status = watch(self, context, motion, car, error);
    } else {
        // The danger may also pass before the driver has reacted.
        double now_s = cp_traffic_time_s(self->traffic);
        bool is_danger = false;
        if (motion->after.speed_m_s >= 0.1)
            status = cp_lookout_is_danger(&self->lookout, motion, self->release_ttc_s, &is_danger,
                                          error);
        bool is_calm = !is_danger;
        bool has_begun = car->braking.is_requesting && now_s >= car->braking.brake.start_s;
        car->is_warned = has_begun ? !cp_braking_is_over(&car->braking, now_s, is_calm,
                                                         context->parameter[HOLD_S])
                                   : !is_calm;
    }
    if (status == CP_OK && car->is_warned)
        status = cp_acts_note(context->acts, motion->after.vehicle, CP_ACT_WARNING, car->warned_s,
                              error);
    if (status != CP_OK || !car->is_warned || !car->braking.is_requesting)
        return status;
    status = cp_braking_command(&car->braking, self->traffic, motion, context->actuation, error);
    if (car->braking.is_braking)
        self->braking_s += cp_traffic_step_length_s(self->traffic);
    return status;
}

static cp_status step_equipped(void *state, const void *context, const cp_vehicle_motion *motion,
                               cp_error *error)
{
    fcw *self = state;
    void *car;
    cp_status status = cp_vehicle_table_take(&self->cars, motion->after.vehicle, &car, error);
    return status == CP_OK ? step_car(self, context, motion, car, error) : status;
}

static cp_status step(void *state, const cp_control_context *context, cp_error *error)
{
    fcw *self = state;
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
    const fcw *self = state;
    const struct {
        const char *name;
        double value;
    } rows[] = {
        {"warnings", (double)self->warnings},
        {"warnings_heeded", (double)self->heeded},
        {"warnings_without_error", (double)self->without_error},
        {"warnings_borne_out", (double)self->borne_out},
        {"braking_s", self->braking_s},
    };
    size_t count = sizeof rows / sizeof *rows;
    if (room < count)
        return 0;
    for (size_t k = 0; k < count; k++) {
        names[k] = rows[k].name;
        values[k] = rows[k].value;
    }
    return count;
}

const cp_control_type CP_CONTROL_FCW = {
    .name = "fcw",
    .kind = CP_CONTROL_FUNCTION,
    .what = "forward collision warning: the driver brakes after a reaction time",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .create = create,
    .step = step,
    .counters = counters,
    .destroy = destroy,
};
