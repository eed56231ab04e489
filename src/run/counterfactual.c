/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/counterfactual.h"

#include "control/ttc.h"
#include "run/branch_answer.h"
#include "run/checkpoint.h"
#include "run/crash_record.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#define TTC_HORIZON_S 10.0
#define CRASHES_MAX ((size_t)1 << 20)
#define VEHICLES_MAX ((size_t)1 << 24)
#define NEVER (-1e300)
#define CHECKPOINTS_FOR_A_COPY                                                                     \
    5 /* checkpoint.h: cheapest between 3 and 8, measured by bench_pairs */

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
    const cp_study *study;
    cp_simulation *simulation;
    uint64_t seed;
    size_t baseline; /* index of the variant */
    size_t treatment_count;
    cp_checkpoints *checkpoints;
    double last_checkpoint_s; /* NEVER before the first */
    double next_checkpoint_s;
    size_t found_seen; /* contacts of the simulation looked at so far */
    size_t pair_count;
    size_t sample_room;

    // Address space that costs what is written into it. The heap is the simulation's alone as long
    // as it runs (checkpoint.h).
    vehicle_past *past;     /* VEHICLES_MAX of them, by number */
    pair_record *pairs;     /* CRASHES_MAX */
    cp_branch_end *ends;    /* of pair p: null, then treatments, from p * (1 + treatment_count) */
    cp_sample_row *samples; /* of one branch */
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
    return CRASHES_MAX * (1 + self->treatment_count) * sizeof *self->ends;
}

static void release_space(void *space, size_t bytes)
{
    if (space != NULL)
        munmap(space, bytes);
}

static int run_branch(void *context, size_t number, const void *request, size_t size, int answer);
static int go_on_to(void *context, double time_s);

static cp_status create_parts(cp_counterfactual *self, cp_error *error)
{
    double window_s = 2.0 * self->study->counterfactual.time_series_s;
    self->sample_room = 2 * (size_t)(window_s / self->study->step_length_s + 4.0);
    self->past = reserve_space(VEHICLES_MAX * sizeof *self->past);
    self->pairs = reserve_space(CRASHES_MAX * sizeof *self->pairs);
    self->ends = reserve_space(ends_bytes(self));
    self->samples = reserve_space(self->sample_room * sizeof *self->samples);
    if (self->past == NULL || self->pairs == NULL || self->ends == NULL || self->samples == NULL)
        return cp_fail_memory(error, "counterfactual pairs");
    cp_checkpoint_options options = cp_checkpoint_options_default();
    options.kept = self->study->counterfactual.checkpoints;
    options.every = CHECKPOINTS_FOR_A_COPY;
    options.branch = run_branch;
    options.advance = go_on_to;
    options.context = self;
    return cp_checkpoints_create(&options, &self->checkpoints, error);
}

cp_status cp_counterfactual_create(const cp_study *study, uint64_t seed, cp_simulation *simulation,
                                   cp_counterfactual **counterfactual, cp_error *error)
{
    *counterfactual = NULL;
    cp_counterfactual *self = calloc(1, sizeof *self);
    if (self == NULL)
        return cp_fail_memory(error, "counterfactual pairs");
    self->study = study;
    self->simulation = simulation;
    self->seed = seed;
    self->baseline = cp_study_baseline(study);
    self->treatment_count = study->variant_count - 1;
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
    release_space(self->samples, self->sample_room * sizeof *self->samples);
    free(self);
}

// The variant of treatment number k: all but the baseline, in the order of the study.
static const cp_study_variant *treatment_of(const cp_counterfactual *self, size_t k)
{
    return &self->study->variants[k < self->baseline ? k : k + 1];
}

static bool is_same_pair(const char *const one[2], const char *const other[2])
{
    return (strcmp(one[0], other[0]) == 0 && strcmp(one[1], other[1]) == 0) ||
           (strcmp(one[0], other[1]) == 0 && strcmp(one[1], other[0]) == 0);
}

// ---- in a branch ---------------------------------------------------------------------------

/* What a branch has to keep while it runs. */
typedef struct branch_run {
    cp_counterfactual *self;
    const cp_branch_request *request;
    size_t begun_at;    /* contacts found before the checkpoint */
    size_t seen;        /* contacts looked at */
    size_t first_index; /* first crash of one of the two: its index + 1, 0 none */
    size_t sample_count;
} branch_run;

static bool is_of_pair(const cp_branch_request *request, uint32_t vehicle)
{
    const char *id = sumo_bridge_vehicle_id(vehicle);
    return strcmp(id, request->ids[0]) == 0 || strcmp(id, request->ids[1]) == 0;
}

// Whether one of the two had this crash in the baseline too, before theirs.
static bool is_earlier_crash(const cp_branch_request *request, const cp_found_contact *found)
{
    const char *ids[2] = {sumo_bridge_vehicle_id(found->impact.vehicle[0]),
                          sumo_bridge_vehicle_id(found->impact.vehicle[1])};
    for (size_t k = 0; k < request->earlier_count; k++) {
        const cp_earlier_crash *earlier = &request->earlier[k];
        const char *pair[2] = {request->ids[earlier->role], earlier->opponent};
        if (is_same_pair(pair, ids))
            return true;
    }
    return false;
}

static bool involves_pair(const cp_branch_request *request, const cp_found_contact *found)
{
    return is_of_pair(request, found->impact.vehicle[0]) ||
           is_of_pair(request, found->impact.vehicle[1]);
}

// Look at the contacts of the step for the first crash of one of the two that it is about.
static void look_for_crash(branch_run *run)
{
    const cp_simulation *simulation = run->self->simulation;
    for (; run->seen < simulation->found_count; run->seen++) {
        const cp_found_contact *found = &simulation->found[run->seen];
        if (run->first_index == 0 && cp_found_is_crash(found) &&
            involves_pair(run->request, found) && !is_earlier_crash(run->request, found))
            run->first_index = run->seen + 1;
    }
}

// One row for each of the two that is on the road.
static void sample(branch_run *run)
{
    cp_counterfactual *self = run->self;
    const cp_traffic *traffic = self->simulation->traffic;
    const cp_vehicle_motion *motions[2] = {NULL, NULL};
    size_t count;
    const cp_vehicle_motion *all = cp_traffic_motions(traffic, &count);
    for (size_t k = 0; k < count; k++)
        for (int role = 0; role < 2; role++)
            if (strcmp(sumo_bridge_vehicle_id(all[k].after.vehicle), run->request->ids[role]) == 0)
                motions[role] = &all[k];
    double ttc_s = NAN;
    if (motions[0] != NULL && motions[1] != NULL) {
        cp_moving_rectangle a = cp_moving_rectangle_of(motions[0]);
        cp_moving_rectangle b = cp_moving_rectangle_of(motions[1]);
        ttc_s = cp_ttc_s(&a, &b, TTC_HORIZON_S);
    }
    for (int role = 0; role < 2; role++) {
        if (motions[role] == NULL || run->sample_count == self->sample_room)
            continue;
        const cp_vehicle_state *state = &motions[role]->after;
        self->samples[run->sample_count++] = (cp_sample_row){
            .role = role,
            .time_s = cp_traffic_time_s(traffic),
            .front_m = {state->front_x_m, state->front_y_m},
            .yaw_rad = state->yaw_rad,
            .speed_m_s = state->speed_m_s,
            .acceleration_m_s2 = state->acceleration_m_s2,
            .ttc_s = isfinite(ttc_s) ? ttc_s : NAN,
            .brake_request_m_s2 =
                cp_controls_brake_request_m_s2(self->simulation->controls, state->vehicle),
        };
    }
}

// Go on from the checkpoint until the branch is decided: the null treatment by its crash, a treated
// one at the horizon, for the sake of crashes between others.
static cp_status run_steps(branch_run *run, bool is_null, cp_error *error)
{
    cp_simulation *simulation = run->self->simulation;
    double contact_s = run->request->contact_s;
    double window_s = run->self->study->counterfactual.time_series_s;
    double end_s = contact_s + (is_null ? 1.0 : CP_COUNTERFACTUAL_HORIZON_S);
    cp_status status = CP_OK;
    while (status == CP_OK && cp_traffic_time_s(simulation->traffic) < end_s &&
           !(is_null && run->first_index > 0)) {
        status = cp_simulation_step(simulation, error);
        double time_s = cp_traffic_time_s(simulation->traffic);
        look_for_crash(run);
        if (status == CP_OK && run->first_index == 0 && fabs(time_s - contact_s) <= window_s)
            sample(run);
    }
    return status;
}

// First crash within the horizon, and the crashes between others.
static bool send_answer(const branch_run *run, int to)
{
    const cp_simulation *simulation = run->self->simulation;
    double horizon_s = run->request->contact_s + CP_COUNTERFACTUAL_HORIZON_S;
    const cp_found_contact *first =
        run->first_index > 0 ? &simulation->found[run->first_index - 1] : NULL;
    if (first != NULL && first->impact.time_s > horizon_s)
        first = NULL;
    const cp_found_contact **others = calloc(simulation->found_count + 1, sizeof *others);
    size_t other_count = 0;
    if (others == NULL)
        return false;
    for (size_t k = run->begun_at; k < simulation->found_count; k++) {
        const cp_found_contact *found = &simulation->found[k];
        if (cp_found_is_crash(found) && !involves_pair(run->request, found) &&
            found->impact.time_s <= horizon_s)
            others[other_count++] = found;
    }
    bool sent = cp_branch_answer_send(to, first, run->self->samples, run->sample_count, others,
                                      other_count);
    free(others);
    return sent;
}

static int run_branch(void *context, size_t number, const void *request, size_t size, int answer)
{
    cp_counterfactual *self = context;
    cp_simulation *simulation = self->simulation;
    cp_error error = {0};
    branch_run run = {.self = self,
                      .request = request,
                      .begun_at = simulation->found_count,
                      .seen = simulation->found_count};
    if (size < cp_branch_request_size(0) ||
        size != cp_branch_request_size(run.request->earlier_count))
        return 1;

    // Number 0 changes nothing.
    if (number > 0) {
        const cp_study_variant *variant = treatment_of(self, number - 1);
        const char *ids[2] = {run.request->ids[0], run.request->ids[1]};
        if (cp_controls_add_treatment(simulation->controls, variant->functions,
                                      variant->function_count, self->study->seed, self->seed, ids,
                                      &error) != CP_OK)
            return 1;
    }
    if (run_steps(&run, number == 0, &error) != CP_OK)
        return 1;
    return send_answer(&run, answer) ? 0 : 1;
}

static int go_on_to(void *context, double time_s)
{
    cp_counterfactual *self = context;
    cp_error error = {0};
    cp_status status = CP_OK;
    while (status == CP_OK && cp_traffic_time_s(self->simulation->traffic) < time_s)
        status = cp_simulation_step(self->simulation, &error);
    return status == CP_OK ? 0 : 1;
}

// ---- beside the baseline -------------------------------------------------------------------

static cp_status remember_inserted(cp_counterfactual *self, cp_error *error)
{
    size_t count;
    const uint32_t *departed = cp_traffic_departed(self->simulation->traffic, &count);
    for (size_t k = 0; k < count; k++) {
        if (departed[k] >= VEHICLES_MAX)
            return cp_fail(error, CP_RUN_FAILED, "more than %zu vehicles in one replication",
                           VEHICLES_MAX);
        vehicle_past *past = &self->past[departed[k]];
        past->inserted_s = cp_traffic_time_s(self->simulation->traffic);
        past->is_known = true;
    }
    return CP_OK;
}

// Earliest moment at which the error of a driver can have begun: towards the other of this crash,
// or one whoever the other is; INFINITY without an error.
static double error_onset_s(const cp_counterfactual *self, const cp_found_contact *found, int role)
{
    const vehicle_past *past = &self->past[found->impact.vehicle[role]];
    double towards_s = found->error_since_s[role];
    if (!found->errs_alone[role])
        return towards_s;
    double onset_s = past->was_at_fault
                         ? past->fault_since_s - self->study->counterfactual.checkpoint_interval_s
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

static cp_status take_id(uint32_t vehicle, char id[CP_BRANCH_ID_SIZE], cp_error *error)
{
    const char *text = sumo_bridge_vehicle_id(vehicle);
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
    const cp_found_contact *found = self->simulation->found;
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
                               sumo_bridge_vehicle_id(own), CP_BRANCH_EARLIER_MAX);
            cp_earlier_crash *earlier = &request->earlier[request->earlier_count++];
            earlier->role = role;
            status = take_id(pair[0] == own ? pair[1] : pair[0], earlier->opponent, error);
        }
    return status;
}

static cp_status branch(cp_counterfactual *self, size_t index, cp_error *error)
{
    const cp_found_contact *found = &self->simulation->found[index];
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
        status = take_id(found->impact.vehicle[role], request.ids[role], error);
    if (status == CP_OK)
        status = take_earlier_crashes(self, index, pair->checkpoint_s, &request, error);
    size_t branches = 1 + self->treatment_count;
    if (status == CP_OK && !cp_checkpoints_branch(self->checkpoints, pair->checkpoint_s, &request,
                                                  cp_branch_request_size(request.earlier_count),
                                                  branches, &self->ends[number * branches]))
        pair->status = CP_NULL_CHECKPOINT_LOST;
    return status;
}

// Who errs now whoever the other is, and since which checkpoint without a break.
static void note_faults(cp_counterfactual *self, double time_s)
{
    size_t count;
    const cp_vehicle_motion *motions = cp_traffic_motions(self->simulation->traffic, &count);
    for (size_t k = 0; k < count; k++) {
        uint32_t vehicle = motions[k].after.vehicle;
        vehicle_past *past = &self->past[vehicle];
        bool is_at_fault = cp_controls_errs_alone(self->simulation->controls, vehicle);
        if (is_at_fault && !past->was_at_fault)
            past->fault_since_s = time_s;
        past->was_at_fault = is_at_fault;
    }
}

cp_status cp_counterfactual_step(cp_counterfactual *self, cp_error *error)
{
    cp_simulation *simulation = self->simulation;
    double time_s = cp_traffic_time_s(simulation->traffic);
    cp_status status = remember_inserted(self, error);
    for (; status == CP_OK && self->found_seen < simulation->found_count; self->found_seen++)
        if (simulation->found[self->found_seen].found_as == CP_FOUND_CRASH)
            status = branch(self, self->found_seen, error);

    // Half a step early rather than late: clocks that add up steps are never exact.
    if (status != CP_OK || time_s < self->next_checkpoint_s - 0.5 * self->study->step_length_s)
        return status;
    self->next_checkpoint_s =
        (self->last_checkpoint_s == NEVER ? time_s : self->next_checkpoint_s) +
        self->study->counterfactual.checkpoint_interval_s;
    note_faults(self, time_s);
    self->last_checkpoint_s = time_s;
    return cp_checkpoints_take(self->checkpoints, time_s, error);
}

// ---- outcomes ------------------------------------------------------------------------------

// The answer with its roles as in the baseline's crash: its a stays a, its b stays b.
static void keep_roles(cp_branch_answer *answer, const char *const ids[2])
{
    bool swapped = strcmp(answer->ids[1], ids[0]) == 0 || strcmp(answer->ids[0], ids[1]) == 0;
    if (!swapped)
        return;
#define SWAP(type, pair)                                                                           \
    do {                                                                                           \
        type first = (pair)[0];                                                                    \
        (pair)[0] = (pair)[1];                                                                     \
        (pair)[1] = first;                                                                         \
    } while (0)
    cp_impact *impact = &answer->found.impact;
    SWAP(uint32_t, impact->vehicle);
    SWAP(cp_vehicle_state, impact->state);
    SWAP(double, impact->yaw_rate_rad_s);
    SWAP(cp_vec2, impact->front_velocity_m_s);
    SWAP(cp_contact_side, impact->side);
    SWAP(bool, answer->found.at_fault);
    SWAP(bool, answer->found.had_crashed);
    SWAP(const char *, answer->ids);
    SWAP(const char *, answer->types);
    SWAP(cp_sumo_type, answer->type);
#undef SWAP
}

// Name of the first thing in which two vehicle states differ; NULL when they are the same bits.
static const char *state_difference(const cp_vehicle_state *one, const cp_vehicle_state *other)
{
    if (one->front_x_m != other->front_x_m || one->front_y_m != other->front_y_m)
        return "position";
    if (one->yaw_rad != other->yaw_rad)
        return "heading";
    if (one->speed_m_s != other->speed_m_s)
        return "speed";
    return NULL;
}

static const char *impact_difference(const cp_impact *one, const cp_impact *other)
{
    if (one->time_s != other->time_s)
        return "time";
    for (int role = 0; role < 2; role++) {
        const char *what = state_difference(&one->state[role], &other->state[role]);
        if (what != NULL)
            return what;
        if (one->yaw_rate_rad_s[role] != other->yaw_rate_rad_s[role])
            return "yaw rate";
        if (one->front_velocity_m_s[role].x != other->front_velocity_m_s[role].x ||
            one->front_velocity_m_s[role].y != other->front_velocity_m_s[role].y)
            return "velocity";
        if (one->side[role] != other->side[role])
            return "side";
    }
    if (one->contact_m.x != other->contact_m.x || one->contact_m.y != other->contact_m.y)
        return "contact point";
    return NULL;
}

static bool is_same_pulse(const cp_crash_vehicle_row *one, const cp_crash_vehicle_row *other)
{
    return one->pulse_size == other->pulse_size &&
           (one->pulse_size == 0 || memcmp(one->pulse, other->pulse, one->pulse_size) == 0);
}

static cp_status fill_crash(const cp_simulation *simulation, const cp_branch_answer *answer,
                            const cp_fleet *fleet, cp_crash_row *row, cp_error *error)
{
    cp_impact_names names = {.sumocfg_path = simulation->sumocfg_path};
    for (int role = 0; role < 2; role++) {
        names.sumo_id[role] = answer->ids[role];
        names.sumo_type[role] = answer->types[role];
        names.type[role] = answer->type[role];
        names.at_fault[role] = answer->found.at_fault[role];
        names.had_crashed[role] = answer->found.had_crashed[role];
    }
    return cp_crash_record_fill(&answer->found.impact, &names, fleet, row, error);
}

static cp_status copy_samples(const cp_branch_answer *answer, cp_sample_row **sample, size_t *count,
                              cp_error *error)
{
    if (answer->sample_count == 0)
        return CP_OK;
    *sample = malloc(answer->sample_count * sizeof **sample);
    if (*sample == NULL)
        return cp_fail_memory(error, "time series");
    memcpy(*sample, answer->sample, answer->sample_count * sizeof **sample);
    *count = answer->sample_count;
    return CP_OK;
}

/* One crash while its outcomes are worked out. */
typedef struct pair_view {
    cp_counterfactual *self;
    const cp_fleet *fleet;
    size_t number;
    const pair_record *pair;
    const cp_crash_row *crash; /* of the baseline */
    const char *ids[2];
    cp_counterfactual_rows *rows;
} pair_view;

static const cp_branch_end *end_of(const pair_view *view, size_t branch_number)
{
    return &view->self->ends[view->number * (1 + view->self->treatment_count) + branch_number];
}

// Same vehicles, same state to the bit, same pulses; else what differs.
static cp_status compare_null(const pair_view *view, const cp_branch_answer *answer,
                              cp_null_treatment_row *row, cp_error *error)
{
    const cp_found_contact *baseline = &view->self->simulation->found[view->pair->found];
    row->status = CP_NULL_NOT_REPRODUCED;
    if (!answer->has_crash) {
        snprintf(row->detail, CP_DETAIL_SIZE, "no crash");
        return CP_OK;
    }
    if (strcmp(answer->ids[0], view->ids[0]) != 0 || strcmp(answer->ids[1], view->ids[1]) != 0) {
        snprintf(row->detail, CP_DETAIL_SIZE, "crash of %.80s and %.80s", answer->ids[0],
                 answer->ids[1]);
        return CP_OK;
    }
    const char *what = impact_difference(&baseline->impact, &answer->found.impact);
    if (what != NULL) {
        snprintf(row->detail, CP_DETAIL_SIZE, "%s differs, contact %.9g s later", what,
                 answer->found.impact.time_s - baseline->impact.time_s);
        return CP_OK;
    }
    cp_crash_row again = {0};
    cp_status status = fill_crash(view->self->simulation, answer, view->fleet, &again, error);
    if (status == CP_OK && is_same_pulse(&again.vehicle[0], &view->crash->vehicle[0]) &&
        is_same_pulse(&again.vehicle[1], &view->crash->vehicle[1]))
        row->status = CP_NULL_REPRODUCED;
    else
        snprintf(row->detail, CP_DETAIL_SIZE, "pulse differs");
    cp_crash_row_destroy(&again);
    return status;
}

static cp_status conclude_null(const pair_view *view, cp_null_status *result, const char **detail,
                               cp_error *error)
{
    cp_null_treatment_row *row = cp_counterfactual_rows_add_null(view->rows);
    cp_branch_answer answer;
    cp_status status = CP_OK;
    if (row == NULL)
        return cp_fail_memory(error, "null treatment");
    *row =
        (cp_null_treatment_row){.crash = view->number,
                                .status = view->pair->status,
                                .lead_s = view->pair->lead_s,
                                .checkpoint_s = view->pair->checkpoint_s,
                                .variant = view->self->study->variants[view->self->baseline].name};
    const cp_branch_end *end = end_of(view, 0);
    if (row->status == CP_NULL_REPRODUCED && !end->answered) {
        row->status = CP_NULL_BRANCH_FAILED;
        snprintf(row->detail, CP_DETAIL_SIZE, "null treatment: %s", end->failure);
    } else if (row->status == CP_NULL_REPRODUCED) {
        if (!cp_branch_answer_read(end->answer, end->answer_size, &answer))
            return cp_fail(error, CP_RUN_FAILED, "a branch's answer is damaged");
        status = compare_null(view, &answer, row, error);
        if (status == CP_OK)
            status = copy_samples(&answer, &row->sample, &row->sample_count, error);
    }
    *result = row->status;
    *detail = row->detail;
    return status;
}

// Crashes between others that the baseline, as far as it ran, does not have.
static size_t count_new(const pair_view *view, const cp_branch_answer *answer)
{
    const cp_simulation *simulation = view->self->simulation;
    double end_s = cp_traffic_time_s(simulation->traffic);
    const char *at = NULL;
    size_t count = 0;
    for (size_t k = 0; k < answer->other_count; k++) {
        cp_other_crash other = cp_branch_answer_other(answer, &at);
        bool is_new = other.time_s <= end_s;
        for (size_t f = 0; is_new && f < simulation->found_count; f++) {
            const cp_impact *impact = &simulation->found[f].impact;
            const char *ids[2] = {sumo_bridge_vehicle_id(impact->vehicle[0]),
                                  sumo_bridge_vehicle_id(impact->vehicle[1])};
            is_new = !(cp_found_is_crash(&simulation->found[f]) && is_same_pair(ids, other.ids));
        }
        count += is_new;
    }
    return count;
}

static cp_outcome compare(double baseline, double treated, double tolerance)
{
    if (treated < baseline - tolerance)
        return CP_OUTCOME_MITIGATED;
    if (treated > baseline + tolerance)
        return CP_OUTCOME_AGGRAVATED;
    return CP_OUTCOME_UNCHANGED;
}

static cp_status judge(const pair_view *view, cp_branch_answer *answer, cp_counterfactual_row *row,
                       cp_error *error)
{
    row->new_crashes = count_new(view, answer);
    row->outcome = row->outcome_olc = CP_OUTCOME_AVOIDED;
    if (!answer->has_crash)
        return CP_OK;
    keep_roles(answer, view->ids);
    cp_status status =
        fill_crash(view->self->simulation, answer, view->fleet, &row->treated, error);
    row->has_crash = status == CP_OK;
    row->outcome = row->outcome_olc = CP_OUTCOME_CHANGED_OPPONENT;
    if (status != CP_OK || !is_same_pair(answer->ids, view->ids))
        return status;
    row->outcome = compare(view->crash->description.closing_speed_m_s,
                           row->treated.description.closing_speed_m_s, CP_COUNTERFACTUAL_SPEED_M_S);
    double baseline_g = cp_crash_row_olc_g(view->crash);
    double treated_g = cp_crash_row_olc_g(&row->treated);
    row->outcome_olc = isnan(baseline_g) || isnan(treated_g)
                           ? CP_OUTCOME_NO_OLC
                           : compare(baseline_g, treated_g, CP_COUNTERFACTUAL_OLC_G);
    return CP_OK;
}

static cp_status conclude_treatment(const pair_view *view, size_t k, cp_null_status null_status,
                                    const char *null_detail, cp_error *error)
{
    cp_counterfactual_row *row = cp_counterfactual_rows_add(view->rows);
    cp_branch_answer answer;
    if (row == NULL)
        return cp_fail_memory(error, "counterfactual");
    *row = (cp_counterfactual_row){.crash = view->number,
                                   .variant = treatment_of(view->self, k)->name,
                                   .outcome = CP_OUTCOME_INVALID,
                                   .outcome_olc = CP_OUTCOME_INVALID,
                                   .reason = null_status};
    if (null_status != CP_NULL_REPRODUCED) {
        snprintf(row->detail, CP_DETAIL_SIZE, "%s", null_detail);
        return CP_OK;
    }
    const cp_branch_end *end = end_of(view, 1 + k);
    if (!end->answered) {
        row->reason = CP_NULL_BRANCH_FAILED;
        snprintf(row->detail, CP_DETAIL_SIZE, "%s", end->failure);
        return CP_OK;
    }
    if (!cp_branch_answer_read(end->answer, end->answer_size, &answer))
        return cp_fail(error, CP_RUN_FAILED, "a branch's answer is damaged");
    cp_status status = judge(view, &answer, row, error);
    return status == CP_OK ? copy_samples(&answer, &row->sample, &row->sample_count, error)
                           : status;
}

cp_status cp_counterfactual_conclude(cp_counterfactual *self, const cp_fleet *fleet,
                                     const cp_crash_row *crashes, size_t count,
                                     cp_counterfactual_rows *rows, cp_error *error)
{
    cp_status status = CP_OK;
    if (count != self->pair_count)
        return cp_fail(error, CP_RUN_FAILED, "%zu crashes, %zu of them branched", count,
                       self->pair_count);
    for (size_t number = 0; status == CP_OK && number < count; number++) {
        pair_view view = {.self = self,
                          .fleet = fleet,
                          .number = number,
                          .pair = &self->pairs[number],
                          .crash = &crashes[number],
                          .rows = rows};
        const cp_impact *impact = &self->simulation->found[view.pair->found].impact;
        cp_null_status null_status = CP_NULL_REPRODUCED;
        const char *null_detail = "";
        for (int role = 0; role < 2; role++)
            view.ids[role] = sumo_bridge_vehicle_id(impact->vehicle[role]);
        status = conclude_null(&view, &null_status, &null_detail, error);
        for (size_t k = 0; status == CP_OK && k < self->treatment_count; k++)
            status = conclude_treatment(&view, k, null_status, null_detail, error);
    }
    return status;
}
