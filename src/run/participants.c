/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/participants.h"

#include <math.h>
#include <stdlib.h>

static const char *const TOWARDS[] = {[CP_TOWARDS_EVERYBODY] = "everybody",
                                      [CP_TOWARDS_OPPONENT] = "opponent",
                                      [CP_TOWARDS_ANOTHER] = "another"};

static const char *const STATE[] = {
    [CP_ACT_IDLE] = "idle",           [CP_ACT_LIMITED] = "limiting", [CP_ACT_WARNED] = "warned",
    [CP_ACT_REQUESTED] = "requested", [CP_ACT_BRAKED] = "braking",   [CP_ACT_STEERED] = "steering",
    [CP_ACT_RELEASED] = "released"};

static void add_errors(const cp_controls *controls, const cp_impact *impact, int role, size_t count,
                       cp_participant_rows *rows)
{
    cp_error_at at;
    for (size_t k = 0; k < count; k++)
        if (cp_controls_error_at(controls, k, impact->vehicle[role], impact->vehicle[1 - role],
                                 impact->time_s, &at))
            rows->error[rows->error_count++] = (cp_driver_error_row){.role = role,
                                                                     .number = k,
                                                                     .name = at.name,
                                                                     .towards = TOWARDS[at.towards],
                                                                     .began_s = at.began_s,
                                                                     .ended_s = at.ended_s,
                                                                     .is_cause = at.is_cause};
}

static cp_status add_functions(cp_controls *controls, const cp_impact *impact, int role,
                               size_t count, cp_participant_rows *rows, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; k < count && status == CP_OK; k++) {
        cp_function_at found;
        status = cp_controls_function_at(controls, k, impact->vehicle[role], impact->time_s,
                                         impact->state[role].speed_m_s, &found, error);
        if (status != CP_OK)
            break;
        const cp_act_at *act = &found.act;
        rows->function[rows->function_count++] =
            (cp_function_row){.role = role,
                              .number = k,
                              .name = found.name,
                              .state = found.is_equipped ? STATE[act->state] : "not_equipped",
                              .warned_s = act->warned_s,
                              .requested_s = act->requested_s,
                              .braking_s = act->braking_s,
                              .steering_s = act->steering_s,
                              .released_s = act->released_s,
                              .brake_request_m_s2 = act->brake_request_m_s2,
                              .deceleration_m_s2 = act->deceleration_m_s2,
                              .speed_taken_off_m_s = act->speed_taken_off_m_s};
    }
    return status;
}

cp_status cp_participants_of(cp_controls *controls, const cp_impact *impact,
                             const bool had_crashed[2], cp_participant_rows *rows, cp_error *error)
{
    size_t errors = cp_controls_driver_error_count(controls);
    size_t functions = cp_controls_function_count(controls);
    rows->is_known = true;
    rows->error = calloc(2 * errors + 1, sizeof *rows->error);
    rows->function = calloc(2 * functions + 1, sizeof *rows->function);
    if (rows->error == NULL || rows->function == NULL)
        return cp_fail_memory(error, "driver errors and functions of a crash");
    cp_status status = CP_OK;
    for (int role = 0; status == CP_OK && role < 2; role++) {
        if (!had_crashed[role])
            add_errors(controls, impact, role, errors, rows);
        status = add_functions(controls, impact, role, functions, rows, error);
    }
    return status;
}
