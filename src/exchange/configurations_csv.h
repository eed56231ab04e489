/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_CONFIGURATIONS_CSV_H
#define EXCHANGE_CONFIGURATIONS_CSV_H

#include "core/error.h"
#include "core/geometry.h"

#include <stdbool.h>
#include <stddef.h>

/* Lists of crash configurations, one a row: cases of an accident database, of another simulator, of
 * a test plan. A first line names the columns, in any order; fields as in core/csv_row.h (comma or
 * semicolon, a byte order mark and carriage returns may be there); empty lines and lines that begin
 * with # are passed over.
 *
 *   either  speed_a_km_h speed_b_km_h offset_mm angle_deg      as of 'crashpulse crash': b's front
 *                                                              edge in a's frame, 0 oncoming
 *   or      x_a_m y_a_m heading_a_deg speed_a_km_h             centres of gravity and headings
 *           x_b_m y_b_m heading_b_deg speed_b_km_h             (counter-clockwise from +x) before
 *                                                              contact; each goes on with its speed
 *           [yaw_rate_a_deg_s yaw_rate_b_deg_s]                and turn, default 0
 *   and     [id vehicle_a vehicle_b]                           a name; shipped vehicles, or files
 * as seen from the list; default: the caller's */

typedef struct cp_listed_configuration {
    size_t line;         /* of the file */
    char *id;            /* owned; the number of the row, from 1, where the list has none */
    char *vehicle[2];    /* owned; as written; NULL: default */
    double speed_m_s[2]; /* forward, >= 0, not both 0 */
    double offset_m;     /* unless has_poses */
    double angle_rad;    /* likewise */
    cp_pose pose[2];     /* of the centres of gravity */
    double yaw_rate_rad_s[2];
} cp_listed_configuration;

typedef struct cp_configuration_list {
    cp_listed_configuration *row;
    size_t count;
    bool has_poses; /* the second kind */
    char **bad;     /* of each row that was left out, why: file, line and column */
    size_t bad_count;
} cp_configuration_list;

/* The caller destroys. A row whose number of fields is another, with a number that is none or out
 * of range, or with an id that is there already is left out, unless strict. Errors: CP_BAD_INPUT
 * with file, line and column: a column that is unknown, given twice or missing; such a row, where
 * strict or no row is right; CP_NO_MEMORY. After an error the list is destroyed already. */
CP_MUST_CHECK cp_status cp_configurations_csv_read(const char *path, bool strict,
                                                   cp_configuration_list *list, cp_error *error);
/* Empty a row that turns out to be bad (id NULL); why: added to list->bad. Then, once: take the
 * empty rows out, the order of the others stays. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_configuration_list_leave_out(cp_configuration_list *list, size_t row,
                                                        const char *why, cp_error *error);
void cp_configuration_list_close_up(cp_configuration_list *list);
void cp_configuration_list_destroy(cp_configuration_list *list);

#endif
