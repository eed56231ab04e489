/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_CRASH_ROWS_H
#define STORE_CRASH_ROWS_H

#include "crash/crash_configuration.h"
#include "pulse/severity.h"
#include "store/participant_rows.h"

#include <stdbool.h>
#include <stddef.h>

/* One crash as rows of the database, of a replication or of a treated pair. Texts and blobs are
 * owned by the row. Columns are described in db/schema. */

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

/* What a crash row owns; zeroed afterwards. */
void cp_crash_row_destroy(cp_crash_row *crash);

#endif
