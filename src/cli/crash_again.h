/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_CRASH_AGAIN_H
#define CLI_CRASH_AGAIN_H

#include "cli/crash_run.h"
#include "store/stored_crash.h"

/* A crash of a study, simulated again from what the database holds of it. */
typedef struct cp_crash_again {
    cp_stored_crash stored;
    cp_crash_run run; /* result owned: cp_crash_result_destroy */
    cp_stored_match match;
} cp_crash_again;

/* Read crash id of the database (treatment not NULL: what it became under it), simulate it (film
 * may be NULL) and hold the pulses against the stored ones. Errors: those of the store and of the
 * simulation. */
CP_MUST_CHECK cp_status cp_crash_again_simulate(const char *db_path, int64_t crash_id,
                                                const char *treatment, cp_crash_film *film,
                                                cp_crash_again *again, cp_error *error);

/* What the comparison found, to stderr. CP_RUN_FAILED when the pulses are others. */
CP_MUST_CHECK cp_status cp_crash_again_conclude(const cp_crash_again *again, cp_error *error);

#endif
