/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_RESULT_ROWS_H
#define STORE_RESULT_ROWS_H

#include "store/crash_rows.h"
#include "store/store.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What one replication found, as rows of the database. Texts and blobs are owned by the result.
 * Columns are described in db/schema. */

typedef struct cp_contact_row {
    double time_s;
    cp_vec2 contact_m;
    const char *verdict; /* static text */
    char *vehicle[2];
} cp_contact_row;

typedef struct cp_sumo_collision_row {
    double time_s;
    char *collider;
    char *victim;
    char *type;
    const char *found_as; /* static text */
    double gap_m;         /* between our rectangles; < 0 overlap; NAN unknown */
} cp_sumo_collision_row;

struct cp_counterfactual_rows;

/* Zero-initialise, add, commit, destroy. */
typedef struct cp_result_rows {
    int64_t replication_id;
    int attempt; /* the claim these results belong to */
    char *sumo_version;
    char *sumo_command_line;
    double simulated_s;
    double vehicle_km;
    double vehicle_h;
    size_t departed;
    char *counters;      /* JSON */
    char *crash_options; /* JSON: cp_crash_options_json and the vehicle types */
    double wall_time_s;
    cp_crash_row *crash; /* in order of time, then ids: their numbers */
    size_t crash_count;
    cp_contact_row *contact;
    size_t contact_count;
    cp_sumo_collision_row *sumo_collision;
    size_t sumo_collision_count;
    struct cp_counterfactual_rows *counterfactual; /* owned; NULL in other designs */
} cp_result_rows;

/* Append a row, all zero, for the caller to fill; NULL when memory is gone. Earlier rows may move.
 */
cp_crash_row *cp_result_rows_add_crash(cp_result_rows *rows);
cp_contact_row *cp_result_rows_add_contact(cp_result_rows *rows);
cp_sumo_collision_row *cp_result_rows_add_sumo_collision(cp_result_rows *rows);
void cp_result_rows_destroy(cp_result_rows *rows);

/* Write everything and the status done in one transaction. Errors: CP_RUN_FAILED when the claim was
 * taken away meanwhile; CP_STORE_FAILED, CP_BUSY. */
CP_MUST_CHECK cp_status cp_result_rows_commit(cp_store *store, const cp_result_rows *rows,
                                              cp_error *error);

#endif
