/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control_types.h"

#include "control/driver_error/ignored_foes.h"
#include "control/neighbourhood.h"
#include "core/geometry.h"
#include "core/units.h"

#include <stdlib.h>

/* Red-light running: a seeded share of drivers does not heed the traffic light he comes to while it
 * is red. Some of those who have green do not expect him: one seeded draw per ordered pair. */

enum { PROBABILITY_1, UNAWARE_1, DECISION_M, SPEED_MIN_M_S };

static const cp_control_parameter PARAMETERS[] = {
    [PROBABILITY_1] = {"probability_1", 0.02, 0.0, 1.0,
                       "share of drivers who run red lights, drawn once per vehicle (assumed; not "
                       "calibrated to accident statistics)"},
    [UNAWARE_1] = {"unaware_1", 0.5, 0.0, 1.0,
                   "chance that one driver with green does not expect one particular runner, drawn "
                   "once per ordered pair (assumed)"},
    [DECISION_M] = {"decision_m", 50.0, 5.0, 200.0,
                    "distance to the light from which on it is not heeded, m (assumed)"},
    [SPEED_MIN_M_S] = {"speed_min_m_s", 5.0, 0.0, 50.0,
                       "who comes to the light slower than this heeds it, m/s (assumed)"},
};

/* How far beyond the light a runner is still one, and how far around him others may meet him. */
#define BEYOND_S 5.0
#define AROUND_M 60.0

/* One of those who run red lights. */
typedef struct runner {
    uint32_t vehicle;
    bool is_running;
    uint32_t light;  /* number of the one he runs */
    double passed_s; /* when he was last seen before it */
} runner;

typedef struct red_light {
    const cp_traffic *traffic;
    cp_ignored_foes *ignored;
    cp_neighbourhood neighbourhood;
    runner *runners; /* on the road */
    size_t count, capacity;
    size_t drivers, runs;
} red_light;

static cp_status create(const cp_control_context *context, void **state, cp_error *error)
{
    red_light *created = calloc(1, sizeof *created);
    if (!created)
        return cp_fail_memory(error, "red_light");
    created->traffic = context->traffic;
    created->ignored = context->ignored;
    *state = created;
    return CP_OK;
}

static void destroy(void *state)
{
    red_light *self = state;
    cp_neighbourhood_clear(&self->neighbourhood);
    free(self->runners);
    free(self);
}

// Whether a driver who has come runs red lights.
static cp_status welcome(red_light *self, const cp_control_context *context, uint32_t vehicle,
                         cp_error *error)
{
    cp_rng_key key =
        cp_rng_key_text(context->seed_key, cp_traffic_vehicle_id(self->traffic, vehicle));
    self->drivers++;
    if (cp_rng_uniform(key, 0) >= context->parameter[PROBABILITY_1])
        return CP_OK;
    if (self->count == self->capacity) {
        size_t capacity = self->capacity == 0 ? 16 : 2 * self->capacity;
        runner *runners = realloc(self->runners, capacity * sizeof *runners);
        if (!runners)
            return cp_fail_memory(error, "red_light");
        self->runners = runners;
        self->capacity = capacity;
    }
    self->runners[self->count++] = (runner){.vehicle = vehicle};
    return CP_OK;
}

/* A look for those who may meet a runner. */
typedef struct look {
    red_light *self;
    const cp_control_context *context;
    const cp_vehicle_state *runner;
    cp_status status;
    cp_error *error;
} look;

static void look_at(void *context, const cp_vehicle_motion *motion)
{
    look *looking = context;
    const cp_vehicle_state *other = &motion->after;
    double across_rad = fabs(cp_wrap_angle(other->yaw_rad - looking->runner->yaw_rad));
    if (looking->status != CP_OK || other->vehicle == looking->runner->vehicle ||
        across_rad < CP_PI / 6.0)
        return;
    const cp_traffic *traffic = looking->self->traffic;
    cp_rng_key key =
        cp_rng_key_text(looking->context->seed_key, cp_traffic_vehicle_id(traffic, other->vehicle));
    key = cp_rng_key_text(key, cp_traffic_vehicle_id(traffic, looking->runner->vehicle));
    if (cp_rng_uniform(key, 1) < looking->context->parameter[UNAWARE_1])
        looking->status =
            cp_ignored_foes_add(looking->self->ignored, other->vehicle, looking->runner->vehicle,
                                CP_IGNORE_RED, looking->error);
}

// SUMO's mode 39 heeds neither red nor right of way, but still keeps a safe distance.
static cp_status set_heeds(const red_light *self, uint32_t vehicle, bool heeds, cp_error *error)
{
    return cp_traffic_commands(self->traffic)->set_speed_mode(vehicle, heeds ? 31 : 39, error);
}

// Begin to run a light, go on, or be done with it.
static cp_status step_runner(red_light *self, const cp_control_context *context, runner *own,
                             cp_error *error)
{
    const cp_vehicle_motion *motion = cp_traffic_motion_of(self->traffic, own->vehicle);
    double now_s = cp_traffic_time_s(self->traffic);
    cp_next_light light;
    cp_status status = cp_traffic_next_light(self->traffic, own->vehicle, &light, error);
    if (status != CP_OK)
        return status;
    bool is_at_it = light.distance_m <= context->parameter[DECISION_M];
    if (!own->is_running && is_at_it && light.is_red &&
        motion->after.speed_m_s >= context->parameter[SPEED_MIN_M_S]) {
        own->is_running = true;
        own->light = light.number;
        self->runs++;
        status = set_heeds(self, own->vehicle, false, error);
    }
    if (status != CP_OK || !own->is_running)
        return status;

    if (light.number == own->light && is_at_it)
        own->passed_s = now_s;
    if (now_s - own->passed_s > BEYOND_S) {
        own->is_running = false;
        cp_ignored_foes_heed(self->ignored, own->vehicle, CP_IGNORE_RED);
        return set_heeds(self, own->vehicle, true, error);
    }
    look looking = {self, context, &motion->after, CP_OK, error};
    cp_neighbourhood_visit(&self->neighbourhood, motion->after.front_x_m, motion->after.front_y_m,
                           look_at, &looking);
    return looking.status;
}

static cp_status step(void *state, const cp_control_context *context, cp_error *error)
{
    red_light *self = state;
    if (context->parameter[PROBABILITY_1] <= 0.0)
        return CP_OK;
    size_t kept = 0, count;
    for (size_t k = 0; k < self->count; k++)
        if (cp_traffic_motion_of(self->traffic, self->runners[k].vehicle))
            self->runners[kept++] = self->runners[k];
    self->count = kept;
    const uint32_t *departed = cp_traffic_departed(self->traffic, &count);
    cp_status status = CP_OK;
    for (size_t k = 0; k < count && status == CP_OK; k++)
        if (cp_traffic_motion_of(self->traffic, departed[k]))
            status = welcome(self, context, departed[k], error);
    const cp_vehicle_motion *motions = cp_traffic_motions(self->traffic, &count);
    if (status == CP_OK && self->count > 0)
        status = cp_neighbourhood_fill(&self->neighbourhood, AROUND_M, motions, count, error);
    for (size_t k = 0; k < self->count && status == CP_OK; k++)
        status = step_runner(self, context, &self->runners[k], error);
    return status;
}

static bool is_at_fault(const void *state, uint32_t vehicle)
{
    const red_light *self = state;
    for (size_t k = 0; k < self->count; k++)
        if (self->runners[k].vehicle == vehicle)
            return self->runners[k].is_running;
    return false;
}

static cp_status visit_errors(const void *state, cp_error_visit visit, void *context,
                              cp_error *error)
{
    const red_light *self = state;
    cp_status status = CP_OK;
    for (size_t k = 0; k < self->count && status == CP_OK; k++)
        if (self->runners[k].is_running)
            status = visit(context, self->runners[k].vehicle, CP_EVERYBODY, error);
    return status;
}

static size_t counters(const void *state, const char **names, double *values, size_t room)
{
    const red_light *self = state;
    if (room < 2)
        return 0;
    names[0] = "drivers";
    values[0] = (double)self->drivers;
    names[1] = "red_lights_run";
    values[1] = (double)self->runs;
    return 2;
}

const cp_control_type CP_CONTROL_RED_LIGHT = {
    .name = "red_light",
    .kind = CP_CONTROL_DRIVER_ERROR,
    .what = "a share of drivers runs red lights; some who have green do not expect them",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .create = create,
    .step = step,
    .is_at_fault = is_at_fault,
    .visit_errors = visit_errors,
    .counters = counters,
    .destroy = destroy,
};
