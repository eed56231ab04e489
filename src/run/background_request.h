/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_BACKGROUND_REQUEST_H
#define RUN_BACKGROUND_REQUEST_H

#include "core/error.h"

#include <stdbool.h>
#include <stdint.h>

/* Have a worker process find the background of a network (run/background.h). */

typedef struct cp_background_request {
    const char *path;        /* a .sumocfg, or a study file with the scenario */
    const char *scenario;    /* NULL: path is a .sumocfg */
    const uint64_t *seed;    /* of a scenario: NULL: the study's */
    double step_length_s;    /* of a .sumocfg */
    bool free_outputs;       /* SUMO may write and connect where the scenario says */
    double duration_s;       /* of a scenario: NAN: the study's */
    const char *db_path;     /* of the study: the worker stores the result there too; may be NULL */
    double time_limit_s;     /* it has failed when it takes longer; 0: no limit */
    const char *worker_path; /* NULL: beside the running executable */
} cp_background_request;

/* Its result as JSON text; the caller frees. Errors: those of the worker, with its exit code as
 * CP_BAD_INPUT (2) or CP_RUN_FAILED; CP_IO_FAILED. */
CP_MUST_CHECK cp_status cp_background_request_run(const cp_background_request *request, char **json,
                                                  cp_error *error);

#endif
