/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control_types.h"

#include "control/brake.h"
#include "control/neighbourhood.h"
#include "control/road_view.h"
#include "core/geometry.h"
#include "core/units.h"

#include <stdlib.h>

/* Late and weak braking: at seeded times a driver does not see for a while what happens ahead of
 * him and keeps his speed, through red lights too; when he looks up he brakes, weaker than the car
 * could, until the danger is over. */

enum { RATE_PER_H, DURATION_MEAN_S, DURATION_SD_S, DECELERATION_M_S2, JERK_M_S3, SPEED_MIN_M_S };

static const cp_control_parameter PARAMETERS[] = {
    [RATE_PER_H] = {"rate_per_h", 20.0, 0.0, 3600.0,
                    "onsets per hour on the road (assumed; not calibrated to accident statistics)"},
    [DURATION_MEAN_S] =
        {"duration_mean_s", 2.0, 0.1, 60.0,
         "how long a driver does not look ahead, s; normal, at least 0.5 s (glances "
         "of 2 s and more are the ones that matter; assumed)"},
    [DURATION_SD_S] = {"duration_sd_s", 0.7, 0.0, 30.0, "its standard deviation, s (assumed)"},
    [DECELERATION_M_S2] = {"deceleration_m_s2", 5.0, 0.5, 12.0,
                           "how hard he brakes when he looks up to a danger, m/s^2 (assumed)"},
    [JERK_M_S3] = {"jerk_m_s3", 20.0, 1.0, 1000.0, "rise of that deceleration, m/s^3 (assumed)"},
    [SPEED_MIN_M_S] = {"speed_min_m_s", 5.0, 0.0, 100.0,
                       "slower drivers look ahead, m/s (assumed)"},
};

/* A collision course within this time is a danger; nobody brakes on after it has been over for so
 * long. */
#define DANGER_S 4.0
#define CALM_S 0.5

typedef enum phase { LOOKING, BLIND, BRAKING } phase;

/* One driver. */
typedef struct driver {
    uint32_t vehicle;
    uint64_t occasion; /* of the coming onset */
    double onset_s, look_up_s;
    double held_m_s;          /* speed while blind */
    double commanded_until_s; /* speed loss up to here has been commanded */
    double danger_seen_s;
    phase phase;
} driver;

typedef struct late_braking {
    const cp_traffic *traffic;
    driver *drivers; /* on the road */
    size_t count, capacity;
    cp_neighbourhood neighbourhood;
    size_t onsets, braked_late;
} late_braking;

static cp_status create(const cp_control_context *context, void **state, cp_error *error)
{
    late_braking *created = calloc(1, sizeof *created);
    if (!created)
        return cp_fail_memory(error, "late_braking");
    created->traffic = context->traffic;
    *state = created;
    return CP_OK;
}

static void destroy(void *state)
{
    late_braking *self = state;
    cp_neighbourhood_clear(&self->neighbourhood);
    free(self->drivers);
    free(self);
}

static cp_rng_key key_of(const late_braking *self, const cp_control_context *context,
                         uint32_t vehicle, const char *what)
{
    cp_rng_key key =
        cp_rng_key_text(context->seed_key, cp_traffic_vehicle_id(self->traffic, vehicle));
    return cp_rng_key_text(key, what);
}

// The next onset after a moment: exponential waiting times.
static void draw_onset(const late_braking *self, const cp_control_context *context, driver *own,
                       double after_s)
{
    cp_rng_key key = key_of(self, context, own->vehicle, "onset");
    double mean_s = 3600.0 / context->parameter[RATE_PER_H];
    own->onset_s = after_s + cp_rng_exponential(key, own->occasion, mean_s);
    own->phase = LOOKING;
}

static cp_status welcome(late_braking *self, const cp_control_context *context, uint32_t vehicle,
                         cp_error *error)
{
    if (self->count == self->capacity) {
        size_t capacity = self->capacity == 0 ? 64 : 2 * self->capacity;
        driver *drivers = realloc(self->drivers, capacity * sizeof *drivers);
        if (!drivers)
            return cp_fail_memory(error, "late_braking");
        self->drivers = drivers;
        self->capacity = capacity;
    }
    driver *own = &self->drivers[self->count++];
    *own = (driver){.vehicle = vehicle};
    draw_onset(self, context, own, cp_traffic_time_s(self->traffic));
    return CP_OK;
}

// The onset has come: look away, if there is speed; the occasion is used up either way.
static cp_status begin(late_braking *self, const cp_control_context *context, driver *own,
                       double speed_m_s, cp_error *error)
{
    const double *parameter = context->parameter;
    double onset_s = own->onset_s;
    if (speed_m_s < parameter[SPEED_MIN_M_S]) {
        own->occasion++;
        draw_onset(self, context, own, onset_s);
        return CP_OK;
    }
    cp_rng_key key = key_of(self, context, own->vehicle, "duration");
    double duration_s =
        parameter[DURATION_MEAN_S] + parameter[DURATION_SD_S] * cp_rng_normal(key, own->occasion);
    own->phase = BLIND;
    own->held_m_s = speed_m_s;
    own->look_up_s = onset_s + fmax(duration_s, 0.5);
    self->onsets++;
    // SUMO's mode 24: right of way only; nothing that lies ahead.
    return cp_traffic_commands(self->traffic)->set_speed_mode(own->vehicle, 24, error);
}

static cp_status end(late_braking *self, const cp_control_context *context, driver *own,
                     cp_error *error)
{
    const cp_traffic_source *commands = cp_traffic_commands(self->traffic);
    own->occasion++;
    draw_onset(self, context, own, cp_traffic_time_s(self->traffic));
    cp_status status = commands->set_speed(own->vehicle, -1.0, error);
    // Mode 27 and not 31: the same while nobody commands a speed, and leaves a function that brakes
    // this car its deceleration.
    return status == CP_OK ? commands->set_speed_mode(own->vehicle, 27, error) : status;
}

/* A look ahead. */
typedef struct look {
    cp_road_view *view;
    const cp_vehicle_motion *own;
    bool is_danger;
    cp_status status;
    cp_error *error;
} look;

static void look_at(void *context, const cp_vehicle_motion *motion)
{
    look *looking = context;
    double time_s;
    if (looking->is_danger || looking->status != CP_OK ||
        motion->after.vehicle == looking->own->after.vehicle)
        return;
    looking->status =
        cp_road_view_ttc_s(looking->view, looking->own, motion, DANGER_S, &time_s, looking->error);
    looking->is_danger = looking->status == CP_OK && time_s < DANGER_S;
}

// Brake as the profile asks from looking up on.
static cp_status brake(late_braking *self, const cp_control_context *context, driver *own,
                       double speed_m_s, cp_error *error)
{
    double end_s = cp_traffic_time_s(self->traffic) + cp_traffic_step_length_s(self->traffic);
    cp_brake profile = {own->look_up_s, context->parameter[JERK_M_S3],
                        context->parameter[DECELERATION_M_S2], 0.0};
    double loss_m_s = cp_brake_speed_loss_m_s(&profile, end_s) -
                      cp_brake_speed_loss_m_s(&profile, own->commanded_until_s);
    own->commanded_until_s = end_s;
    return cp_traffic_commands(self->traffic)
        ->set_speed(own->vehicle, fmax(speed_m_s - loss_m_s, 0.0), error);
}

static cp_status step_driver(late_braking *self, const cp_control_context *context, driver *own,
                             cp_error *error)
{
    const cp_vehicle_motion *motion = cp_traffic_motion_of(self->traffic, own->vehicle);
    const cp_vehicle_state *state = &motion->after;
    double now_s = cp_traffic_time_s(self->traffic);
    double end_s = now_s + cp_traffic_step_length_s(self->traffic);
    cp_status status = CP_OK;
    while (status == CP_OK && own->phase == LOOKING && own->onset_s < end_s)
        status = begin(self, context, own, state->speed_m_s, error);
    if (status != CP_OK || own->phase == LOOKING)
        return status;
    // Somebody else has braked the car: that wakes him.
    if (own->phase == BLIND && state->speed_m_s < own->held_m_s - 0.5)
        return end(self, context, own, error);
    if (own->phase == BLIND && own->look_up_s >= end_s)
        return cp_traffic_commands(self->traffic)->set_speed(own->vehicle, own->held_m_s, error);

    // Eyes up: is there danger? Then brake; else it is over.
    if (own->phase == BLIND) {
        own->phase = BRAKING;
        own->commanded_until_s = own->look_up_s;
        own->danger_seen_s = -INFINITY;
    }
    look looking = {context->view, motion, false, CP_OK, error};
    cp_neighbourhood_visit(&self->neighbourhood, state->front_x_m, state->front_y_m, look_at,
                           &looking);
    if (looking.status != CP_OK)
        return looking.status;
    if (looking.is_danger) {
        self->braked_late += own->danger_seen_s == -INFINITY;
        own->danger_seen_s = now_s;
    }
    if (now_s - own->danger_seen_s > CALM_S || state->speed_m_s < 0.1)
        return end(self, context, own, error);
    return brake(self, context, own, state->speed_m_s, error);
}

static cp_status step(void *state, const cp_control_context *context, cp_error *error)
{
    late_braking *self = state;
    if (context->parameter[RATE_PER_H] <= 0.0)
        return CP_OK;
    size_t kept = 0, count;
    for (size_t k = 0; k < self->count; k++)
        if (cp_traffic_motion_of(self->traffic, self->drivers[k].vehicle))
            self->drivers[kept++] = self->drivers[k];
    self->count = kept;
    const uint32_t *departed = cp_traffic_departed(self->traffic, &count);
    cp_status status = CP_OK;
    for (size_t k = 0; k < count && status == CP_OK; k++)
        if (cp_traffic_motion_of(self->traffic, departed[k]))
            status = welcome(self, context, departed[k], error);
    const cp_vehicle_motion *motions = cp_traffic_motions(self->traffic, &count);
    double fastest_m_s = 1.0;
    for (size_t k = 0; k < count; k++)
        fastest_m_s = fmax(fastest_m_s, motions[k].after.speed_m_s);
    if (status == CP_OK)
        status = cp_neighbourhood_fill(&self->neighbourhood, 2.0 * fastest_m_s * DANGER_S + 20.0,
                                       motions, count, error);
    for (size_t k = 0; k < self->count && status == CP_OK; k++)
        status = step_driver(self, context, &self->drivers[k], error);
    return status;
}

static bool is_at_fault(const void *state, uint32_t vehicle)
{
    const late_braking *self = state;
    for (size_t k = 0; k < self->count; k++)
        if (self->drivers[k].vehicle == vehicle)
            return self->drivers[k].phase != LOOKING;
    return false;
}

static cp_status visit_errors(const void *state, cp_error_visit visit, void *context,
                              cp_error *error)
{
    const late_braking *self = state;
    cp_status status = CP_OK;
    for (size_t k = 0; k < self->count && status == CP_OK; k++)
        if (self->drivers[k].phase != LOOKING)
            status = visit(context, self->drivers[k].vehicle, CP_EVERYBODY, error);
    return status;
}

static size_t counters(const void *state, const char **names, double *values, size_t room)
{
    const late_braking *self = state;
    if (room < 2)
        return 0;
    names[0] = "glances";
    values[0] = (double)self->onsets;
    names[1] = "braked_late";
    values[1] = (double)self->braked_late;
    return 2;
}

const cp_control_type CP_CONTROL_LATE_BRAKING = {
    .name = "late_braking",
    .kind = CP_CONTROL_DRIVER_ERROR,
    .what = "a driver does not look ahead for a while and then brakes late and weakly",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .create = create,
    .step = step,
    .is_at_fault = is_at_fault,
    .visit_errors = visit_errors,
    .counters = counters,
    .destroy = destroy,
};
