/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_FIELD_OUTPUT_H
#define CLI_FIELD_OUTPUT_H

#include "analysis/field_comparison.h"

#include <stdio.h>

/* The baseline's vehicles beside the field's as a table: shares of classes, medians, distances.
 * Nothing without a field. Errors: CP_NO_MEMORY, CP_RUN_FAILED when file cannot be written. */
CP_MUST_CHECK cp_status cp_field_print_table(const cp_comparison *comparison, FILE *file,
                                             cp_error *error);

#endif
