/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control_types.h"

#include "control/driver_error/ignored_foes.h"
#include "control/neighbourhood.h"
#include "core/geometry.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* "Looked but failed to see": for every ordered pair of vehicles on the road at the same time one
 * seeded draw decides whether the first overlooks the second at junctions for as long as both are
 * there. SUMO's own per-step knobs (jmIgnoreFoeProb) are drawn again in every step, so that their
 * effect would depend on the step length.
 *
 * The draw is made long before it matters. The error towards one other begins when the driver goes
 * on, or sets off, although the other is near or would be there within a driver's time to react; it
 * ends when he stands or the other has gone by. */

#define NEAR_M 15.0 /* front to front: a car's length and two steps */
#define AHEAD_S 3.0 /* he who drives sees what would be there within this (assumed) */
#define STANDS_M_S 0.1

enum { PROBABILITY_1 };

static const cp_control_parameter PARAMETERS[] = {
    [PROBABILITY_1] = {"probability_1", 0.1, 0.0, 1.0,
                       "chance that one driver overlooks one particular other at a junction, drawn "
                       "once per ordered pair (assumed; not calibrated to accident statistics)"},
};

/* An error towards one other at work. */
typedef struct encounter {
    uint32_t ego, foe;
    double since_s;
} encounter;

typedef struct failed_to_see {
    const cp_traffic *traffic;
    cp_ignored_foes *ignored;
    encounter *encounters, *before; /* at work now, and before the last step */
    size_t encounter_count, encounter_capacity, before_count, before_capacity;
    bool *is_known; /* by vehicle number: drawn against all others on the road */
    size_t numbers;
    size_t pairs;      /* drawn */
    size_t overlooked; /* of these, true */
} failed_to_see;

static cp_status create(const cp_control_context *context, void **state, cp_error *error)
{
    failed_to_see *created = calloc(1, sizeof *created);
    if (!created)
        return cp_fail_memory(error, "failed_to_see");
    created->traffic = context->traffic;
    created->ignored = context->ignored;
    *state = created;
    return CP_OK;
}

static void destroy(void *state)
{
    failed_to_see *self = state;
    free(self->encounters);
    free(self->before);
    free(self->is_known);
    free(self);
}

static cp_status reserve(failed_to_see *self, uint32_t vehicle, cp_error *error)
{
    if (vehicle < self->numbers)
        return CP_OK;
    size_t numbers = 2 * ((size_t)vehicle + 1);
    bool *is_known = realloc(self->is_known, numbers * sizeof *is_known);
    if (!is_known)
        return cp_fail_memory(error, "failed_to_see");
    memset(&is_known[self->numbers], 0, (numbers - self->numbers) * sizeof *is_known);
    self->is_known = is_known;
    self->numbers = numbers;
    return CP_OK;
}

// One draw: does ego overlook foe?
static cp_status draw_pair(failed_to_see *self, const cp_control_context *context, uint32_t ego,
                           uint32_t foe, cp_error *error)
{
    cp_rng_key key = cp_rng_key_text(context->seed_key, cp_traffic_vehicle_id(self->traffic, ego));
    key = cp_rng_key_text(key, cp_traffic_vehicle_id(self->traffic, foe));
    self->pairs++;
    if (cp_rng_uniform(key, 0) >= context->parameter[PROBABILITY_1])
        return CP_OK;
    self->overlooked++;
    return cp_ignored_foes_add(self->ignored, ego, foe, CP_IGNORE_UNSEEN, error);
}

// A vehicle has come: draw it against everybody known, both ways.
static cp_status meet(failed_to_see *self, const cp_control_context *context, uint32_t comer,
                      cp_error *error)
{
    size_t count;
    const cp_vehicle_motion *motions = cp_traffic_motions(self->traffic, &count);
    for (size_t k = 0; k < count; k++) {
        uint32_t other = motions[k].after.vehicle;
        if (other >= self->numbers || !self->is_known[other])
            continue;
        cp_status status = draw_pair(self, context, comer, other, error);
        if (status == CP_OK)
            status = draw_pair(self, context, other, comer, error);
        if (status != CP_OK)
            return status;
    }
    self->is_known[comer] = true;
    return CP_OK;
}

// ---- errors at work ------------------------------------------------------------------------

// Front to front.
static bool is_nearer(const cp_vehicle_motion *one, const cp_vehicle_motion *other, double than_m)
{
    return cp_front_distance_m2(one, other) < than_m * than_m;
}

/* A look of one driver for those he overlooks. */
typedef struct look {
    failed_to_see *self;
    const cp_vehicle_motion *own;
    cp_status status;
    cp_error *error;
} look;

// Since when; now if it has just begun.
static double since_s(const failed_to_see *self, uint32_t ego, uint32_t foe)
{
    for (size_t k = 0; k < self->before_count; k++)
        if (self->before[k].ego == ego && self->before[k].foe == foe)
            return self->before[k].since_s;
    return cp_traffic_time_s(self->traffic);
}

static void look_for_error(void *context, uint32_t foe_vehicle)
{
    look *looking = context;
    failed_to_see *self = looking->self;
    const cp_vehicle_motion *foe = cp_traffic_motion_of(self->traffic, foe_vehicle);
    if (looking->status != CP_OK || !foe ||
        !is_nearer(looking->own, foe, NEAR_M + AHEAD_S * foe->after.speed_m_s))
        return;
    if (self->encounter_count == self->encounter_capacity) {
        size_t capacity = self->encounter_capacity == 0 ? 64 : 2 * self->encounter_capacity;
        encounter *encounters = realloc(self->encounters, capacity * sizeof *encounters);
        if (!encounters) {
            looking->status = cp_fail_memory(looking->error, "failed_to_see");
            return;
        }
        self->encounters = encounters;
        self->encounter_capacity = capacity;
    }
    uint32_t ego = looking->own->after.vehicle;
    self->encounters[self->encounter_count++] =
        (encounter){ego, foe_vehicle, since_s(self, ego, foe_vehicle)};
}

// The errors at work after the step that has just been made.
static cp_status note_errors(failed_to_see *self, cp_error *error)
{
    encounter *spare = self->before;
    size_t spare_capacity = self->before_capacity, count;
    self->before = self->encounters;
    self->before_count = self->encounter_count;
    self->before_capacity = self->encounter_capacity;
    self->encounters = spare;
    self->encounter_count = 0;
    self->encounter_capacity = spare_capacity;

    const cp_vehicle_motion *motions = cp_traffic_motions(self->traffic, &count);
    cp_status status = CP_OK;
    for (size_t k = 0; k < count && status == CP_OK; k++) {
        look looking = {self, &motions[k], CP_OK, error};
        if (motions[k].after.speed_m_s >= STANDS_M_S)
            cp_ignored_foes_visit(self->ignored, motions[k].after.vehicle, CP_IGNORE_UNSEEN,
                                  look_for_error, &looking);
        status = looking.status;
    }
    return status;
}

static cp_status step(void *state, const cp_control_context *context, cp_error *error)
{
    failed_to_see *self = state;
    if (context->parameter[PROBABILITY_1] <= 0.0)
        return CP_OK;
    size_t count;
    const uint32_t *departed = cp_traffic_departed(self->traffic, &count);
    for (size_t k = 0; k < count; k++) {
        if (!cp_traffic_motion_of(self->traffic, departed[k]))
            continue; // gone again within the step
        cp_status status = reserve(self, departed[k], error);
        if (status == CP_OK)
            status = meet(self, context, departed[k], error);
        if (status != CP_OK)
            return status;
    }
    return note_errors(self, error);
}

/* Whether one of those a driver overlooks is near him. */
typedef struct nearby {
    const cp_traffic *traffic;
    const cp_vehicle_motion *own;
    bool is_near;
} nearby;

static void look_at(void *context, uint32_t foe_vehicle)
{
    nearby *found = context;
    const cp_vehicle_motion *foe = cp_traffic_motion_of(found->traffic, foe_vehicle);
    found->is_near |= foe && is_nearer(found->own, foe, NEAR_M);
}

// At fault now: somebody overlooked is right before or beside the car.
static bool is_at_fault(const void *state, uint32_t vehicle)
{
    const failed_to_see *self = state;
    nearby found = {self->traffic, cp_traffic_motion_of(self->traffic, vehicle), false};
    if (found.own)
        cp_ignored_foes_visit(self->ignored, vehicle, CP_IGNORE_UNSEEN, look_at, &found);
    return found.is_near;
}

static double error_since_s(const void *state, uint32_t vehicle, uint32_t other)
{
    const failed_to_see *self = state;
    for (size_t k = 0; k < self->encounter_count; k++)
        if (self->encounters[k].ego == vehicle && self->encounters[k].foe == other)
            return self->encounters[k].since_s;
    return INFINITY;
}

static cp_status visit_errors(const void *state, cp_error_visit visit, void *context,
                              cp_error *error)
{
    const failed_to_see *self = state;
    cp_status status = CP_OK;
    for (size_t k = 0; k < self->encounter_count && status == CP_OK; k++)
        status = visit(context, self->encounters[k].ego, self->encounters[k].foe, error);
    return status;
}

static size_t counters(const void *state, const char **names, double *values, size_t room)
{
    const failed_to_see *self = state;
    if (room < 2)
        return 0;
    names[0] = "pairs";
    values[0] = (double)self->pairs;
    names[1] = "overlooked_pairs";
    values[1] = (double)self->overlooked;
    return 2;
}

const cp_control_type CP_CONTROL_FAILED_TO_SEE = {
    .name = "failed_to_see",
    .kind = CP_CONTROL_DRIVER_ERROR,
    .what = "looked but failed to see: a driver overlooks particular others at junctions",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .create = create,
    .step = step,
    .is_at_fault = is_at_fault,
    .error_since_s = error_since_s,
    .visit_errors = visit_errors,
    .counters = counters,
    .destroy = destroy,
};
