/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/counterfactual.h"

#include "control/acting.h"
#include "run/branch_run.h"
#include "run/checkpoint.h"
#include "run/pair.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#define CRASHES_MAX ((size_t)1 << 14)
#define VEHICLES_MAX ((size_t)1 << 24)
#define NEVER (-1e300)
// When a copy is due (checkpoint.h). It is worth its cost when going on from the last one costs
// some eight times as much: found for three scenarios from what copies, steps and crashes cost
// there. A way is counted in vehicles times steps, a copy costs so much and a share for every
// vehicle. Never in processor time: which copies there are must not depend on the machine.
#define COPY_VEHICLE_STEPS 10000.0
#define COPY_STEPS 100.0
#define CHECKPOINTS_FOR_A_COPY 30

/* What is known of a vehicle, by number; all zero before it is first seen. */
typedef struct vehicle_past {
    double inserted_s;
    double fault_since_s; /* first of the checkpoints at which it has erred alone since then */
    bool is_known;
    bool was_at_fault; /* erred alone at the last checkpoint */
} vehicle_past;

/* One crash of the baseline and its branches. */
typedef struct pair_record {
    size_t found; /* index of the contact in the simulation */
    cp_null_status status;
    double lead_s;
    double checkpoint_s; /* NAN: none */
} pair_record;

struct cp_counterfactual {
    cp_branch_world world;
    double step_length_s;
    cp_checkpoints *checkpoints;
    double last_checkpoint_s; /* NEVER before the first */
    double next_checkpoint_s;
    double way_vehicle_steps; /* since the last copy */
    size_t found_seen;        /* contacts of the simulation looked at so far */
    size_t pair_count;

    // Address space that costs what is written into it. The heap is the simulation's alone as long
    // as it runs (checkpoint.h).
    vehicle_past *past;  /* VEHICLES_MAX of them, by number */
    pair_record *pairs;  /* CRASHES_MAX */
    cp_branch_end *ends; /* of pair p: null, then treatments, from p * (1 + treatments) */
};

// ---- beginning and end ---------------------------------------------------------------------

static void *reserve_space(size_t bytes)
{
    void *space = mmap(NULL, bytes, PROT_READ | PROT_WRITE,
                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    return space != MAP_FAILED ? space : NULL;
}

static size_t ends_bytes(const cp_counterfactual *self)
{
    return CRASHES_MAX * (1 + self->world.treatments->count) * sizeof *self->ends;
}

static void release_space(void *space, size_t bytes)
{
    if (space != NULL)
        munmap(space, bytes);
}

static cp_status create_parts(cp_counterfactual *self, cp_error *error)
{
    double window_s = 2.0 * self->world.treatments->timing.time_series_s;
    self->world.sample_room = 2 * (size_t)(window_s / self->step_length_s + 4.0);
    self->past = reserve_space(VEHICLES_MAX * sizeof *self->past);
    self->pairs = reserve_space(CRASHES_MAX * sizeof *self->pairs);
    self->ends = reserve_space(ends_bytes(self));
    self->world.samples = reserve_space(self->world.sample_room * sizeof *self->world.samples);
    if (self->past == NULL || self->pairs == NULL || self->ends == NULL ||
        self->world.samples == NULL)
        return cp_fail_memory(error, "counterfactual pairs");
    cp_checkpoint_options options = cp_checkpoint_options_default();
    options.kept = self->world.treatments->timing.checkpoints;
    options.every = CHECKPOINTS_FOR_A_COPY;
    options.branch = cp_branch_run;
    options.advance = cp_branch_advance;
    options.context = &self->world;
    return cp_checkpoints_create(&options, &self->checkpoints, error);
}

cp_status cp_counterfactual_create(const cp_treatments *treatments, cp_simulation *simulation,
                                   cp_counterfactual **counterfactual, cp_error *error)
{
    *counterfactual = NULL;
    cp_counterfactual *self = calloc(1, sizeof *self);
    if (self == NULL)
        return cp_fail_memory(error, "counterfactual pairs");
    self->world = (cp_branch_world){.treatments = treatments, .simulation = simulation};
    self->step_length_s = cp_traffic_step_length_s(simulation->traffic);
    self->last_checkpoint_s = NEVER;
    self->next_checkpoint_s = NEVER;
    cp_status status = create_parts(self, error);
    if (status != CP_OK) {
        cp_counterfactual_destroy(self);
        return status;
    }
    *counterfactual = self;
    return CP_OK;
}

void cp_counterfactual_destroy(cp_counterfactual *self)
{
    if (self == NULL)
        return;
    cp_checkpoints_destroy(self->checkpoints);
    release_space(self->past, VEHICLES_MAX * sizeof *self->past);
    release_space(self->pairs, CRASHES_MAX * sizeof *self->pairs);
    release_space(self->ends, ends_bytes(self));
    release_space(self->world.samples, self->world.sample_room * sizeof *self->world.samples);
    free(self);
}

// ---- beside the baseline -------------------------------------------------------------------

static cp_status remember_inserted(cp_counterfactual *self, cp_error *error)
{
    size_t count;
    const uint32_t *departed = cp_traffic_departed(self->world.simulation->traffic, &count);
    for (size_t k = 0; k < count; k++) {
        if (departed[k] >= VEHICLES_MAX)
            return cp_fail(error, CP_RUN_FAILED, "more than %zu vehicles in one replication",
                           VEHICLES_MAX);
        vehicle_past *past = &self->past[departed[k]];
        past->inserted_s = cp_traffic_time_s(self->world.simulation->traffic);
        past->is_known = true;
    }
    return CP_OK;
}

// Earliest moment at which the error of a driver can have begun: towards the other of this crash,
// or one whoever the other is; INFINITY without an error.
static double error_onset_s(const cp_counterfactual *self, const cp_found_contact *found, int role)
{
    const vehicle_past *past = &self->past[found->impact.vehicle[role]];
    double towards_s = found->car[role].error_since_s;
    if (!found->car[role].errs_alone)
        return towards_s;
    double onset_s = past->was_at_fault ? past->fault_since_s -
                                              self->world.treatments->timing.checkpoint_interval_s
                                        : self->last_checkpoint_s;
    return fmin(towards_s, past->is_known ? fmax(onset_s, past->inserted_s) : onset_s);
}

static bool is_inserted_late(const cp_counterfactual *self, const cp_found_contact *found)
{
    for (int role = 0; role < 2; role++) {
        const vehicle_past *past = &self->past[found->impact.vehicle[role]];
        if (past->is_known && found->impact.time_s - past->inserted_s < CP_COUNTERFACTUAL_LEAD_S)
            return true;
    }
    return false;
}

static cp_status take_id(const cp_counterfactual *self, uint32_t vehicle,
                         char id[CP_BRANCH_ID_SIZE], cp_error *error)
{
    const char *text = cp_traffic_vehicle_id(self->world.simulation->traffic, vehicle);
    if (strlen(text) >= CP_BRANCH_ID_SIZE)
        return cp_fail(error, CP_BAD_INPUT, "vehicle id '%s' is longer than %d characters", text,
                       CP_BRANCH_ID_SIZE - 1);
    strcpy(id, text);
    return CP_OK;
}

// Crashes that the two had since the checkpoint, before the one that was found at index: standing
// cars are hit.
static cp_status take_earlier_crashes(const cp_counterfactual *self, size_t index,
                                      double checkpoint_s, cp_branch_request *request,
                                      cp_error *error)
{
    const cp_found_contact *found = self->world.simulation->found;
    cp_status status = CP_OK;
    for (size_t k = index; k > 0 && found[k - 1].impact.time_s >= checkpoint_s; k--)
        for (int role = 0; status == CP_OK && role < 2; role++) {
            const uint32_t *pair = found[k - 1].impact.vehicle;
            uint32_t own = found[index].impact.vehicle[role];
            if (!cp_found_is_crash(&found[k - 1]) || (pair[0] != own && pair[1] != own))
                continue;
            if (request->earlier_count == CP_BRANCH_EARLIER_MAX)
                return cp_fail(error, CP_RUN_FAILED,
                               "'%s' had more than %d crashes since the checkpoint",
                               cp_traffic_vehicle_id(self->world.simulation->traffic, own),
                               CP_BRANCH_EARLIER_MAX);
            cp_earlier_crash *earlier = &request->earlier[request->earlier_count++];
            earlier->role = role;
            status = take_id(self, pair[0] == own ? pair[1] : pair[0], earlier->opponent, error);
        }
    return status;
}

static cp_status branch(cp_counterfactual *self, size_t index, cp_error *error)
{
    const cp_found_contact *found = &self->world.simulation->found[index];
    if (self->pair_count == CRASHES_MAX)
        return cp_fail(error, CP_RUN_FAILED, "more than %zu crashes in one replication",
                       CRASHES_MAX);
    size_t number = self->pair_count++;
    pair_record *pair = &self->pairs[number];
    double contact_s = found->impact.time_s;
    double onset_s = fmin(error_onset_s(self, found, 0), error_onset_s(self, found, 1));
    double latest_s =
        fmin(contact_s - CP_COUNTERFACTUAL_LEAD_S, onset_s - CP_COUNTERFACTUAL_BEFORE_ERROR_S);
    *pair = (pair_record){.found = index, .lead_s = contact_s - latest_s, .checkpoint_s = NAN};
    if (is_inserted_late(self, found))
        pair->status = CP_NULL_INSERTED_LATE;
    else if (!cp_checkpoints_find(self->checkpoints, latest_s, &pair->checkpoint_s))
        pair->status = CP_NULL_NO_CHECKPOINT;
    if (pair->status != CP_NULL_REPRODUCED)
        return CP_OK;

    cp_branch_request request = {.contact_s = contact_s};
    cp_status status = CP_OK;
    for (int role = 0; status == CP_OK && role < 2; role++)
        status = take_id(self, found->impact.vehicle[role], request.ids[role], error);
    if (status == CP_OK)
        status = take_earlier_crashes(self, index, pair->checkpoint_s, &request, error);
    size_t branches = 1 + self->world.treatments->count;
    if (status == CP_OK && !cp_checkpoints_branch(self->checkpoints, pair->checkpoint_s, &request,
                                                  cp_branch_request_size(request.earlier_count),
                                                  branches, &self->ends[number * branches]))
        pair->status = CP_NULL_CHECKPOINT_LOST;
    // A library of the study's that failed in one of them fails the replication, as it does here.
    const char *told = status == CP_OK ? cp_acting_told() : NULL;
    return told != NULL ? cp_fail(error, CP_RUN_FAILED, "in a branch from %.2f s: %s",
                                  pair->checkpoint_s, told)
                        : status;
}

// Freeze this checkpoint, if the way from the last copy has become long.
static cp_status take_checkpoint(cp_counterfactual *self, double time_s, cp_error *error)
{
    size_t vehicles;
    cp_traffic_motions(self->world.simulation->traffic, &vehicles);
    bool is_far = self->way_vehicle_steps >= COPY_VEHICLE_STEPS + COPY_STEPS * (double)vehicles;
    bool is_copied;
    cp_status status = cp_checkpoints_take(self->checkpoints, time_s, is_far, &is_copied, error);
    if (is_copied)
        self->way_vehicle_steps = 0.0;
    return status;
}

// Who errs now whoever the other is, and since which checkpoint without a break.
static void note_faults(cp_counterfactual *self, double time_s)
{
    size_t count;
    const cp_vehicle_motion *motions = cp_traffic_motions(self->world.simulation->traffic, &count);
    for (size_t k = 0; k < count; k++) {
        uint32_t vehicle = motions[k].after.vehicle;
        vehicle_past *past = &self->past[vehicle];
        bool is_at_fault = cp_controls_errs_alone(self->world.simulation->controls, vehicle);
        if (is_at_fault && !past->was_at_fault)
            past->fault_since_s = time_s;
        past->was_at_fault = is_at_fault;
    }
}

cp_status cp_counterfactual_step(cp_counterfactual *self, cp_error *error)
{
    cp_simulation *simulation = self->world.simulation;
    double time_s = cp_traffic_time_s(simulation->traffic);
    size_t vehicles;
    cp_traffic_motions(simulation->traffic, &vehicles);
    self->way_vehicle_steps += (double)vehicles;
    cp_status status = remember_inserted(self, error);
    for (; status == CP_OK && self->found_seen < simulation->found_count; self->found_seen++)
        if (simulation->found[self->found_seen].found_as == CP_FOUND_CRASH)
            status = branch(self, self->found_seen, error);

    // Half a step early rather than late: clocks that add up steps are never exact.
    if (status != CP_OK || time_s < self->next_checkpoint_s - 0.5 * self->step_length_s)
        return status;
    self->next_checkpoint_s =
        (self->last_checkpoint_s == NEVER ? time_s : self->next_checkpoint_s) +
        self->world.treatments->timing.checkpoint_interval_s;
    note_faults(self, time_s);
    self->last_checkpoint_s = time_s;
    return take_checkpoint(self, time_s, error);
}

// ---- outcomes ------------------------------------------------------------------------------

cp_status cp_counterfactual_conclude(cp_counterfactual *self, const cp_fleet *fleet,
                                     const cp_crash_row *crashes, size_t count,
                                     cp_counterfactual_rows *rows, cp_error *error)
{
    const cp_simulation *simulation = self->world.simulation;
    cp_status status = CP_OK;
    if (count != self->pair_count)
        return cp_fail(error, CP_RUN_FAILED, "%zu crashes, %zu of them branched", count,
                       self->pair_count);
    for (size_t number = 0; status == CP_OK && number < count; number++) {
        const pair_record *record = &self->pairs[number];
        const cp_impact *impact = &simulation->found[record->found].impact;
        cp_pair pair = {.treatments = self->world.treatments,
                        .simulation = simulation,
                        .fleet = fleet,
                        .number = number,
                        .found = record->found,
                        .crash = &crashes[number],
                        .ids = {cp_traffic_vehicle_id(simulation->traffic, impact->vehicle[0]),
                                cp_traffic_vehicle_id(simulation->traffic, impact->vehicle[1])},
                        .status = record->status,
                        .lead_s = record->lead_s,
                        .checkpoint_s = record->checkpoint_s,
                        .ends = &self->ends[number * (1 + self->world.treatments->count)]};
        status = cp_pair_conclude(&pair, rows, error);
    }
    return status;
}
