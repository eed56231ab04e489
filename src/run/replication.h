/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_REPLICATION_H
#define RUN_REPLICATION_H

#include "run/fleet.h"
#include "store/result_rows.h"
#include "study/study_file.h"

/* One replication from the first step to the last: traffic, drivers and functions, contacts,
 * crashes. In the worker process only. */

/* Simulate and append to results (zeroed but for its id and attempt). The crash library must have
 * begun. Errors: CP_BAD_INPUT for a configuration that does not start, CP_TRAFFIC_FAILED, ... */
CP_MUST_CHECK cp_status cp_replication_run(const cp_study *study, const cp_fleet *fleet,
                                           const cp_replication_row *replication,
                                           cp_result_rows *results, cp_error *error);

/* Whether a scenario starts, makes its first step and takes the controls of every variant. Errors:
 * CP_BAD_INPUT with SUMO's message. */
CP_MUST_CHECK cp_status cp_replication_probe(const cp_study *study,
                                             const cp_study_scenario *scenario, cp_error *error);

#endif
