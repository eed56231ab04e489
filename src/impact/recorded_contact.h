/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef IMPACT_RECORDED_CONTACT_H
#define IMPACT_RECORDED_CONTACT_H

#include "impact/impact.h"

/* First contact of two vehicles whose ways were recorded elsewhere, by the detector that looks at
 * simulated traffic. */

/* States of one vehicle in order of time, step_length_s apart; it may have been away in between. */
typedef struct cp_recorded_track {
    const cp_vehicle_state *state;
    const double *time_s;
    size_t count;
} cp_recorded_track;

/* Vehicles are carried on by their last motion for this long when the record ends before they touch
 * (SUMO takes colliding vehicles away or puts them elsewhere, and reports some before they touch).
 */
#define CP_RECORDED_CARRY_ON_S 2.0

/* SUMO's first report of the two: in that step it may have taken them away or put them elsewhere
 * before the record was written. */
typedef struct cp_recorded_report {
    double time_s;
    double speed_m_s[2]; /* at its end; NAN where not told */
} cp_recorded_report;

typedef struct cp_recorded_contact {
    bool is_found;   /* they touched, or would have */
    bool is_carried; /* after the end of the record */
    bool is_taken;   /* away or elsewhere in the step of the report: where they were is not known */
    cp_impact impact; /* the first confirmed one; else, with its verdict, the last */
    double gap_m;     /* smallest distance of the rectangles in the record, < 0: depth of overlap;
                         INFINITY when they were never there together */
} cp_recorded_contact;

/* report: NULL when there is none; its speeds are those that vehicles taken away are carried on at.
 * ids: names of the two (role a goes to the smaller one where the sides leave it open);
 * impact.vehicle is 0 for the first track, 1 for the second. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_recorded_contact_find(const cp_recorded_track track[2],
                                                 const char *const ids[2], double step_length_s,
                                                 const cp_recorded_report *report,
                                                 cp_recorded_contact *contact, cp_error *error);

#endif
