/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_CONTACT_ROWS_H
#define RUN_CONTACT_ROWS_H

#include "impact/impact.h"
#include "store/result_rows.h"

/* Contacts that are no crash, and SUMO's own collisions, as rows of the results. */

/* Add a contact of ours. verdict: static text; ids: of its vehicles by role, copied. Error:
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_contact_rows_add(cp_result_rows *results, const cp_impact *impact,
                                            const char *verdict, const char *const ids[2],
                                            cp_error *error);

/* A collision as SUMO reports it; texts are borrowed. */
typedef struct cp_reported_collision {
    double time_s;
    const char *collider, *victim; /* ids */
    const char *type;
    const char *found_as; /* static text */
    double gap_m;         /* of the two rectangles; not finite: not known */
} cp_reported_collision;

/* Add it, its texts copied. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_contact_rows_add_report(cp_result_rows *results,
                                                   const cp_reported_collision *report,
                                                   cp_error *error);

#endif
