/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_CRASH_RUN_H
#define CLI_CRASH_RUN_H

#include "crash/crash_simulation.h"

/* What the command line asks for: a meets b (or the barrier). SI units. */
typedef struct cp_crash_request {
    double speed_m_s;
    double opponent_speed_m_s; /* unused against a barrier */
    double offset_m;
    double angle_rad;
    double duration_s;
} cp_crash_request;

/* One simulated crash. Models are borrowed. */
typedef struct cp_crash_run {
    const cp_vehicle_model *model[2]; /* [1] is NULL against a barrier */
    cp_crash_configuration configuration;
    cp_crash_description description;
    cp_crash_result result; /* owned */
    double duration_s;      /* asked for */
    bool is_damaged;        /* one of the two had crashed before: outside validity */
    bool missed;            /* the two pass each other; simulating is then bad input */
} cp_crash_run;

/* Place the two and simulate; film may be NULL. run->model is set by the caller, who destroys
 * run->result. Errors: those of the simulation; CP_BAD_INPUT when the two miss each other. */
CP_MUST_CHECK cp_status cp_crash_run_simulate(const cp_crash_request *request, cp_crash_run *run,
                                              cp_crash_film *film, cp_error *error);

#endif
