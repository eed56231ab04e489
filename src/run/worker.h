/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_WORKER_H
#define RUN_WORKER_H

#include "core/error.h"

#include <stdint.h>

/* What a worker process does: one replication, or one probe. SUMO allows one simulation a process
 * and may abort it; so whatever happens here happens to this process only. */

/* Exit code of a worker that found its replication taken or finished by somebody else. */
#define CP_WORKER_EXIT_ELSEWHERE 3
/* Descriptor on which it tells the runner what went wrong: the text of the error, nothing else. */
#define CP_WORKER_REPORT_FD 3

/* Claim, run and commit one replication of the study. *elsewhere tells that it was not to be had;
 * that is no error. The database is closed while the replication runs. */
CP_MUST_CHECK cp_status cp_worker_run(const char *study_path, const char *db_path,
                                      int64_t replication_id, int *elsewhere, cp_error *error);

/* Start a scenario of the study and make one step. Errors: CP_BAD_INPUT with SUMO's message. */
CP_MUST_CHECK cp_status cp_worker_probe(const char *study_path, const char *scenario,
                                        cp_error *error);

/* The background of a network (run/background.h): of a .sumocfg, or of a scenario of a study (its
 * configuration, options and step length; scenario NULL: the .sumocfg itself). Result as JSON. */
CP_MUST_CHECK cp_status cp_worker_background(const char *path, const char *scenario, uint64_t seed,
                                             double step_length_s, double duration_s,
                                             const char *result_path, cp_error *error);

#endif
