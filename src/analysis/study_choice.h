/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_STUDY_CHOICE_H
#define ANALYSIS_STUDY_CHOICE_H

#include "analysis/study_data.h"

/* Which vehicles a condition chooses: chosen[k] is 1 for vehicle k, else 0. where is SQL over a row
 * of the view crash_vehicle_list (NULL: all). With by, a column of that view, group[k] is the index
 * of the vehicle's value among values (texts, in order; the caller frees with
 * cp_study_choice_destroy). Errors: CP_BAD_INPUT for SQL that is wrong. */
typedef struct cp_study_choice {
    unsigned char *chosen;
    size_t *group; /* SIZE_MAX: not chosen; NULL without by */
    size_t value_count;
    char **value;
} cp_study_choice;

#define CP_CHOICE_VALUES_MAX 100 /* groups of by */

CP_MUST_CHECK cp_status cp_study_choose(cp_store *store, const cp_study_data *data,
                                        const char *where, const char *by, cp_study_choice *choice,
                                        cp_error *error);
void cp_study_choice_destroy(cp_study_choice *choice);

#endif
