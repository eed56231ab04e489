/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/branch_run.h"

#include "control/ttc.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TTC_HORIZON_S 10.0

bool cp_branch_is_same_pair(const char *const one[2], const char *const other[2])
{
    return (strcmp(one[0], other[0]) == 0 && strcmp(one[1], other[1]) == 0) ||
           (strcmp(one[0], other[1]) == 0 && strcmp(one[1], other[0]) == 0);
}

/* What a branch has to keep while it runs. */
typedef struct branch_run {
    const cp_branch_world *world;
    const cp_branch_request *request;
    size_t begun_at;    /* contacts found before the checkpoint */
    size_t seen;        /* contacts looked at */
    size_t first_index; /* first crash of one of the two: its index + 1, 0 none */
    size_t sample_count;
} branch_run;

static const char *id_of(const branch_run *run, uint32_t vehicle)
{
    return cp_traffic_vehicle_id(run->world->simulation->traffic, vehicle);
}

static bool is_of_pair(const branch_run *run, uint32_t vehicle)
{
    const char *id = id_of(run, vehicle);
    return strcmp(id, run->request->ids[0]) == 0 || strcmp(id, run->request->ids[1]) == 0;
}

// Whether one of the two had this crash in the baseline too, before theirs.
static bool is_earlier_crash(const branch_run *run, const cp_found_contact *found)
{
    const char *ids[2] = {id_of(run, found->impact.vehicle[0]),
                          id_of(run, found->impact.vehicle[1])};
    const cp_branch_request *request = run->request;
    for (size_t k = 0; k < request->earlier_count; k++) {
        const cp_earlier_crash *earlier = &request->earlier[k];
        const char *pair[2] = {request->ids[earlier->role], earlier->opponent};
        if (cp_branch_is_same_pair(pair, ids))
            return true;
    }
    return false;
}

static bool involves_pair(const branch_run *run, const cp_found_contact *found)
{
    return is_of_pair(run, found->impact.vehicle[0]) || is_of_pair(run, found->impact.vehicle[1]);
}

// Look at the contacts of the step for the first crash of one of the two that it is about.
static void look_for_crash(branch_run *run)
{
    const cp_simulation *simulation = run->world->simulation;
    for (; run->seen < simulation->found_count; run->seen++) {
        const cp_found_contact *found = &simulation->found[run->seen];
        if (run->first_index == 0 && cp_found_is_crash(found) && involves_pair(run, found) &&
            !is_earlier_crash(run, found))
            run->first_index = run->seen + 1;
    }
}

// One row for each of the two that is on the road.
static void sample(branch_run *run)
{
    const cp_branch_world *world = run->world;
    const cp_traffic *traffic = world->simulation->traffic;
    const cp_vehicle_motion *motions[2] = {NULL, NULL};
    size_t count;
    const cp_vehicle_motion *all = cp_traffic_motions(traffic, &count);
    for (size_t k = 0; k < count; k++)
        for (int role = 0; role < 2; role++)
            if (strcmp(id_of(run, all[k].after.vehicle), run->request->ids[role]) == 0)
                motions[role] = &all[k];
    double ttc_s = NAN;
    if (motions[0] != NULL && motions[1] != NULL) {
        cp_moving_rectangle a = cp_moving_rectangle_of(motions[0]);
        cp_moving_rectangle b = cp_moving_rectangle_of(motions[1]);
        ttc_s = cp_ttc_s(&a, &b, TTC_HORIZON_S);
    }
    for (int role = 0; role < 2; role++) {
        if (motions[role] == NULL || run->sample_count == world->sample_room)
            continue;
        const cp_vehicle_state *state = &motions[role]->after;
        world->samples[run->sample_count++] = (cp_sample_row){
            .role = role,
            .time_s = cp_traffic_time_s(traffic),
            .front_m = {state->front_x_m, state->front_y_m},
            .yaw_rad = state->yaw_rad,
            .speed_m_s = state->speed_m_s,
            .acceleration_m_s2 = state->acceleration_m_s2,
            .ttc_s = isfinite(ttc_s) ? ttc_s : NAN,
            .brake_request_m_s2 =
                cp_controls_brake_request_m_s2(world->simulation->controls, state->vehicle),
        };
    }
}

// Go on from the checkpoint until the branch is decided: the null treatment by its crash, a treated
// one at the horizon, for the sake of crashes between others.
static cp_status run_steps(branch_run *run, bool is_null, cp_error *error)
{
    cp_simulation *simulation = run->world->simulation;
    double contact_s = run->request->contact_s;
    double window_s = run->world->treatments->timing.time_series_s;
    double end_s = contact_s + (is_null ? 1.0 : run->world->treatments->timing.horizon_s);
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
static cp_status send_answer(const branch_run *run, int to, cp_error *error)
{
    const cp_simulation *simulation = run->world->simulation;
    double horizon_s = run->request->contact_s + run->world->treatments->timing.horizon_s;
    const cp_found_contact *first =
        run->first_index > 0 ? &simulation->found[run->first_index - 1] : NULL;
    if (first != NULL && first->impact.time_s > horizon_s)
        first = NULL;
    const cp_found_contact **others = calloc(simulation->found_count + 1, sizeof *others);
    size_t other_count = 0;
    if (others == NULL)
        return cp_fail_memory(error, "crashes of a branch");
    for (size_t k = run->begun_at; k < simulation->found_count; k++) {
        const cp_found_contact *found = &simulation->found[k];
        if (cp_found_is_crash(found) && !involves_pair(run, found) &&
            found->impact.time_s <= horizon_s)
            others[other_count++] = found;
    }
    cp_status status = cp_branch_answer_send(to, simulation->traffic, first, run->world->samples,
                                             run->sample_count, others, other_count, error);
    free(others);
    return status;
}

cp_status cp_branch_run(void *context, size_t number, const void *request, size_t size, int answer,
                        cp_error *error)
{
    const cp_branch_world *world = context;
    const cp_treatments *treatments = world->treatments;
    cp_simulation *simulation = world->simulation;
    branch_run run = {.world = world,
                      .request = request,
                      .begun_at = simulation->found_count,
                      .seen = simulation->found_count};
    if (size < cp_branch_request_size(0) ||
        size != cp_branch_request_size(run.request->earlier_count))
        return cp_fail(error, CP_RUN_FAILED, "a branch's request is damaged");

    // Number 0 changes nothing.
    cp_status status = CP_OK;
    if (number > 0) {
        const cp_treatment *treatment = &treatments->treatment[number - 1];
        const char *ids[2] = {run.request->ids[0], run.request->ids[1]};
        status = cp_controls_add_treatment(simulation->controls, treatment->functions,
                                           treatment->function_count, treatments->study_seed,
                                           treatments->seed, ids, error);
    }
    if (status == CP_OK)
        status = run_steps(&run, number == 0, error);
    return status == CP_OK ? send_answer(&run, answer, error) : status;
}

cp_status cp_branch_advance(void *context, double time_s, cp_error *error)
{
    const cp_branch_world *world = context;
    cp_status status = CP_OK;
    while (status == CP_OK && cp_traffic_time_s(world->simulation->traffic) < time_s)
        status = cp_simulation_step(world->simulation, error);
    return status;
}
