/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/pair.h"

#include "run/branch_run.h"
#include "run/crash_record.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_text(const char *one, const char *other)
{
    return strcmp(one, other) == 0;
}

// The answer with its roles as in the baseline's crash: its a stays a, its b stays b.
static void keep_roles(cp_branch_answer *answer, const char *const ids[2])
{
    if (is_text(answer->car[1].id, ids[0]) || is_text(answer->car[0].id, ids[1]))
        cp_branch_answer_swap_roles(answer);
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

// The baseline's crash to the bit: what a treatment that did not act leaves.
static bool is_the_baselines(const cp_pair *pair, const cp_branch_answer *answer)
{
    const cp_found_contact *baseline = &pair->simulation->found[pair->found];
    bool is_same = impact_difference(&baseline->impact, &answer->found.impact) == NULL;
    for (int role = 0; is_same && role < 2; role++)
        is_same = is_text(answer->car[role].id, pair->ids[role]) &&
                  is_text(answer->car[role].type_id, pair->crash->vehicle[role].sumo_type) &&
                  answer->found.car[role].had_crashed == baseline->car[role].had_crashed;
    return is_same;
}

// known: the same crash simulated before; NULL: none.
static cp_status fill_crash(const cp_pair *pair, const cp_branch_answer *answer,
                            cp_crash_record_extent extent, const cp_crash_row *known,
                            cp_crash_row *row, cp_error *error)
{
    cp_impact_names names = {.sumocfg_path = pair->simulation->sumocfg_path};
    for (int role = 0; role < 2; role++) {
        const cp_branch_car *car = &answer->car[role];
        names.sumo_id[role] = car->id;
        names.sumo_type[role] = car->type_id;
        names.type[role] = car->type;
        names.lane[role] = car->lane;
        names.at_fault[role] = answer->found.car[role].at_fault;
        names.had_crashed[role] = answer->found.car[role].had_crashed;
    }
    cp_status status = known != NULL ? cp_crash_record_repeat(known, &names, row, error)
                                     : cp_crash_record_fill(&answer->found.impact, &names,
                                                            pair->fleet, extent, row, error);
    return status == CP_OK ? cp_participant_rows_copy(&answer->found.participants,
                                                      answer->is_swapped, &row->participants, error)
                           : status;
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

// Same vehicles, same state to the bit, same pulses; else what differs.
static cp_status compare_null(const cp_pair *pair, const cp_branch_answer *answer,
                              cp_null_treatment_row *row, cp_error *error)
{
    const cp_found_contact *baseline = &pair->simulation->found[pair->found];
    row->status = CP_NULL_NOT_REPRODUCED;
    if (!answer->has_crash) {
        snprintf(row->detail, CP_DETAIL_SIZE, "no crash");
        return CP_OK;
    }
    if (!is_text(answer->car[0].id, pair->ids[0]) || !is_text(answer->car[1].id, pair->ids[1])) {
        snprintf(row->detail, CP_DETAIL_SIZE, "crash of %.80s and %.80s", answer->car[0].id,
                 answer->car[1].id);
        return CP_OK;
    }
    const char *what = impact_difference(&baseline->impact, &answer->found.impact);
    if (what != NULL) {
        snprintf(row->detail, CP_DETAIL_SIZE, "%s differs, contact %.9g s later", what,
                 answer->found.impact.time_s - baseline->impact.time_s);
        return CP_OK;
    }
    cp_crash_row again = {0};
    cp_status status = fill_crash(pair, answer, CP_RECORD_PULSE, NULL, &again, error);
    if (status == CP_OK && is_same_pulse(&again.vehicle[0], &pair->crash->vehicle[0]) &&
        is_same_pulse(&again.vehicle[1], &pair->crash->vehicle[1]))
        row->status = CP_NULL_REPRODUCED;
    else
        snprintf(row->detail, CP_DETAIL_SIZE, "pulse differs");
    cp_crash_row_destroy(&again);
    return status;
}

static cp_status conclude_null(const cp_pair *pair, cp_counterfactual_rows *rows,
                               cp_null_status *result, const char **detail, cp_error *error)
{
    cp_null_treatment_row *row = cp_counterfactual_rows_add_null(rows);
    cp_branch_answer answer;
    cp_status status = CP_OK;
    if (row == NULL)
        return cp_fail_memory(error, "null treatment");
    *row = (cp_null_treatment_row){.crash = pair->number,
                                   .status = pair->status,
                                   .lead_s = pair->lead_s,
                                   .checkpoint_s = pair->checkpoint_s,
                                   .variant = pair->treatments->baseline};
    const cp_branch_end *end = &pair->ends[0];
    if (row->status == CP_NULL_REPRODUCED && !end->answered) {
        row->status = CP_NULL_BRANCH_FAILED;
        snprintf(row->detail, CP_DETAIL_SIZE, "null treatment: %.200s", end->failure);
    } else if (row->status == CP_NULL_REPRODUCED) {
        if (!cp_branch_answer_read(end->answer, end->answer_size, &answer))
            return cp_fail(error, CP_RUN_FAILED, "a branch's answer is damaged");
        status = compare_null(pair, &answer, row, error);
        if (status == CP_OK)
            status = copy_samples(&answer, &row->sample, &row->sample_count, error);
    }
    *result = row->status;
    *detail = row->detail;
    return status;
}

// Crashes between others that the baseline, as far as it ran, does not have.
static size_t count_new(const cp_pair *pair, const cp_branch_answer *answer)
{
    const cp_simulation *simulation = pair->simulation;
    double end_s = cp_traffic_time_s(simulation->traffic);
    const char *at = NULL;
    size_t count = 0;
    for (size_t k = 0; k < answer->other_count; k++) {
        cp_other_crash other = cp_branch_answer_other(answer, &at);
        bool is_new = other.time_s <= end_s;
        for (size_t f = 0; is_new && f < simulation->found_count; f++) {
            const cp_impact *impact = &simulation->found[f].impact;
            const char *ids[2] = {cp_traffic_vehicle_id(simulation->traffic, impact->vehicle[0]),
                                  cp_traffic_vehicle_id(simulation->traffic, impact->vehicle[1])};
            is_new = !(cp_found_is_crash(&simulation->found[f]) &&
                       cp_branch_is_same_pair(ids, other.ids));
        }
        count += is_new;
    }
    return count;
}

static bool involves(const char *const pair[2], const char *const ids[2])
{
    for (int k = 0; k < 2; k++)
        if (strcmp(ids[k], pair[0]) == 0 || strcmp(ids[k], pair[1]) == 0)
            return true;
    return false;
}

static bool happens_again(const cp_branch_answer *answer, const char *const ids[2])
{
    const char *at = NULL;
    for (size_t k = 0; k < answer->other_count; k++) {
        cp_other_crash other = cp_branch_answer_other(answer, &at);
        if (cp_branch_is_same_pair(ids, other.ids))
            return true;
    }
    return false;
}

// Crashes of the baseline between others, from the checkpoint to the horizon, that the branch does
// not have.
static size_t count_vanished(const cp_pair *pair, const cp_branch_answer *answer)
{
    const cp_simulation *simulation = pair->simulation;
    double horizon_s = pair->crash->time_s + pair->treatments->timing.horizon_s;
    size_t count = 0;
    for (size_t f = 0; f < simulation->found_count; f++) {
        const cp_impact *impact = &simulation->found[f].impact;
        const char *ids[2] = {cp_traffic_vehicle_id(simulation->traffic, impact->vehicle[0]),
                              cp_traffic_vehicle_id(simulation->traffic, impact->vehicle[1])};
        count += cp_found_is_crash(&simulation->found[f]) && impact->time_s > pair->checkpoint_s &&
                 impact->time_s <= horizon_s && !involves(pair->ids, ids) &&
                 !happens_again(answer, ids);
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

static cp_status judge(const cp_pair *pair, cp_branch_answer *answer, cp_counterfactual_row *row,
                       cp_error *error)
{
    row->new_crashes = count_new(pair, answer);
    row->vanished_crashes = count_vanished(pair, answer);
    row->outcome = row->outcome_olc = CP_OUTCOME_AVOIDED;
    if (!answer->has_crash)
        return CP_OK;
    keep_roles(answer, pair->ids);
    const cp_crash_row *known = is_the_baselines(pair, answer) ? pair->crash : NULL;
    cp_status status = fill_crash(pair, answer, CP_RECORD_ALL, known, &row->treated, error);
    row->has_crash = status == CP_OK;
    row->outcome = row->outcome_olc = CP_OUTCOME_CHANGED_OPPONENT;
    const char *const treated_ids[2] = {answer->car[0].id, answer->car[1].id};
    if (status != CP_OK || !cp_branch_is_same_pair(treated_ids, pair->ids))
        return status;
    row->outcome = compare(pair->crash->description.closing_speed_m_s,
                           row->treated.description.closing_speed_m_s, CP_COUNTERFACTUAL_SPEED_M_S);
    double baseline_g = cp_crash_row_olc_g(pair->crash);
    double treated_g = cp_crash_row_olc_g(&row->treated);
    row->outcome_olc = isnan(baseline_g) || isnan(treated_g)
                           ? CP_OUTCOME_NO_OLC
                           : compare(baseline_g, treated_g, CP_COUNTERFACTUAL_OLC_G);
    return CP_OK;
}

static cp_status conclude_treatment(const cp_pair *pair, size_t k, cp_null_status null_status,
                                    const char *null_detail, cp_counterfactual_rows *rows,
                                    cp_error *error)
{
    cp_counterfactual_row *row = cp_counterfactual_rows_add(rows);
    cp_branch_answer answer;
    if (row == NULL)
        return cp_fail_memory(error, "counterfactual");
    *row = (cp_counterfactual_row){.crash = pair->number,
                                   .variant = pair->treatments->treatment[k].name,
                                   .outcome = CP_OUTCOME_INVALID,
                                   .outcome_olc = CP_OUTCOME_INVALID,
                                   .reason = null_status};
    if (null_status != CP_NULL_REPRODUCED) {
        snprintf(row->detail, CP_DETAIL_SIZE, "%s", null_detail);
        return CP_OK;
    }
    const cp_branch_end *end = &pair->ends[1 + k];
    if (!end->answered) {
        row->reason = CP_NULL_BRANCH_FAILED;
        snprintf(row->detail, CP_DETAIL_SIZE, "%s", end->failure);
        return CP_OK;
    }
    if (!cp_branch_answer_read(end->answer, end->answer_size, &answer))
        return cp_fail(error, CP_RUN_FAILED, "a branch's answer is damaged");
    cp_status status = judge(pair, &answer, row, error);
    return status == CP_OK ? copy_samples(&answer, &row->sample, &row->sample_count, error)
                           : status;
}

cp_status cp_pair_conclude(const cp_pair *pair, cp_counterfactual_rows *rows, cp_error *error)
{
    cp_null_status null_status = CP_NULL_REPRODUCED;
    const char *null_detail = "";
    cp_status status = conclude_null(pair, rows, &null_status, &null_detail, error);
    for (size_t k = 0; status == CP_OK && k < pair->treatments->count; k++)
        status = conclude_treatment(pair, k, null_status, null_detail, rows, error);
    return status;
}
