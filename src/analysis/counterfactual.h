/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_COUNTERFACTUAL_H
#define ANALYSIS_COUNTERFACTUAL_H

#include "analysis/slice_sample.h"

/* Strictly paired comparison: each frontal crash of the baseline beside what became of it under a
 * treatment. Pairs of one replication belong together in every interval and test. */

/* Fill comparison->counterfactual for the comparison's slice. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_compare_counterfactual(const cp_study_data *data,
                                                  const cp_comparison_options *options,
                                                  cp_comparison *comparison, cp_error *error);

/* Outcomes and their shares alone, over the replications of a set of the baseline: fills the counts
 * and share of figures (zero but for its variant). Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_counterfactual_outcomes(const cp_study_data *data, cp_slice slice,
                                                   const cp_replication_set *set,
                                                   cp_counterfactual_figures *figures,
                                                   cp_error *error);

#endif
