/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_EXCEEDANCE_FIGURES_H
#define ANALYSIS_EXCEEDANCE_FIGURES_H

#include "analysis/slice_sample.h"

/* Crashes above a severity: curve and headline of a variant, headline of a contrast. Error:
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_exceedance_figure(const cp_study_data *data,
                                             const cp_replication_set *set, cp_slice slice,
                                             const cp_comparison_options *options,
                                             cp_variant_figures *figures, cp_error *error);
CP_MUST_CHECK cp_status cp_exceedance_contrast(const cp_study_data *data,
                                               const cp_replication_set set[2], cp_slice slice,
                                               const cp_resampling *resampling,
                                               const cp_comparison_options *options,
                                               cp_contrast_figures *figures, cp_error *error);

/* The same curve of a sample of one value a crash; events: room for the set's replications. */
void cp_exceedance_curve(const cp_sample *sample, const cp_replication_set *set, int what,
                         double *events, cp_exceedance curve[CP_EXCEEDANCE_POINTS]);

#endif
