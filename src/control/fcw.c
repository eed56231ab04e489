/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_host.h"

#include "control/calm.h"
#include "control/lookout.h"

#include <stdlib.h>

/* Forward collision warning. At the first instant inside the step at which a known target is a
 * threat (lookout.h), by default of the same direction or oncoming, the driver is warned; a share
 * of drivers heeds it and brakes after a log-normally distributed reaction time, until the danger
 * has passed. SUMO's driver stays in charge of everything else and may brake earlier or harder.
 *
 * A warning is borne out when the two bodies touch, or one of the two drivers brakes harder than at
 * ease, within the TTC and 2 s more (function_host.c). The own car's braking counts as long as the
 * warned driver does not brake for the warning: with compliance_1 0 the traffic is as without the
 * function, and what is not borne out was for nothing. */

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

enum { HEEDED };
static const char *const COUNTERS[] = {[HEEDED] = "warnings_heeded"};

/* The function, and the warned driver, in one car. */
typedef struct fcw_car {
    bool is_warned; /* from the warning until the danger has passed */
    bool heeds;
    double warned_s;
    double start_s; /* of braking, if he heeds it */
    double calm_since_s;
    uint64_t warnings;
} fcw_car;

typedef struct fcw {
    const double *parameter;
    cp_rng_key key;
    double release_ttc_s;
} fcw;

static const char *create(const crashpulse_setup *setup, crashpulse_outlook *outlook, void **state)
{
    const double *parameter = setup->parameter;
    fcw *created = calloc(1, sizeof *created);
    if (!created)
        return "out of memory";
    *created = (fcw){.parameter = parameter,
                     .key = {setup->seed},
                     .release_ttc_s = fmax(parameter[RELEASE_TTC_S], parameter[TTC_S])};
    *outlook = (crashpulse_outlook){
        .horizon_s =
            fmax(created->release_ttc_s, parameter[TTC_S] + parameter[CONFIRMATION_S] + 0.5),
        .ttc_s = parameter[TTC_S],
        .required_m_s2 = parameter[REQUIRED_M_S2],
        .has_class = {[CRASHPULSE_REAR_END] = parameter[REAR_END_1] >= 0.5,
                      [CRASHPULSE_ONCOMING] = parameter[ONCOMING_1] >= 0.5,
                      [CRASHPULSE_CROSSING] = parameter[CROSSING_1] >= 0.5,
                      [CRASHPULSE_TURNING] = parameter[TURNING_1] >= 0.5},
    };
    *state = created;
    return NULL;
}

// Warn, and see whether and when this driver brakes.
static void watch(const fcw *self, fcw_car *car, const crashpulse_view *view,
                  crashpulse_request *request)
{
    const double *parameter = self->parameter;
    crashpulse_threat threat;
    if (view->speed_m_s < parameter[SPEED_MIN_M_S] || !view->host->threat(view, &threat))
        return;
    cp_rng_key key = cp_rng_key_text(self->key, view->id);
    double reaction_s = parameter[REACTION_MEDIAN_S] *
                        exp(parameter[REACTION_SPREAD_1] *
                            cp_rng_normal(cp_rng_key_text(key, "reaction"), car->warnings++));
    car->is_warned = true;
    car->heeds = cp_rng_uniform(cp_rng_key_text(key, "compliance"), 0) < parameter[COMPLIANCE_1];
    car->warned_s = threat.instant_s + parameter[LATENCY_S];
    car->start_s = car->warned_s + reaction_s;
    car->calm_since_s = INFINITY;
    view->counter[HEEDED] += car->heeds;
    request->target = threat.id;
    request->target_ttc_s = threat.ttc_s;
}

// The danger may also pass before the driver has reacted.
static void follow(const fcw *self, fcw_car *car, const crashpulse_view *view)
{
    bool is_danger = view->speed_m_s >= 0.1 && view->host->is_danger(view, self->release_ttc_s);
    bool has_begun = car->heeds && view->time_s >= car->start_s;
    car->is_warned = has_begun ? !cp_is_calm_for(&car->calm_since_s, view->time_s, !is_danger,
                                                 self->parameter[HOLD_S])
                               : is_danger;
}

static const char *step(void *state, void *item, const crashpulse_view *view,
                        crashpulse_request *request)
{
    const fcw *self = state;
    fcw_car *car = item;
    // Too slow to act: nothing is looked for, which spares the queues at junctions.
    if (!car->is_warned && view->speed_m_s < self->parameter[SPEED_MIN_M_S])
        return NULL;
    view->host->look(view, NULL);
    if (car->is_warned)
        follow(self, car, view);
    else
        watch(self, car, view, request);
    if (car->is_warned)
        request->warned_s = car->warned_s;
    if (car->is_warned && car->heeds) {
        request->acceleration_m_s2 = -self->parameter[DECELERATION_M_S2];
        request->since_s = car->start_s;
    }
    return NULL;
}

static const crashpulse_function FCW = {
    .abi = CRASHPULSE_FUNCTION_ABI,
    .does = CRASHPULSE_WARNS | CRASHPULSE_DRIVER_BRAKES,
    .what = "forward collision warning: the driver brakes after a reaction time",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .counter_names = COUNTERS,
    .counter_count = sizeof COUNTERS / sizeof *COUNTERS,
    .car_size = sizeof(fcw_car),
    .create = create,
    .step = step,
    .destroy = free,
};

CP_FUNCTION_TYPE(CP_CONTROL_FCW, "fcw", FCW, PARAMETERS,
                 "forward collision warning: the driver brakes after a reaction time", false)
