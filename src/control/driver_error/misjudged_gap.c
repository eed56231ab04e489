/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control_types.h"

#include "control/driver_error/ignored_foes.h"
#include "control/neighbourhood.h"
#include "control/road_view.h"
#include "core/geometry.h"
#include "core/units.h"

#include <math.h>
#include <stdlib.h>

/* Misjudged gap: a driver at a junction sees the other coming and takes the gap for large enough
 * although it is not. One seeded draw per ordered pair decides whether the first misjudges the
 * second; if so, he pays no heed to him once the other's time to arrive lies in the range in which
 * gaps are misjudged, until the other has passed. A gap shorter than that range is too short to be
 * taken by anybody; failed_to_see is the error of those who take it. */

enum { PROBABILITY_1, GAP_MIN_S, GAP_MAX_S, HOLD_S };

static const cp_control_parameter PARAMETERS[] = {
    [PROBABILITY_1] =
        {"probability_1", 0.1, 0.0, 1.0,
         "chance that one driver misjudges the gap before one particular other, drawn "
         "once per ordered pair (assumed; not calibrated to accident statistics)"},
    [GAP_MIN_S] = {"gap_min_s", 1.5, 0.0, 20.0,
                   "shorter gaps are not taken, s until the other's front is where the driver's is "
                   "(assumed)"},
    [GAP_MAX_S] =
        {"gap_max_s", 4.0, 0.1, 20.0,
         "the misjudged gap begins below this, s; critical gaps of left turns are 4 to 5 s "
         "(assumed)"},
    [HOLD_S] = {"hold_s", 6.0, 0.1, 60.0,
                "how long the driver stays with his decision, s (assumed)"},
};

/* A decision that holds. */
typedef struct decision {
    uint32_t ego, foe;
    double since_s;
    double until_s;
} decision;

typedef struct misjudged_gap {
    const cp_traffic *traffic;
    cp_ignored_foes *ignored;
    cp_neighbourhood neighbourhood;
    decision *decisions;
    size_t count, capacity;
    size_t taken; /* so far */
} misjudged_gap;

static cp_status create(const cp_control_context *context, void **state, cp_error *error)
{
    const double *parameter = context->parameter;
    if (parameter[GAP_MAX_S] <= parameter[GAP_MIN_S])
        return cp_fail(error, CP_BAD_INPUT,
                       "misjudged_gap: gap_max_s must be above gap_min_s (%g), found %g",
                       parameter[GAP_MIN_S], parameter[GAP_MAX_S]);
    misjudged_gap *created = calloc(1, sizeof *created);
    if (!created)
        return cp_fail_memory(error, "misjudged_gap");
    created->traffic = context->traffic;
    created->ignored = context->ignored;
    *state = created;
    return CP_OK;
}

static void destroy(void *state)
{
    misjudged_gap *self = state;
    cp_neighbourhood_clear(&self->neighbourhood);
    free(self->decisions);
    free(self);
}

static bool is_decided(const misjudged_gap *self, uint32_t ego, uint32_t foe)
{
    for (size_t k = 0; k < self->count; k++)
        if (self->decisions[k].ego == ego && self->decisions[k].foe == foe)
            return true;
    return false;
}

static cp_status decide(misjudged_gap *self, const cp_control_context *context, uint32_t ego,
                        uint32_t foe, cp_error *error)
{
    if (self->count == self->capacity) {
        size_t capacity = self->capacity == 0 ? 16 : 2 * self->capacity;
        decision *decisions = realloc(self->decisions, capacity * sizeof *decisions);
        if (!decisions)
            return cp_fail_memory(error, "misjudged_gap");
        self->decisions = decisions;
        self->capacity = capacity;
    }
    double now_s = cp_traffic_time_s(self->traffic);
    self->decisions[self->count++] =
        (decision){ego, foe, now_s, now_s + context->parameter[HOLD_S]};
    self->taken++;
    return cp_ignored_foes_add(self->ignored, ego, foe, CP_IGNORE_MISJUDGED, error);
}

// Decisions that have run their time, or whose vehicles have gone, are over.
static void forget(misjudged_gap *self)
{
    double now_s = cp_traffic_time_s(self->traffic);
    size_t kept = 0;
    for (size_t k = 0; k < self->count; k++) {
        decision own = self->decisions[k];
        bool is_over = now_s >= own.until_s || !cp_traffic_motion_of(self->traffic, own.ego) ||
                       !cp_traffic_motion_of(self->traffic, own.foe);
        if (is_over)
            cp_ignored_foes_take_back(self->ignored, own.ego, own.foe, CP_IGNORE_MISJUDGED);
        else
            self->decisions[kept++] = own;
    }
    self->count = kept;
}

/* A look for those who come. */
typedef struct look {
    misjudged_gap *self;
    const cp_control_context *context;
    const cp_vehicle_state *ego;
    const cp_vehicle_motion *motion; /* his */
    cp_status status;
    cp_error *error;
} look;

// Whether the gap before the other is one that can be misjudged: he comes from ahead or the side,
// towards here, and his time to arrive lies in the range.
static bool is_candidate(const look *looking, const cp_vehicle_state *foe)
{
    const double *parameter = looking->context->parameter;
    if (foe->speed_m_s < 3.0)
        return false;
    cp_vec2 way = {looking->ego->front_x_m - foe->front_x_m,
                   looking->ego->front_y_m - foe->front_y_m};
    double distance_m = cp_vec2_length(way);
    double arrival_s = distance_m / foe->speed_m_s;
    if (arrival_s < parameter[GAP_MIN_S] || arrival_s >= parameter[GAP_MAX_S])
        return false;
    double across_rad = fabs(cp_wrap_angle(foe->yaw_rad - looking->ego->yaw_rad));
    double aim_1 = cp_vec2_dot(way, cp_vec2_heading(foe->yaw_rad)) / distance_m;
    return across_rad > CP_PI / 6.0 && aim_1 > 0.7;
}

// Whether the road the other is on leads here: on a bridge it does not, however well he aims.
static bool leads_here(look *looking, const cp_vehicle_motion *foe)
{
    cp_road_view *view = looking->context->view;
    const cp_lane_ahead *way = NULL;
    bool meet = false;
    looking->status = cp_road_view_way(view, foe, CP_WAY_STRAIGHT, &way, looking->error);
    cp_mover ego = cp_mover_inside(looking->motion, NULL, 1.0);
    cp_mover other = cp_mover_inside(foe, way, 1.0);
    ego.now.velocity_m_s = (cp_vec2){0.0, 0.0};
    double arrival_s = sqrt(cp_front_distance_m2(looking->motion, foe)) / foe->after.speed_m_s;
    if (looking->status == CP_OK)
        looking->status = cp_road_view_meet(view, looking->motion, &ego, foe, &other, arrival_s,
                                            &meet, looking->error);
    return looking->status == CP_OK && meet;
}

static void look_at(void *context, const cp_vehicle_motion *motion)
{
    look *looking = context;
    const cp_vehicle_state *foe = &motion->after;
    if (looking->status != CP_OK || foe->vehicle == looking->ego->vehicle ||
        !is_candidate(looking, foe))
        return;
    const cp_traffic *traffic = looking->self->traffic;
    cp_rng_key key = cp_rng_key_text(looking->context->seed_key,
                                     cp_traffic_vehicle_id(traffic, looking->ego->vehicle));
    key = cp_rng_key_text(key, cp_traffic_vehicle_id(traffic, foe->vehicle));
    if (cp_rng_uniform(key, 0) < looking->context->parameter[PROBABILITY_1] &&
        !is_decided(looking->self, looking->ego->vehicle, foe->vehicle) &&
        leads_here(looking, motion))
        looking->status = decide(looking->self, looking->context, looking->ego->vehicle,
                                 foe->vehicle, looking->error);
}

static cp_status step(void *state, const cp_control_context *context, cp_error *error)
{
    misjudged_gap *self = state;
    if (context->parameter[PROBABILITY_1] <= 0.0)
        return CP_OK;
    forget(self);
    size_t count;
    const cp_vehicle_motion *motions = cp_traffic_motions(self->traffic, &count);
    double fastest_m_s = 1.0;
    for (size_t k = 0; k < count; k++)
        fastest_m_s = fmax(fastest_m_s, motions[k].after.speed_m_s);
    double reach_m = fastest_m_s * context->parameter[GAP_MAX_S];
    cp_status status = cp_neighbourhood_fill(&self->neighbourhood, reach_m, motions, count, error);
    for (size_t k = 0; k < count && status == CP_OK; k++) {
        look looking = {self, context, &motions[k].after, &motions[k], CP_OK, error};
        cp_neighbourhood_visit(&self->neighbourhood, motions[k].after.front_x_m,
                               motions[k].after.front_y_m, look_at, &looking);
        status = looking.status;
    }
    return status;
}

// At fault now: somebody misjudged is right before or beside the car.
static bool is_at_fault(const void *state, uint32_t vehicle)
{
    const double near_m = 15.0; // front to front: a car's length and two steps
    const misjudged_gap *self = state;
    const cp_vehicle_motion *own = cp_traffic_motion_of(self->traffic, vehicle);
    for (size_t k = 0; own && k < self->count; k++) {
        if (self->decisions[k].ego != vehicle)
            continue;
        const cp_vehicle_motion *foe = cp_traffic_motion_of(self->traffic, self->decisions[k].foe);
        if (foe && cp_front_distance_m2(own, foe) < near_m * near_m)
            return true;
    }
    return false;
}

// The error is the decision.
static double error_since_s(const void *state, uint32_t vehicle, uint32_t other)
{
    const misjudged_gap *self = state;
    for (size_t k = 0; k < self->count; k++)
        if (self->decisions[k].ego == vehicle && self->decisions[k].foe == other)
            return self->decisions[k].since_s;
    return INFINITY;
}

static cp_status visit_errors(const void *state, cp_error_visit visit, void *context,
                              cp_error *error)
{
    const misjudged_gap *self = state;
    cp_status status = CP_OK;
    for (size_t k = 0; k < self->count && status == CP_OK; k++)
        status = visit(context, self->decisions[k].ego, self->decisions[k].foe, error);
    return status;
}

static size_t counters(const void *state, const char **names, double *values, size_t room)
{
    const misjudged_gap *self = state;
    if (room < 1)
        return 0;
    names[0] = "misjudged";
    values[0] = (double)self->taken;
    return 1;
}

const cp_control_type CP_CONTROL_MISJUDGED_GAP = {
    .name = "misjudged_gap",
    .kind = CP_CONTROL_DRIVER_ERROR,
    .what = "a driver takes the gap before a particular other at a junction for larger than it is",
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
