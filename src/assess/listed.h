/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ASSESS_LISTED_H
#define ASSESS_LISTED_H

#include "store/result_rows.h"
#include "traffic/traffic.h"

/* What both kinds of lists of ready collisions have in common (collisions.h, configurations.h): a
 * row that cannot be assessed is named by log and counted, the others go on; strict: it is the
 * error CP_BAD_INPUT, as it is when there is no other row. */

/* What of a list became no crash, and how the others were found. */
typedef struct cp_assessment_count {
    size_t listed;
    size_t crashes;
    size_t carried;    /* crashes found beyond the end of the record */
    size_t no_contact; /* the two never touched */
    size_t unknown;    /* SUMO took them away in the step in which they collided */
    size_t bad;        /* could not be assessed: named by log, and left out */
    size_t filtered;   /* touched, and no crash: see the verdict of the contact */
} cp_assessment_count;

/* Leave pulses out of the results, which then take some 2 kB a crash in place of 8: for those that
 * print only. */
typedef enum cp_assessment_keep { CP_KEEP_PULSES, CP_KEEP_NO_PULSES } cp_assessment_keep;

/* How far along its lane a vehicle is where nobody says it: its rear has left the junction behind
 * it. */
#define CP_LISTED_FAR_ALONG_M 1e6

/* SUMO's own car. */
cp_sumo_type cp_listed_standard_car(void);

/* Of the crash added last; without one nothing is done. */
void cp_listed_drop_pulses(cp_result_rows *results);

#endif
