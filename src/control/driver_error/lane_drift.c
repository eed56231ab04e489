/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control_types.h"

#include "control/driver_error/oncoming_reaction.h"
#include "core/geometry.h"
#include "core/units.h"

#include <stdlib.h>
#include <string.h>

/* Inattention with lane drift: at seeded times a driver looks away for some seconds. His car drifts
 * off at a constant angle; when he looks up he steers back. Oncoming drivers react
 * (oncoming_reaction.h). The drift is a lateral overlay (traffic/lateral_overlay.h). An assistance
 * function that takes over the steering ends the error: the driver is alert again and leaves the
 * steering to it. */

enum {
    RATE_PER_H,
    DURATION_MEAN_S,
    DURATION_SD_S,
    LATERAL_MIN_M_S,
    LATERAL_MAX_M_S,
    LEFT_1,
    SPEED_MIN_M_S,
    RETURN_S,
    NOTICE_TTC_S,
    REACTION_MEAN_S,
    REACTION_SD_S,
    REACTION_DECELERATION_M_S2,
    REACTION_JERK_M_S3
};

static const cp_control_parameter PARAMETERS[] = {
    [RATE_PER_H] = {"rate_per_h", 20.0, 0.0, 3600.0,
                    "onsets of inattention per hour on the road (assumed; not calibrated to "
                    "accident statistics)"},
    [DURATION_MEAN_S] = {"duration_mean_s", 5.0, 0.1, 60.0,
                         "how long a driver looks away, s; normal, at least 0.5 s (assumed)"},
    [DURATION_SD_S] = {"duration_sd_s", 2.0, 0.0, 30.0, "its standard deviation, s (assumed)"},
    [LATERAL_MIN_M_S] =
        {"lateral_min_m_s", 0.2, 0.0, 3.0,
         "slowest drift across the lane at the speed of its onset, m/s; uniform up to "
         "lateral_max_m_s (Euro NCAP tests lane keeping at 0.2 to 0.6 m/s)"},
    [LATERAL_MAX_M_S] = {"lateral_max_m_s", 0.6, 0.0, 3.0,
                         "fastest drift across the lane, m/s (Euro NCAP, as above)"},
    [LEFT_1] = {"left_1", 0.5, 0.0, 1.0,
                "share of drifts to the left, in right-hand traffic towards the oncoming "
                "(assumed)"},
    [SPEED_MIN_M_S] = {"speed_min_m_s", 10.0, 0.0, 100.0,
                       "slower drivers, and those inside a junction, do not look away, m/s "
                       "(assumed)"},
    [RETURN_S] =
        {"return_s", 2.5, 0.2, 20.0,
         "from looking up until back in the middle of the lane, s, at the speed of that moment "
         "(assumed)"},
    [NOTICE_TTC_S] = {"notice_ttc_s", 3.0, 0.1, 10.0,
                      "oncoming drivers notice below this time to collision, s (assumed)"},
    [REACTION_MEAN_S] = {"reaction_mean_s", 1.2, 0.1, 5.0,
                         "from noticing to braking, s; normal, 0.5 to 3 s, one draw per driver "
                         "(assumed)"},
    [REACTION_SD_S] = {"reaction_sd_s", 0.3, 0.0, 3.0, "its standard deviation, s (assumed)"},
    [REACTION_DECELERATION_M_S2] = {"reaction_deceleration_m_s2", 7.0, 0.5, 12.0,
                                    "deceleration of those who react, m/s^2 (assumed)"},
    [REACTION_JERK_M_S3] = {"reaction_jerk_m_s3", 30.0, 1.0, 1000.0,
                            "rise of that deceleration, m/s^3 (assumed)"},
};

typedef enum phase { ATTENTIVE, DRIFTING, RETURNING } phase;

/* One driver. */
typedef struct driver {
    uint32_t vehicle;
    uint64_t occasion; /* of the coming onset */
    double onset_s;    /* clock; of the coming or the present drift */
    double look_up_s;
    double slope_1;       /* of the drift, left positive */
    double return_left_m; /* way until back in the lane; < 0 before looking up */
    double asked_slope_1; /* for the end of the step just made */
    phase phase;
} driver;

typedef struct lane_drift {
    const cp_traffic *traffic;
    driver *drivers; /* everybody on the road, by vehicle number ascending */
    size_t count, capacity;
    cp_neighbourhood neighbourhood;
    cp_oncoming_reaction reaction;
    cp_oncoming_reaction_settings reaction_settings;
    size_t onsets, taken_over;
} lane_drift;

static cp_status create(const cp_control_context *context, void **state, cp_error *error)
{
    const double *parameter = context->parameter;
    if (parameter[LATERAL_MAX_M_S] < parameter[LATERAL_MIN_M_S])
        return cp_fail(error, CP_BAD_INPUT,
                       "lane_drift: lateral_max_m_s must be at least lateral_min_m_s (%g), found "
                       "%g",
                       parameter[LATERAL_MIN_M_S], parameter[LATERAL_MAX_M_S]);
    lane_drift *created = calloc(1, sizeof *created);
    if (!created)
        return cp_fail_memory(error, "lane_drift");
    created->traffic = context->traffic;
    created->reaction_settings =
        (cp_oncoming_reaction_settings){.notice_ttc_s = parameter[NOTICE_TTC_S],
                                        .reaction_mean_s = parameter[REACTION_MEAN_S],
                                        .reaction_sd_s = parameter[REACTION_SD_S],
                                        .deceleration_m_s2 = parameter[REACTION_DECELERATION_M_S2],
                                        .jerk_m_s3 = parameter[REACTION_JERK_M_S3]};
    *state = created;
    return CP_OK;
}

static void destroy(void *state)
{
    lane_drift *self = state;
    cp_oncoming_reaction_destroy(&self->reaction);
    cp_neighbourhood_clear(&self->neighbourhood);
    free(self->drivers);
    free(self);
}

// ---- draws: pure functions of driver and occasion ------------------------------------------

static cp_rng_key key_of(const lane_drift *self, const cp_control_context *context,
                         uint32_t vehicle)
{
    return cp_rng_key_text(context->seed_key, cp_traffic_vehicle_id(self->traffic, vehicle));
}

// The next onset after a moment: exponential waiting times.
static void draw_onset(const lane_drift *self, const cp_control_context *context, driver *own,
                       double after_s)
{
    double mean_s = 3600.0 / context->parameter[RATE_PER_H];
    cp_rng_key key = cp_rng_key_text(key_of(self, context, own->vehicle), "onset");
    own->onset_s = after_s + cp_rng_exponential(key, own->occasion, mean_s);
    own->phase = ATTENTIVE;
}

// How this drift goes.
static void draw_drift(const lane_drift *self, const cp_control_context *context, driver *own,
                       double speed_m_s)
{
    const double *parameter = context->parameter;
    cp_rng_key key = cp_rng_key_text(key_of(self, context, own->vehicle), "drift");
    key = cp_rng_key_number(key, own->occasion);
    double duration_s =
        parameter[DURATION_MEAN_S] + parameter[DURATION_SD_S] * cp_rng_normal(key, 0);
    double span_m_s = parameter[LATERAL_MAX_M_S] - parameter[LATERAL_MIN_M_S];
    double rate_m_s = parameter[LATERAL_MIN_M_S] + span_m_s * cp_rng_uniform(key, 1);
    own->slope_1 = (cp_rng_uniform(key, 2) < parameter[LEFT_1] ? rate_m_s : -rate_m_s) / speed_m_s;
    own->look_up_s = own->onset_s + fmax(duration_s, 0.5);
}

// ---- who is on the road --------------------------------------------------------------------

static cp_status welcome(lane_drift *self, const cp_control_context *context, uint32_t vehicle,
                         cp_error *error)
{
    if (self->count == self->capacity) {
        size_t capacity = self->capacity == 0 ? 64 : 2 * self->capacity;
        driver *drivers = realloc(self->drivers, capacity * sizeof *drivers);
        if (!drivers)
            return cp_fail_memory(error, "lane_drift");
        self->drivers = drivers;
        self->capacity = capacity;
    }
    driver *own = &self->drivers[self->count++];
    *own = (driver){.vehicle = vehicle};
    draw_onset(self, context, own, cp_traffic_time_s(self->traffic));
    return CP_OK;
}

// Take up those who have come and forget those who have gone (a teleport in between forgets
// nobody's draws: they depend on id and occasion only).
static cp_status update_drivers(lane_drift *self, const cp_control_context *context,
                                cp_error *error)
{
    size_t kept = 0;
    for (size_t k = 0; k < self->count; k++)
        if (cp_traffic_motion_of(self->traffic, self->drivers[k].vehicle) != NULL)
            self->drivers[kept++] = self->drivers[k];
    self->count = kept;
    size_t count;
    const uint32_t *departed = cp_traffic_departed(self->traffic, &count);
    cp_status status = CP_OK;
    for (size_t k = 0; k < count && status == CP_OK; k++)
        if (cp_traffic_motion_of(self->traffic, departed[k]) != NULL)
            status = welcome(self, context, departed[k], error);
    return status;
}

// ---- drifting ------------------------------------------------------------------------------

static bool may_look_away(const cp_control_context *context, const cp_vehicle_motion *motion)
{
    return motion->after.speed_m_s >= context->parameter[SPEED_MIN_M_S] &&
           !motion->after.is_in_junction;
}

static cp_lateral_overlay overlay_of(const lane_drift *self, const driver *own)
{
    return cp_lateral_overlay_get(cp_traffic_overlays(self->traffic), own->vehicle);
}

// A driver whose onset has come looks away, if the road allows; the occasion is used up either way.
static void begin(lane_drift *self, const cp_control_context *context, driver *own,
                  const cp_vehicle_motion *motion)
{
    if (may_look_away(context, motion)) {
        draw_drift(self, context, own, motion->after.speed_m_s);
        own->phase = DRIFTING;
        own->asked_slope_1 = overlay_of(self, own).slope_1;
        self->onsets++;
        return;
    }
    double passed_s = own->onset_s;
    own->occasion++;
    draw_onset(self, context, own, passed_s);
}

// Looking away: straight on at the drift's angle, from the moment of the onset.
static cp_status drift(lane_drift *self, driver *own, double now_s, double step_s, cp_error *error)
{
    double share_1 = fmin(1.0, (now_s + step_s - own->onset_s) / step_s);
    own->asked_slope_1 = own->slope_1;
    return cp_lateral_overlay_steer(cp_traffic_overlays(self->traffic), own->vehicle,
                                    share_1 * own->slope_1, own->slope_1, error);
}

// Alert again: back to the middle of the lane.
static cp_status steer_back(lane_drift *self, const cp_control_context *context, driver *own,
                            double speed_m_s, double now_s, double step_s, cp_error *error)
{
    cp_lateral_overlays *overlays = cp_traffic_overlays(self->traffic);
    cp_lateral_overlay now = cp_lateral_overlay_get(overlays, own->vehicle);
    if (own->phase == DRIFTING) {
        own->phase = RETURNING;
        // A slow car needs its way too: some 11 degrees off the lane at most.
        own->return_left_m =
            fmax(speed_m_s * context->parameter[RETURN_S], 8.0 * fabs(now.offset_m) + 1.0);
    }
    if (own->return_left_m <= 0.0) {
        cp_lateral_overlay_end(overlays, own->vehicle);
        own->occasion++;
        draw_onset(self, context, own, now_s);
        return CP_OK;
    }
    double way_m = speed_m_s * step_s, mean_slope_1;
    cp_lateral_overlay_return(now, own->return_left_m, way_m, &mean_slope_1, &own->asked_slope_1);
    own->return_left_m -= way_m;
    return cp_lateral_overlay_steer(overlays, own->vehicle, mean_slope_1, own->asked_slope_1,
                                    error);
}

static cp_status step_driver(lane_drift *self, const cp_control_context *context, driver *own,
                             cp_error *error)
{
    const cp_vehicle_motion *motion = cp_traffic_motion_of(self->traffic, own->vehicle);
    double step_s = cp_traffic_step_length_s(self->traffic);
    double now_s = cp_traffic_time_s(self->traffic);
    while (own->phase == ATTENTIVE && own->onset_s < now_s + step_s)
        begin(self, context, own, motion);
    if (own->phase == ATTENTIVE)
        return CP_OK;

    // Somebody else has steered since: the error is over, and the steering is his.
    if (overlay_of(self, own).slope_1 != own->asked_slope_1) {
        self->taken_over++;
        own->occasion++;
        draw_onset(self, context, own, now_s);
        return CP_OK;
    }
    return now_s < own->look_up_s
               ? drift(self, own, now_s, step_s, error)
               : steer_back(self, context, own, motion->after.speed_m_s, now_s, step_s, error);
}

// Those who come towards a drifting car notice it and react.
static cp_status react(lane_drift *self, const cp_control_context *context, cp_error *error)
{
    size_t count, drifting = 0;
    const cp_vehicle_motion *motions = cp_traffic_motions(self->traffic, &count);
    double fastest_m_s = 1.0;
    for (size_t k = 0; k < count; k++)
        fastest_m_s = fmax(fastest_m_s, motions[k].after.speed_m_s);
    for (size_t k = 0; k < self->count; k++)
        drifting += self->drivers[k].phase != ATTENTIVE;
    cp_status status = CP_OK;
    if (drifting > 0) {
        double reach_m = 2.0 * fastest_m_s * context->parameter[NOTICE_TTC_S] + 20.0;
        status = cp_neighbourhood_fill(&self->neighbourhood, reach_m, motions, count, error);
    }
    for (size_t k = 0; k < self->count && status == CP_OK; k++)
        if (self->drivers[k].phase != ATTENTIVE)
            status = cp_oncoming_reaction_notice(
                &self->reaction, &self->reaction_settings, self->traffic, &self->neighbourhood,
                context->view, self->drivers[k].vehicle, context->seed_key, error);
    if (status == CP_OK)
        status = cp_oncoming_reaction_step(&self->reaction, &self->reaction_settings, self->traffic,
                                           context->actuation, error);
    return status;
}

static cp_status step(void *state, const cp_control_context *context, cp_error *error)
{
    lane_drift *self = state;
    if (context->parameter[RATE_PER_H] <= 0.0)
        return CP_OK;
    cp_status status = update_drivers(self, context, error);
    for (size_t k = 0; k < self->count && status == CP_OK; k++)
        status = step_driver(self, context, &self->drivers[k], error);
    return status == CP_OK ? react(self, context, error) : status;
}

// At fault now: off his path.
static bool is_at_fault(const void *state, uint32_t vehicle)
{
    const lane_drift *self = state;
    for (size_t k = 0; k < self->count; k++)
        if (self->drivers[k].vehicle == vehicle)
            return self->drivers[k].phase != ATTENTIVE;
    return false;
}

static cp_status visit_errors(const void *state, cp_error_visit visit, void *context,
                              cp_error *error)
{
    const lane_drift *self = state;
    cp_status status = CP_OK;
    for (size_t k = 0; k < self->count && status == CP_OK; k++)
        if (self->drivers[k].phase != ATTENTIVE)
            status = visit(context, self->drivers[k].vehicle, CP_EVERYBODY, error);
    return status;
}

static size_t counters(const void *state, const char **names, double *values, size_t room)
{
    const lane_drift *self = state;
    if (room < 3)
        return 0;
    names[0] = "drifts";
    values[0] = (double)self->onsets;
    names[1] = "taken_over";
    values[1] = (double)self->taken_over;
    names[2] = "reactions_of_oncoming";
    values[2] = (double)self->reaction.reactions;
    return 3;
}

const cp_control_type CP_CONTROL_LANE_DRIFT = {
    .name = "lane_drift",
    .kind = CP_CONTROL_DRIVER_ERROR,
    .what = "inattention: the car drifts off its lane until the driver looks up; oncoming drivers "
            "brake",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .create = create,
    .step = step,
    .is_at_fault = is_at_fault,
    .visit_errors = visit_errors,
    .counters = counters,
    .destroy = destroy,
};
