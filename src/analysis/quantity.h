/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_QUANTITY_H
#define ANALYSIS_QUANTITY_H

#include "analysis/quantity_list.h"

/* Append the figures of a variant, of a contrast, of a treatment's pairs. The same names in the
 * same order for every variant of a study. */
void cp_quantities_of_variant(const cp_study_data *data, const cp_variant_figures *figures,
                              cp_quantities *list);
void cp_quantities_of_contrast(const cp_study_data *data, const cp_contrast_figures *figures,
                               cp_quantities *list);
void cp_quantities_of_pairs(const cp_study_data *data, const cp_counterfactual_figures *figures,
                            cp_quantities *list);

#endif
