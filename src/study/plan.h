/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_PLAN_H
#define STUDY_PLAN_H

#include "store/plan_rows.h"
#include "study/study.h"

/* Every replication of a study: scenarios x variants x seeds, each with its row id and the hash of
 * everything its outcome depends on; and one background run for every way to start SUMO. */

/* models: one row for each of study->vehicles, in that order (two may be the same model; the first
 * has no name when the study has no default), then any others that its crashes may use; copied. The
 * caller destroys the rows. Errors: CP_BAD_INPUT for two models of one name that differ, or a
 * file that cannot be read; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_plan_create(const cp_study *study, const cp_vehicle_model_row *models,
                                       size_t model_count, cp_plan_rows *rows, cp_error *error);
/* The same for who needs one replication only: the others have no configuration hash, which is most
 * of the work. */
CP_MUST_CHECK cp_status cp_plan_create_for(const cp_study *study,
                                           const cp_vehicle_model_row *models, size_t model_count,
                                           int64_t replication_id, cp_plan_rows *rows,
                                           cp_error *error);
/* And for who only lists them: none has a configuration hash. */
CP_MUST_CHECK cp_status cp_plan_create_unhashed(const cp_study *study,
                                                const cp_vehicle_model_row *models,
                                                size_t model_count, cp_plan_rows *rows,
                                                cp_error *error);
void cp_plan_destroy(cp_plan_rows *rows);

/* The background run of one scenario with the traffic of the baseline's replication `number`,
 * planned or not (then as long as a replication): its seed, length and configuration hash.
 * Errors: CP_BAD_INPUT for a file that cannot be read; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_plan_background(const cp_study *study, size_t scenario, size_t number,
                                           cp_background_plan_row *row, cp_error *error);

/* Seed of replication number of a scenario and variant: a pure function of the study's seed and the
 * scenario's name; with paired seeds the variant takes no part, with independent ones its name
 * does. Values of a sweep share seeds likewise: unless they are independent, the name is the one
 * without them. 31 bits (SUMO's range), different for every number. */
uint64_t cp_plan_seed(const cp_study *study, size_t scenario, size_t variant, size_t number);

/* The planned replication of that row id; NULL when there is none. */
const cp_replication_row *cp_plan_find(const cp_plan_rows *rows, int64_t replication_id);

#endif
