/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_GROUPING_H
#define ANALYSIS_GROUPING_H

#include "analysis/figures.h"
#include "analysis/study_choice.h"

/* The slices a user asks for: of one scenario or all, restricted by an SQL condition, and one for
 * each value of a column. */
typedef struct cp_grouping {
    size_t count;
    cp_slice *slice;
    const char **name; /* value of the column; "" without one. Borrowed from here or the study */
    cp_study_choice choice;
    unsigned char *chosen; /* of all slices, one after the other */
} cp_grouping;

/* scenario, by, where: NULL when not asked for. by "scenario" splits exposure too; every other by
 * is a column of the view crash_vehicle_list. The caller destroys. Errors: CP_BAD_INPUT for a
 * scenario, column or condition that is wrong, and when nothing fits; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_grouping_create(cp_store *store, const cp_study_data *data,
                                           const char *scenario, const char *by, const char *where,
                                           cp_grouping *grouping, cp_error *error);
void cp_grouping_destroy(cp_grouping *grouping);

#endif
