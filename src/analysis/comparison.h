/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_COMPARISON_H
#define ANALYSIS_COMPARISON_H

#include "analysis/figures.h"

/* Compare every variant with the variant baseline. The study's seed drives bootstrap and
 * permutations: same database, same numbers. The caller destroys, also after an error. Error:
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_compare(const cp_study_data *data, size_t baseline, cp_slice slice,
                                   const cp_comparison_options *options, cp_comparison *comparison,
                                   cp_error *error);

#endif
