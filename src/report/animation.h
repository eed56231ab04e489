/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_ANIMATION_H
#define REPORT_ANIMATION_H

#include "crash/crash_simulation.h"

#include <jansson.h>

/* A page of its own that shows crashes from above over time, with acceleration, velocity and
 * displacement beside them. */

#define CP_ANIMATED_RUNS_MAX 2

/* A filmed crash; all borrowed. */
typedef struct cp_animated_run {
    const cp_vehicle_model *model[2]; /* [1] NULL against a barrier */
    const cp_crash_configuration *configuration;
    const cp_crash_description *description;
    const cp_crash_result *result;
    const cp_crash_film *film;
} cp_animated_run;

/* A filmed crash as the page's script takes it: what it is, poses and parts over time, pulses.
 * *json is the caller's to release. Errors: CP_NO_MEMORY, CP_BAD_INPUT for a run without frames. */
CP_MUST_CHECK cp_status cp_animation_run_json(const cp_animated_run *run, json_t **json,
                                              cp_error *error);

/* Write the page: the first run in full, a second one laid over it, both from the first contact on
 * in a's axes. The file needs nothing but itself. Errors: CP_NO_MEMORY, CP_IO_FAILED, CP_BAD_INPUT
 * for a run without frames. */
CP_MUST_CHECK cp_status cp_animation_write(const cp_animated_run *run, size_t run_count,
                                           const char *path, cp_error *error);

#endif
