/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_COMPARISON_TABLE_H
#define CLI_COMPARISON_TABLE_H

#include "analysis/figures.h"
#include "cli/output.h"

/* A comparison for the terminal: one row a quantity, one column a variant, then the answer (NULL:
 * none). heading (NULL: none) comes first. */
CP_MUST_CHECK cp_status cp_comparison_print_table(const cp_study_data *data,
                                                  const cp_comparison *comparison,
                                                  const char *heading, const char *answer,
                                                  FILE *file, cp_error *error);

/* A paragraph after an empty line, broken like the answer. */
void cp_comparison_print_paragraph(const char *text, FILE *file);

/* The same numbers in long form, of several groups: variant,against,scope,quantity,relation,value,
 * low,high,interval, with a column by_value in front when group is not NULL. against is empty for
 * figures of one variant; relation is "=", "<" or ">"; interval names the kind of low and high, or
 * why there is none. */
CP_MUST_CHECK cp_status cp_comparison_print_csv(const cp_study_data *data,
                                                const cp_comparison *comparison,
                                                const char *const *group, size_t count, FILE *file,
                                                cp_error *error);

#endif
