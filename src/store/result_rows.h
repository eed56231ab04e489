/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_RESULT_ROWS_H
#define STORE_RESULT_ROWS_H

#include "crash/crash_configuration.h"
#include "pulse/severity.h"
#include "store/participant_rows.h"
#include "store/store.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What one replication found, as rows of the database. Texts and blobs are owned by the result.
 * Columns are described in db/schema. */

typedef struct cp_crash_vehicle_row {
    char *sumo_id;
    char *sumo_type;
    char *vehicle_model;
    char *drawn;               /* of the model's parameters, JSON (crash/drawn_car.h); "": none */
    const char *chosen_by;     /* static text: why this model; "" without one */
    char no_model_reason[160]; /* why none; "" with one */
    bool at_fault;
    char *lane;         /* NULL: not known, as the next */
    char *edge;         /* of that lane */
    char *junction;     /* that the lane lies in; NULL on a road, too */
    double mass_kg;     /* of its model; NAN without one */
    cp_body_state body; /* at first contact, world */
    double speed_m_s;
    double length_m;
    double width_m;
    double velocity_angle_rad;
    cp_contact_side side;
    unsigned outside;           /* validity set, 0 = inside */
    const char *evidence_class; /* static text: class of tests that speaks for it; NULL: none */
    double class_error_1;       /* relative error of severity in that class; NAN: not known */
    cp_severity severity;       /* with the OLC status that holds; NAN where there is no value */
    double crush_m;             /* NAN when the simulation failed, as the next two */
    double absorbed_j;
    double ees_m_s;
    double intrusion_m;             /* NAN when the simulation failed */
    const char *intrusion_zone;     /* static text; NULL likewise */
    double olc_sd_g;                /* over the ensemble of its model; NAN without one */
    size_t member_count;            /* 0: no ensemble, or not frontal */
    cp_olc member[CP_ENSEMBLE_MAX]; /* OLC by every parameter set of it */
    void *pulse;                    /* encoded record; NULL when the simulation failed */
    size_t pulse_size;
    size_t sample_count;
    double sample_interval_s;
} cp_crash_vehicle_row;

/* One vehicle in one step before a crash. */
typedef struct cp_history_row {
    int role; /* 0 = a, 1 = b */
    double time_s;
    cp_vec2 front_m;
    double yaw_rad;
    double speed_m_s;
    double acceleration_m_s2;
} cp_history_row;

/* follows of a crash that follows none that is counted. */
#define CP_FOLLOWS_NONE SIZE_MAX

typedef struct cp_crash_row {
    double time_s;
    cp_vec2 contact_m;
    cp_crash_description description;
    double t_common_s;
    double separation_s;
    double shift_m;
    cp_crash_vehicle_row vehicle[2]; /* a, b */
    bool is_secondary;               /* one of the two had crashed before */
    size_t follows; /* number of that crash if is_secondary; CP_FOLLOWS_NONE: not counted */
    cp_history_row *history; /* owned; role a's in order of time, then b's; NULL: none */
    size_t history_count;
    cp_participant_rows participants; /* owned */
} cp_crash_row;

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
/* What a crash row owns; zeroed afterwards. */
void cp_crash_row_destroy(cp_crash_row *crash);

/* Write everything and the status done in one transaction. Errors: CP_RUN_FAILED when the claim was
 * taken away meanwhile; CP_STORE_FAILED, CP_BUSY. */
CP_MUST_CHECK cp_status cp_result_rows_commit(cp_store *store, const cp_result_rows *rows,
                                              cp_error *error);

/* The stored pulse of one vehicle of a crash. The caller destroys it. Errors: CP_BAD_INPUT when
 * there is none or it is damaged. */
CP_MUST_CHECK cp_status cp_result_pulse_read(cp_store *store, int64_t crash_id, const char *role,
                                             cp_pulse *pulse, cp_error *error);

#endif
