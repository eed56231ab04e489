/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_BACKGROUND_ROWS_H
#define STORE_BACKGROUND_ROWS_H

#include "store/store.h"

#include <stddef.h>
#include <stdint.h>

/* The background of one network as rows of table background. Texts are borrowed. */

typedef struct cp_background_contact {
    const char *reason;
    const char *crash_type; /* "" but for crashes */
    int64_t contacts;
} cp_background_contact;

typedef struct cp_background_rows {
    const char *scenario;
    uint64_t seed;
    double step_length_s;
    double simulated_s;
    double vehicle_km;
    const cp_background_contact *contacts;
    size_t count;
} cp_background_rows;

/* Write them in one transaction, in place of an earlier run of the same scenario, seed and step
 * length; without contacts one row says so. Errors: CP_BAD_INPUT for a scenario that the database
 * does not have; CP_STORE_FAILED, CP_BUSY. */
CP_MUST_CHECK cp_status cp_background_rows_write(cp_store *store, const cp_background_rows *rows,
                                                 cp_error *error);

#endif
