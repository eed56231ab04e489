/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/suite.h"

#include <stdlib.h>

static void destroy_texts(cp_suite_texts *texts)
{
    for (size_t k = 0; k < texts->count; k++)
        free(texts->text[k]);
    free(texts->text);
}

static void destroy_class(cp_suite_class *class)
{
    for (size_t c = 0; c < class->comparison_count; c++) {
        cp_suite_comparison *comparison = &class->comparison[c];
        free(comparison->times_ms.value);
        free(comparison->reference.value);
        free(comparison->low.value);
        free(comparison->high.value);
    }
    free(class->comparison);
    free(class->table_path);
    free(class->speeds_km_h.value);
    free(class->opponent_speeds_km_h.value);
    free(class->overlaps_1.value);
    free(class->sides_1.value);
    free(class->angles_deg.value);
    free(class->struck_speeds_km_h.value);
    free(class->at_mm.value);
    free(class->struck_forces_1.value);
    destroy_texts(&class->rows_with);
    destroy_texts(&class->vehicles);
    destroy_texts(&class->against);
}

void cp_suite_destroy(cp_suite *suite)
{
    for (size_t k = 0; k < suite->class_count; k++)
        destroy_class(&suite->class[k]);
    free(suite->class);
    destroy_texts(&suite->vehicles);
    free(suite->quantiles_path);
    free(suite->path);
    *suite = (cp_suite){0};
}
