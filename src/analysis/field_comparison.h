/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_FIELD_COMPARISON_H
#define ANALYSIS_FIELD_COMPARISON_H

#include "analysis/field_figures.h"

/* A study laid beside the field: how far their frontally struck vehicles lie apart, and the figures
 * of a comparison with each vehicle of the baseline weighted so that crash type, delta-v without
 * rebound and overlap have the field's margins.
 *
 * The weight of a crash is the mean of those of its frontally struck vehicles in the slice. In the
 * counterfactual design a pair keeps the weight of the baseline's crash. In the others a treated
 * crash has no baseline crash of its own and takes the weight of baseline crashes of its classes.
 * Delta-v is what treatments change: a study of too severe crashes would give each crash that a
 * treatment makes milder a larger weight than it had, and hide the treatment. So treatments are
 * compared with weights of the other margins, and with delta-v too beside it, which is right where
 * the study makes too few or too many crashes of a class in both variants alike. */

/* Add the field to a comparison made by cp_compare with the same options and request in them: fills
 * the field of every variant, contrast and treatment with pairs. Errors: CP_BAD_INPUT for a field
 * none of whose margins is known, too many risk functions; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_field_compare(const cp_study_data *data,
                                         const cp_comparison_options *options,
                                         cp_comparison *comparison, cp_error *error);

#endif
