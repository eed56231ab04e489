/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_FIELD_JSON_H
#define REPORT_FIELD_JSON_H

#include "analysis/field_figures.h"

#include <jansson.h>

/* Figures beside a field as JSON, NULL when memory is gone. */
json_t *cp_field_variant_json(const cp_study_data *data, const cp_field_variant *field);
json_t *cp_field_contrast_json(const cp_study_data *data, const cp_field_contrast *field);

#endif
