/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_FIELD_STUDY_H
#define ANALYSIS_FIELD_STUDY_H

#include "analysis/field_table.h"
#include "analysis/study_data.h"

/* The vehicles of a study in the words of a field table. */
typedef struct cp_field_study {
    double *value[CP_FIELD_VALUE_COUNT]; /* of each vehicle of the study; NAN: unknown. Overlap of a
                                            front-front crash's b: a's over the ratio of their
                                            widths, within 30 degrees of oncoming */
} cp_field_study;

/* Read what study data have not. The caller destroys, also after an error. Errors: those of the
 * store; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_field_study_read(cp_store *store, const cp_study_data *data,
                                            cp_field_study *study, cp_error *error);
void cp_field_study_destroy(cp_field_study *study);

#endif
