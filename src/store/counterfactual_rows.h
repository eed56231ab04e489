/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_COUNTERFACTUAL_ROWS_H
#define STORE_COUNTERFACTUAL_ROWS_H

#include "store/crash_rows.h"
#include "store/store.h"

#include <stdint.h>

/* What became of each crash of a baseline replication under each treatment, as rows of the
 * database. Columns and outcomes are described in db/schema/002_counterfactual.sql. */

/* X(name, text in the database), in the order in which the first that holds is taken. */
#define CP_OUTCOMES(X)                                                                             \
    X(CP_OUTCOME_INVALID, "invalid")                                                               \
    X(CP_OUTCOME_CHANGED_OPPONENT, "changed_opponent")                                             \
    X(CP_OUTCOME_AVOIDED, "avoided")                                                               \
    X(CP_OUTCOME_MITIGATED, "mitigated")                                                           \
    X(CP_OUTCOME_AGGRAVATED, "aggravated")                                                         \
    X(CP_OUTCOME_UNCHANGED, "unchanged")                                                           \
    X(CP_OUTCOME_NO_OLC, "no_olc") /* by OLC only */

typedef enum cp_outcome {
#define CP_OUTCOME_NAME(name, text) name,
    CP_OUTCOMES(CP_OUTCOME_NAME)
#undef CP_OUTCOME_NAME
} cp_outcome;

const char *cp_outcome_text(cp_outcome outcome);

/* How the null treatment went. X(name, text). */
#define CP_NULL_STATUSES(X)                                                                        \
    X(CP_NULL_REPRODUCED, "reproduced")                                                            \
    X(CP_NULL_INSERTED_LATE, "inserted_late")                                                      \
    X(CP_NULL_NO_CHECKPOINT, "no_checkpoint")                                                      \
    X(CP_NULL_CHECKPOINT_LOST, "checkpoint_lost")                                                  \
    X(CP_NULL_BRANCH_FAILED, "branch_failed")                                                      \
    X(CP_NULL_NOT_REPRODUCED, "not_reproduced")

typedef enum cp_null_status {
#define CP_NULL_STATUS_NAME(name, text) name,
    CP_NULL_STATUSES(CP_NULL_STATUS_NAME)
#undef CP_NULL_STATUS_NAME
} cp_null_status;

const char *cp_null_status_text(cp_null_status status);

#define CP_DETAIL_SIZE 256

/* One vehicle in one step of a time series. */
typedef struct cp_sample_row {
    int role; /* 0 = a, 1 = b of the baseline's crash */
    double time_s;
    cp_vec2 front_m;
    double yaw_rad;
    double speed_m_s;
    double acceleration_m_s2;
    double ttc_s; /* NAN: none */
    double brake_request_m_s2;
} cp_sample_row;

/* One crash under one treatment. */
typedef struct cp_counterfactual_row {
    size_t crash;        /* its number in the replication */
    const char *variant; /* name of the treatment, borrowed */
    cp_outcome outcome;
    cp_outcome outcome_olc;
    cp_null_status reason; /* CP_NULL_REPRODUCED unless invalid */
    char detail[CP_DETAIL_SIZE];
    size_t new_crashes;
    size_t vanished_crashes;
    bool has_crash;
    cp_crash_row treated;  /* owned; if has_crash */
    cp_sample_row *sample; /* owned; NULL when not asked for */
    size_t sample_count;
} cp_counterfactual_row;

/* The null treatment of one crash. */
typedef struct cp_null_treatment_row {
    size_t crash;
    cp_null_status status;
    double lead_s;
    double checkpoint_s; /* NAN: none */
    char detail[CP_DETAIL_SIZE];
    const char *variant; /* name of the baseline, borrowed; for the samples */
    cp_sample_row *sample;
    size_t sample_count;
} cp_null_treatment_row;

/* Zero-initialise, add, write, destroy. */
typedef struct cp_counterfactual_rows {
    cp_null_treatment_row *null_treatment; /* one a crash */
    size_t null_treatment_count;
    cp_counterfactual_row *row; /* one a crash and treatment */
    size_t row_count;
} cp_counterfactual_rows;

/* Append a row, all zero; NULL when memory is gone. Earlier rows may move. */
cp_null_treatment_row *cp_counterfactual_rows_add_null(cp_counterfactual_rows *rows);
cp_counterfactual_row *cp_counterfactual_rows_add(cp_counterfactual_rows *rows);
void cp_counterfactual_rows_destroy(cp_counterfactual_rows *rows);

/* Of the frontally struck vehicles of a crash the larger OLC, g; left-censored ones count as 0.
 * NAN when none is struck on its front or one of them could not be simulated. */
double cp_crash_row_olc_g(const cp_crash_row *crash);

/* Write all of them, in the transaction that writes the replication's crashes. */
CP_MUST_CHECK cp_status cp_counterfactual_rows_write(cp_store *store, int64_t replication_id,
                                                     const cp_counterfactual_rows *rows,
                                                     cp_error *error);

#endif
