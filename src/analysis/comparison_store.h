/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_COMPARISON_STORE_H
#define ANALYSIS_COMPARISON_STORE_H

#include "analysis/figures.h"

/* Write a comparison of the groups of `by` (one group and by "" without) as rows of the database.
 * answer may be "". Errors: CP_NO_MEMORY and those of the store. */
CP_MUST_CHECK cp_status cp_comparison_store(cp_store *store, const cp_study_data *data,
                                            const cp_comparison *comparison,
                                            const char *const *group, size_t group_count,
                                            const cp_comparison_options *options,
                                            const char *scenario, const char *by,
                                            const char *where_sql, const char *answer,
                                            cp_error *error);

#endif
