/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_STORED_CRASH_H
#define STORE_STORED_CRASH_H

#include "crash/crash_simulation.h"
#include "store/store.h"

#include <stdbool.h>
#include <stdint.h>

/* A crash as the database holds it, one of the study or what became of one under a treatment: all
 * it takes to simulate it again. No file is needed. */
typedef struct cp_stored_crash {
    int64_t id;
    bool is_treated;    /* of the design counterfactual, */
    int64_t variant_id; /* under this treatment */
    char treatment[128];
    cp_vehicle_model model[2]; /* from the vehicle files in the database */
    cp_crash_configuration configuration;
    cp_crash_description description;
    cp_crash_options options;
    char crashpulse_version[32]; /* that simulated it */
    double time_s;               /* SUMO clock */
    bool is_secondary;           /* one of the two had crashed before */
    char sumo_id[2][128];
} cp_stored_crash;

/* Read crash id; with treatment (the name of a variant, else NULL) the one it became under it.
 * Errors: CP_BAD_INPUT when there is none, or a vehicle file in the database is not understood by
 * this program; CP_STORE_FAILED, CP_BUSY. */
CP_MUST_CHECK cp_status cp_stored_crash_read(cp_store *store, int64_t crash_id,
                                             const char *treatment, cp_stored_crash *crash,
                                             cp_error *error);

/* How a new simulation compares with the stored pulses. */
typedef enum cp_stored_match {
    CP_STORED_SAME_BYTES,   /* after the codec, the very bytes */
    CP_STORED_SAME_SAMPLES, /* packed otherwise (an earlier codec), the same samples */
    CP_STORED_NOTHING,      /* no pulse is stored: the simulation failed then */
    CP_STORED_DIFFERENT
} cp_stored_match;

/* Hold the pulses of result (of both vehicles) against those stored of the crash. Errors:
 * CP_BAD_INPUT for a stored pulse that is damaged; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_stored_crash_compare(cp_store *store, const cp_stored_crash *crash,
                                                const cp_crash_result *result,
                                                cp_stored_match *match, cp_error *error);

/* The crash options as JSON of the column replication.crash_options; the caller frees. NULL when
 * memory is gone. */
char *cp_crash_options_json(const cp_crash_options *options);

#endif
