/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_MODEL_UNCERTAINTY_H
#define ANALYSIS_MODEL_UNCERTAINTY_H

#include "analysis/slice_sample.h"

/* The model's part of what a comparison says of OLC, over all vehicles of a slice. ensemble may be
 * NULL or of fewer than CP_MODEL_SETS_MIN sets: then nothing is done. Error of all: CP_NO_MEMORY.
 */

/* The median of a variant, with its bootstrap interval, and vehicles without sets. */
CP_MUST_CHECK cp_status cp_model_uncertainty_variant(const cp_study_data *data,
                                                     const cp_model_ensemble *ensemble,
                                                     const cp_replication_set *set, cp_slice slice,
                                                     const cp_resampling *resampling,
                                                     cp_variant_figures *figures, cp_error *error);

/* Difference of medians and Cliff's delta of a contrast whose severity is filled in. */
CP_MUST_CHECK cp_status cp_model_uncertainty_contrast(
    const cp_study_data *data, const cp_model_ensemble *ensemble, const cp_replication_set set[2],
    cp_slice slice, const cp_resampling *resampling, cp_contrast_figures *figures, cp_error *error);

#endif
