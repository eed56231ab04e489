/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_FIELD_QUANTITY_H
#define ANALYSIS_FIELD_QUANTITY_H

#include "analysis/field_figures.h"
#include "analysis/quantity_list.h"

/* Append to the figures of a variant, contrast or treatment with pairs; nothing without a field. */
void cp_field_quantities_of_variant(const cp_study_data *data, const cp_field_variant *field,
                                    cp_quantities *list);
void cp_field_quantities_of_contrast(const cp_study_data *data, const cp_field_contrast *field,
                                     cp_quantities *list);

#endif
