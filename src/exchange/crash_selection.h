/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_CRASH_SELECTION_H
#define EXCHANGE_CRASH_SELECTION_H

#include "exchange/pulse_record.h"
#include "store/store.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Crashes of a database with their stored pulses, one after the other, whatever their number: at no
 * time is there more than one in memory. */

/* Which: all that hold together. */
typedef struct cp_crash_selection {
    int64_t crash_id; /* -1: any */
    const char
        *treatment;       /* what crashes became under this variant; NULL: the crashes themselves */
    const char *scenario; /* NULL: any */
    const char *where;    /* SQL about columns of the view crash_vehicle_list, of which one vehicle
                             of the crash must hold; NULL: any. Runs read-only */
    bool with_pulses;     /* else records have no samples */
} cp_crash_selection;

typedef struct cp_selected_vehicle {
    const char *sumo_id; /* texts are valid during the visit, NULL-free */
    const char *sumo_type;
    const char *vehicle_model;
    const char *contact_side;
    const char *validity;
    const char *olc_status;
    bool at_fault;
    double speed_m_s;
    double olc_g; /* NAN: none, likewise below */
    double delta_v_m_s;
    bool has_pulse;
    cp_pulse_record record; /* accelerations CFC180, about 1 kHz */
} cp_selected_vehicle;

typedef struct cp_selected_crash {
    int64_t id;
    const char *treatment; /* "": none */
    const char *scenario;
    const char *variant;
    int64_t replication; /* number */
    double time_s;       /* SUMO clock */
    double x_m;          /* first contact point, world */
    double y_m;
    const char *crash_type;
    double closing_speed_m_s;
    double lateral_offset_m;
    double angle_rad;
    double overlap_1; /* NAN: none */
    const char *validity;
    cp_selected_vehicle vehicle[2]; /* roles a and b */
} cp_selected_crash;

/* Anything but CP_OK ends the selection and is passed on. */
typedef cp_status (*cp_crash_visit)(void *context, const cp_selected_crash *crash, cp_error *error);

/* How many crashes are selected. Errors: CP_BAD_INPUT for SQL that is wrong or writes, a treatment
 * or scenario that the database does not have; CP_STORE_FAILED, CP_BUSY. */
CP_MUST_CHECK cp_status cp_crash_selection_count(cp_store *store,
                                                 const cp_crash_selection *selection, size_t *count,
                                                 cp_error *error);

/* Visit them in order of their ids. Errors: as above; CP_BAD_INPUT for a damaged pulse. */
CP_MUST_CHECK cp_status cp_crash_selection_visit(cp_store *store,
                                                 const cp_crash_selection *selection,
                                                 cp_crash_visit visit, void *context,
                                                 cp_error *error);

#endif
