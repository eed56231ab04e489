/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_CRASH_OUTPUT_H
#define CLI_CRASH_OUTPUT_H

#include "cli/output.h"
#include "crash/crash_simulation.h"

/* One simulated crash, as the command line shows it. */
typedef struct cp_crash_run {
    const cp_vehicle_model *model[2]; /* [1] is NULL against a barrier */
    cp_crash_configuration configuration;
    cp_crash_description description;
    cp_crash_result result;
    double duration_s; /* asked for */
} cp_crash_run;

/* JSON: {"configuration": {...}, "vehicles": [{"role", "name", "olc_g", "olc_status", ...}]}; CSV:
 * one row a vehicle; table: one column a vehicle. What does not exist is null or empty. */
CP_MUST_CHECK cp_status cp_crash_print(const cp_crash_run *run, cp_format format, FILE *file,
                                       cp_error *error);

/* Pulses of all vehicles as CSV, accelerations through CFC60 unless raw. */
CP_MUST_CHECK cp_status cp_crash_write_pulse(const cp_crash_run *run, bool raw, const char *path,
                                             cp_error *error);

#endif
