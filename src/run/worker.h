/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_WORKER_H
#define RUN_WORKER_H

#include "core/error.h"

#include <stdbool.h>
#include <stdint.h>

/* What a worker process does: one replication, one background, or one probe. SUMO allows one
 * simulation a process and may abort it; so whatever happens here happens to this process only. */

/* Exit codes of a worker that did what it was started for, and of one that found its replication
 * taken or finished by somebody else. Not 0: a library that ends the process on its own, with
 * whatever code, has done nothing. */
#define CP_WORKER_EXIT_DONE 40
#define CP_WORKER_EXIT_ELSEWHERE 41
/* Descriptor on which it tells the runner what went wrong: the text of the error, nothing else. */
#define CP_WORKER_REPORT_FD 3

/* Before SUMO is started, every one of the following confines the process (run/confinement.h) to
 * the folders of the scenario's .sumocfg and of the database and to the result file; unless
 * free_outputs: whoever started it lets SUMO write and connect where the scenario says. */

/* Claim, run and commit one replication of the study. allow_plugins: libraries that the study
 * brings along are loaded; without, a study with one is refused. *elsewhere tells that it was not
 * to be had; that is no error. The database is closed while the replication runs. */
CP_MUST_CHECK cp_status cp_worker_run(const char *study_path, const char *db_path,
                                      int64_t replication_id, bool free_outputs, bool allow_plugins,
                                      int *elsewhere, cp_error *error);

/* Start a scenario of the study and make one step. Errors: CP_BAD_INPUT with SUMO's message. */
CP_MUST_CHECK cp_status cp_worker_probe(const char *study_path, const char *scenario,
                                        bool free_outputs, cp_error *error);

/* The background of a network (run/background.h): of a .sumocfg, or of a scenario of a study, with
 * its configuration, options, step length, warm-up and time that crashed cars stay. */
typedef struct cp_background_job {
    const char *path;          /* a .sumocfg, or the study file with the scenario */
    const char *scenario;      /* NULL: path is a .sumocfg */
    const uint64_t *seed;      /* NULL: the study's */
    double step_length_s;      /* of a .sumocfg */
    double duration_s;         /* NAN: the study's */
    const char *expected_hash; /* the study's own run must have this configuration; may be NULL */
    const char *db_path;       /* of the study, for the result; NULL: not stored */
    const char *result_path;   /* for the result as JSON, a file that is there; NULL: nowhere */
    bool free_outputs;
} cp_background_job;

/* Run and commit it. The database is closed meanwhile. Errors: CP_BAD_INPUT, also for a scenario
 * that study or database do not have, or a configuration that has changed. */
CP_MUST_CHECK cp_status cp_worker_background(const cp_background_job *job, cp_error *error);

#endif
