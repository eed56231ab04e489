/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_host.h"

#include "control/calm.h"
#include "control/lookout.h"

#include <stdlib.h>

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
    bool is_requesting; /* from the request to the release */
    double since_s;     /* instant of the request */
    double start_s;     /* deceleration begins */
    double calm_since_s;
    bool is_false; /* braking for nothing, until false_until_s */
    double false_until_s;
    double next_false_s;      /* SUMO clock; 0: not drawn yet */
    uint64_t false_occasions; /* drawn so far */
} aeb_car;

typedef struct aeb {
    const double *parameter;
    cp_rng_key key;
    double delay_s; /* from the threat to the first deceleration */
    double release_ttc_s;
} aeb;

static const char *create(const crashpulse_setup *setup, crashpulse_outlook *outlook, void **state)
{
    const double *parameter = setup->parameter;
    aeb *created = calloc(1, sizeof *created);
    if (!created)
        return "out of memory";
    *created = (aeb){.parameter = parameter,
                     .key = {setup->seed},
                     .delay_s = setup->brake_delay_s,
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

static void begin(const aeb *self, aeb_car *car, double instant_s)
{
    car->is_requesting = true;
    car->since_s = instant_s;
    car->start_s = instant_s + self->delay_s;
    car->calm_since_s = INFINITY;
}

// Seeded times of a Poisson process on SUMO's clock, whenever the car came and whatever the step.
static bool is_false_alarm(const aeb *self, const crashpulse_view *view, aeb_car *car,
                           double *instant_s)
{
    double rate_per_h = self->parameter[FALSE_ACTIVATIONS_PER_H];
    double before_s = view->time_s - view->step_s;
    if (rate_per_h <= 0.0)
        return false;
    cp_rng_key key = cp_rng_key_text(cp_rng_key_text(self->key, "false activation"), view->id);
    while (car->next_false_s <= before_s)
        car->next_false_s += cp_rng_exponential(key, car->false_occasions++, 3600.0 / rate_per_h);
    *instant_s = car->next_false_s;
    return car->next_false_s <= view->time_s;
}

// Free driving: whether to request braking.
static void watch(const aeb *self, aeb_car *car, const crashpulse_view *view,
                  crashpulse_request *request)
{
    const double *parameter = self->parameter;
    crashpulse_threat threat;
    double instant_s;
    if (view->speed_m_s < parameter[SPEED_MIN_M_S] || view->speed_m_s > parameter[SPEED_MAX_M_S])
        return;
    if (view->host->threat(view, &threat)) {
        begin(self, car, threat.instant_s);
        car->is_false = false;
        request->target = threat.id;
    } else if (is_false_alarm(self, view, car, &instant_s)) {
        begin(self, car, instant_s);
        car->is_false = true;
        car->false_until_s = car->start_s + parameter[FALSE_DURATION_S];
    }
}

// The request goes on, is withdrawn before deceleration has begun, or ends.
static void follow(const aeb *self, aeb_car *car, const crashpulse_view *view)
{
    crashpulse_threat threat;
    if (car->is_false) {
        car->is_requesting = view->time_s < car->false_until_s;
        return;
    }
    if (view->time_s < car->start_s) {
        car->is_requesting = view->host->threat(view, &threat);
        return;
    }
    bool is_danger = view->speed_m_s >= 0.1 && view->host->is_danger(view, self->release_ttc_s);
    if (cp_is_calm_for(&car->calm_since_s, view->time_s, !is_danger, self->parameter[HOLD_S]))
        car->is_requesting = false;
}

static const char *step(void *state, void *item, const crashpulse_view *view,
                        crashpulse_request *request)
{
    const aeb *self = state;
    aeb_car *car = item;
    // Too slow to act: nothing is looked for, which spares the queues at junctions.
    if (!car->is_requesting && view->speed_m_s < self->parameter[SPEED_MIN_M_S])
        return NULL;
    view->host->look(view, NULL);
    if (car->is_requesting)
        follow(self, car, view);
    else
        watch(self, car, view, request);
    if (car->is_requesting) {
        request->acceleration_m_s2 = -self->parameter[DECELERATION_M_S2];
        request->since_s = car->since_s;
    }
    return NULL;
}

static const crashpulse_function AEB = {
    .abi = CRASHPULSE_FUNCTION_ABI,
    .does = CRASHPULSE_BRAKES,
    .what = "automatic emergency braking by time to collision and required deceleration",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .car_size = sizeof(aeb_car),
    .create = create,
    .step = step,
    .destroy = free,
};

CP_FUNCTION_TYPE(CP_CONTROL_AEB, "aeb", AEB, PARAMETERS,
                 "automatic emergency braking by time to collision and required deceleration",
                 false)
