/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_BACKGROUND_ROWS_H
#define STORE_BACKGROUND_ROWS_H

#include "core/geometry.h"
#include "core/hash.h"
#include "store/plan_rows.h"
#include "store/store.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The background of one network, as it goes into the database: tables background_run and
 * background_contact. */

typedef struct cp_background_contact_row {
    double time_s;
    cp_vec2 contact_m;
    const char *reason;       /* static: "crash" or a verdict */
    const char *crash_type;   /* static: of confirmed crashes, else "" */
    double closing_speed_m_s; /* of confirmed crashes, else NAN */
    double lateral_offset_m;
    double angle_rad;
    char *vehicle[2]; /* owned; SUMO ids in order of role */
} cp_background_contact_row;

typedef struct cp_background_rows {
    const char *scenario; /* borrowed */
    uint64_t seed;
    double step_length_s;
    double simulated_s; /* after the warm-up, like the next three */
    double vehicle_km;
    double vehicle_h;
    size_t departed;
    char configuration_hash[CP_HASH_TEXT_SIZE]; /* "" unless it is the study's own run */
    char *sumo_version;                         /* owned */
    char *sumo_command_line;                    /* owned */
    cp_background_contact_row *contact;
    size_t contact_count;
} cp_background_rows;

/* A new contact, zeroed; NULL without memory. Valid until the next one. */
cp_background_contact_row *cp_background_rows_add_contact(cp_background_rows *rows);
void cp_background_rows_destroy(cp_background_rows *rows);

/* Write them in one transaction, in place of an earlier run of the same scenario, seed and step
 * length. Errors: CP_BAD_INPUT for a
 * scenario that the database does not have; CP_STORE_FAILED, CP_BUSY. */
CP_MUST_CHECK cp_status cp_background_rows_write(cp_store *store, const cp_background_rows *rows,
                                                 cp_error *error);

/* Whether the database has the scenario. Error: CP_BAD_INPUT if not. */
CP_MUST_CHECK cp_status cp_background_rows_check(cp_store *store, const char *scenario,
                                                 cp_error *error);

/* Delete the study's own runs that are not planned any more: of files or lengths before a change,
 * or more seeds than now. Errors: CP_STORE_FAILED, CP_BUSY, CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_background_rows_drop_stale(cp_store *store, const cp_plan_rows *plan,
                                                      cp_error *error);

/* Which of the background runs that are planned are not there as planned: one entry for each of
 * plan->background. The plan itself must have been written before. */
CP_MUST_CHECK cp_status cp_background_rows_missing(cp_store *store, const cp_plan_rows *plan,
                                                   bool *missing, cp_error *error);

#endif
