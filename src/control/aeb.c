/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control_types.h"

#include "control/brake.h"
#include "control/lookout.h"
#include "core/units.h"

#include <stdlib.h>
#include <string.h>

/* Automatic emergency braking. The request is made at the first instant inside the step at which a
 * known target is a threat (lookout.h); deceleration begins after sensor latency and dead time and
 * rises with limited jerk to what is asked or what the tyres hold. A request is withdrawn when the
 * threat is gone before deceleration has begun. SUMO's driver stays in charge of everything else
 * and may brake harder. Now and then, at seeded times, it brakes for nothing:
 * false_activations_per_h. */

enum {
    PENETRATION_1,
    TTC_S,
    REQUIRED_M_S2,
    DECELERATION_M_S2,
    DEAD_TIME_S,
    JERK_M_S3,
    FRICTION_1,
    SPEED_MIN_M_S,
    SPEED_MAX_M_S,
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
    HOLD_S,
    FALSE_ACTIVATIONS_PER_H,
    FALSE_DURATION_S
};

static const cp_control_parameter PARAMETERS[] = {
    [PENETRATION_1] = CP_CONTROL_PENETRATION,
    [TTC_S] = {"ttc_s", 1.2, 0.1, 5.0, "brake request below this time to collision, s (assumed)"},
    [REQUIRED_M_S2] = {"required_deceleration_m_s2", CP_LOOKOUT_EASY_BRAKING_M_S2, 0.0, 20.0,
                       "and when avoiding the contact takes at least this deceleration, m/s^2: "
                       "closing speed / (2 TTC) (assumed: what SUMO's drivers brake at ease by "
                       "default; with less it acts for what they would have met)"},
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
    [CONFIRMATION_S] = {"sensor_confirmation_s", 0.2, 0.0, 5.0,
                        "a target is known after this long in view without a break, s (assumed)"},
    [DETECTION_PROBABILITY_1] = {"sensor_detection_probability_1", 1.0, 0.0, 1.0,
                                 "chance that one particular target is ever detected, drawn once "
                                 "per pair of vehicles (assumed)"},
    [OCCLUSION_1] = {"sensor_occlusion_1", 1.0, 0.0, 1.0,
                     "1: other vehicles hide what is behind them; 0: nothing hides anything"},
    [REAR_END_1] = {"rear_end_1", 1.0, 0.0, 1.0,
                    "1: acts on targets heading the same way, within 45 degrees; 0: not"},
    [ONCOMING_1] = {"oncoming_1", 1.0, 0.0, 1.0,
                    "1: acts on oncoming targets, headings more than 135 degrees apart; 0: not"},
    [CROSSING_1] = {"crossing_1", 1.0, 0.0, 1.0, "1: acts on crossing targets; 0: not"},
    [TURNING_1] = {"turning_1", 1.0, 0.0, 1.0,
                   "1: acts when one of the two turns across the other's way; 0: not"},
    [RELEASE_TTC_S] = {"release_ttc_s", 3.0, 0.1, 20.0,
                       "brakes until no time to collision is below this, s; at least ttc_s "
                       "(assumed)"},
    [HOLD_S] = {"hold_s", 0.5, 0.0, 10.0,
                "keeps braking this long after the danger has passed or the car stands, s "
                "(assumed)"},
    [FALSE_ACTIVATIONS_PER_H] = {"false_activations_per_h", 0.0, 0.0, 3600.0,
                                 "brakes for nothing, per hour of a car on the road, at seeded "
                                 "times (assumed)"},
    [FALSE_DURATION_S] = {"false_duration_s", 0.5, 0.0, 10.0,
                          "how long it then brakes, dead time not included, s (assumed)"},
};

/* The function in one car. */
typedef struct aeb_car {
    cp_braking braking;
    cp_target_class class; /* of the threat it acts on */
    bool has_cause;        /* that the study made */
    bool is_false;         /* braking for nothing, until false_until_s */
    double false_until_s;
    double next_false_s;      /* SUMO clock; 0: not drawn yet */
    uint64_t false_occasions; /* drawn so far */
} aeb_car;

typedef struct aeb {
    const cp_traffic *traffic;
    cp_lookout lookout;
    cp_brake brake; /* but for its start */
    double delay_s; /* from the threat to the first deceleration */
    double release_ttc_s;
    cp_vehicle_table cars; /* an aeb_car of each */
    size_t activations;
    size_t of_class[CP_TARGET_CLASSES];
    size_t false_activations;
    size_t without_error;
    double braking_s;
} aeb;

static cp_status create(const cp_control_context *context, void **state, cp_error *error)
{
    aeb *created = calloc(1, sizeof *created);
    if (!created)
        return cp_fail_memory(error, "aeb");
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
    created->cars = cp_vehicle_table_create(sizeof(aeb_car), NULL);
    created->brake.jerk_m_s3 = parameter[JERK_M_S3];
    created->brake.deceleration_m_s2 =
        fmin(parameter[DECELERATION_M_S2], parameter[FRICTION_1] * CP_G0_M_S2);
    created->delay_s = parameter[LATENCY_S] + parameter[DEAD_TIME_S];
    created->release_ttc_s = release_ttc_s;
    *state = created;
    return CP_OK;
}

static void destroy(void *state)
{
    aeb *self = state;
    cp_lookout_destroy(&self->lookout);
    cp_vehicle_table_destroy(&self->cars);
    free(self);
}

static void request(aeb *self, aeb_car *car, double instant_s)
{
    cp_brake brake = self->brake;
    brake.start_s = instant_s + self->delay_s;
    cp_braking_begin(&car->braking, &brake);
}

// Seeded times of a Poisson process on SUMO's clock, whenever the car came and whatever the step.
static bool is_false_alarm(aeb *self, const cp_control_context *context, uint32_t vehicle,
                           aeb_car *car, double *instant_s)
{
    double rate_per_h = context->parameter[FALSE_ACTIVATIONS_PER_H];
    double now_s = cp_traffic_time_s(self->traffic);
    double before_s = now_s - cp_traffic_step_length_s(self->traffic);
    if (rate_per_h <= 0.0)
        return false;
    cp_rng_key key = cp_rng_key_text(context->seed_key, "false activation");
    key = cp_rng_key_text(key, cp_traffic_vehicle_id(self->traffic, vehicle));
    while (car->next_false_s <= before_s)
        car->next_false_s += cp_rng_exponential(key, car->false_occasions++, 3600.0 / rate_per_h);
    *instant_s = car->next_false_s;
    return car->next_false_s <= now_s;
}

// Free driving: whether to request braking.
static cp_status watch(aeb *self, const cp_control_context *context,
                       const cp_vehicle_motion *motion, aeb_car *car, cp_error *error)
{
    const double *parameter = context->parameter;
    double speed_m_s = motion->after.speed_m_s, instant_s;
    cp_threat threat;
    bool found = false;
    if (speed_m_s < parameter[SPEED_MIN_M_S] || speed_m_s > parameter[SPEED_MAX_M_S])
        return CP_OK;
    cp_status status = cp_lookout_threat(&self->lookout, motion, &found, &threat, error);
    if (status != CP_OK)
        return status;
    if (found) {
        request(self, car, threat.instant_s);
        car->class = threat.class;
        car->is_false = false;
        car->has_cause =
            cp_controls_has_cause(context->controls, motion->after.vehicle, threat.vehicle);
    } else if (is_false_alarm(self, context, motion->after.vehicle, car, &instant_s)) {
        request(self, car, instant_s);
        car->is_false = true;
        car->has_cause = false;
        car->false_until_s = car->braking.brake.start_s + parameter[FALSE_DURATION_S];
    }
    return CP_OK;
}

// The request goes on, is withdrawn before deceleration has begun, or ends.
static cp_status follow(aeb *self, const cp_control_context *context,
                        const cp_vehicle_motion *motion, aeb_car *car, cp_error *error)
{
    double now_s = cp_traffic_time_s(self->traffic);
    cp_threat threat;
    if (car->is_false) {
        car->braking.is_requesting = now_s < car->false_until_s;
        return CP_OK;
    }
    if (now_s < car->braking.brake.start_s)
        return cp_lookout_threat(&self->lookout, motion, &car->braking.is_requesting, &threat,
                                 error);
    bool is_danger = false;
    cp_status status = CP_OK;
    if (motion->after.speed_m_s >= 0.1)
        status =
            cp_lookout_is_danger(&self->lookout, motion, self->release_ttc_s, &is_danger, error);
    if (cp_braking_is_over(&car->braking, now_s, !is_danger, context->parameter[HOLD_S]))
        car->braking.is_requesting = false;
    return status;
}

static void count_activation(aeb *self, const aeb_car *car)
{
    self->activations++;
    self->without_error += !car->has_cause;
    if (car->is_false)
        self->false_activations++;
    else
        self->of_class[car->class]++;
}

static cp_status step_car(aeb *self, const cp_control_context *context,
                          const cp_vehicle_motion *motion, aeb_car *car, cp_error *error)
{
    // Too slow to act: nothing is looked for, which spares the queues at junctions.
    if (!car->braking.is_requesting &&
        motion->after.speed_m_s < context->parameter[SPEED_MIN_M_S]) {
        cp_lookout_forget(&self->lookout, motion->after.vehicle);
        return CP_OK;
    }
    cp_status status = cp_lookout_track(&self->lookout, motion, error);
    if (status != CP_OK)
        return status;
    status = car->braking.is_requesting ? follow(self, context, motion, car, error)
                                        : watch(self, context, motion, car, error);
    if (status != CP_OK || !car->braking.is_requesting)
        return status;
    status = cp_acts_note(context->acts, motion->after.vehicle, CP_ACT_REQUEST,
                          car->braking.brake.start_s - self->delay_s, error);
    if (status != CP_OK)
        return status;
    bool was_braking = car->braking.is_braking;
    status = cp_braking_command(&car->braking, self->traffic, motion, context->actuation, error);
    if (car->braking.is_braking) {
        self->braking_s += cp_traffic_step_length_s(self->traffic);
        if (!was_braking)
            count_activation(self, car);
    }
    return status;
}

static cp_status step_equipped(void *state, const void *context, const cp_vehicle_motion *motion,
                               cp_error *error)
{
    aeb *self = state;
    void *car;
    cp_status status = cp_vehicle_table_take(&self->cars, motion->after.vehicle, &car, error);
    return status == CP_OK ? step_car(self, context, motion, car, error) : status;
}

static cp_status step(void *state, const cp_control_context *context, cp_error *error)
{
    aeb *self = state;
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
    const aeb *self = state;
    const struct {
        const char *name;
        double value;
    } rows[] = {
        {"activations", (double)self->activations},
        {"activations_rear_end", (double)self->of_class[CP_TARGET_REAR_END]},
        {"activations_oncoming", (double)self->of_class[CP_TARGET_ONCOMING]},
        {"activations_crossing", (double)self->of_class[CP_TARGET_CROSSING]},
        {"activations_turning", (double)self->of_class[CP_TARGET_TURNING]},
        {"activations_without_error", (double)self->without_error},
        {"activations_for_nothing", (double)self->false_activations},
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

const cp_control_type CP_CONTROL_AEB = {
    .name = "aeb",
    .kind = CP_CONTROL_FUNCTION,
    .what = "automatic emergency braking by time to collision and required deceleration",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .create = create,
    .step = step,
    .counters = counters,
    .destroy = destroy,
};
