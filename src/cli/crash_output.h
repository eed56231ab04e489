/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_CRASH_OUTPUT_H
#define CLI_CRASH_OUTPUT_H

#include "cli/crash_run.h"
#include "cli/output.h"

/* JSON: {"configuration": {...}, "vehicles": [{"role", "name", "olc_g", "olc_status", ...}]}; CSV:
 * one row a vehicle; table: one column a vehicle. What does not exist is null or empty. */
CP_MUST_CHECK cp_status cp_crash_print(const cp_crash_run *run, cp_format format, FILE *file,
                                       cp_error *error);

/* Speeds, offset, angle in words, two lines and an empty one; the same as JSON, NULL when memory is
 * gone. */
void cp_crash_print_configuration(const cp_crash_run *run, FILE *file);
json_t *cp_crash_configuration_json(const cp_crash_run *run);

/* Pulses of all vehicles as CSV, accelerations through CFC60 unless raw. */
CP_MUST_CHECK cp_status cp_crash_write_pulse(const cp_crash_run *run, bool raw, const char *path,
                                             cp_error *error);

#endif
