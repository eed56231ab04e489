/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_CSV_TABLE_H
#define CORE_CSV_TABLE_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>

/* A CSV file with a header and named columns, as the reference tables of a suite are. Lines that
 * begin with '#' are comments, empty ones do not count. Comma or semicolon, quotes and byte order
 * mark as in csv_row.h. */
typedef struct cp_csv_table {
    char *path;
    char *content; /* the fields point into it */
    size_t *line;  /* of each row in the file, from 1 */
    char **field;  /* row by row, column_count each */
    char **column; /* names */
    char separator;
    size_t column_count;
    size_t row_count;
} cp_csv_table;

/* Load. Errors: CP_BAD_INPUT with file and line (a row of another number of fields, no row at all).
 * The caller destroys, also after an error. */
CP_MUST_CHECK cp_status cp_csv_table_load(const char *path, cp_csv_table *table, cp_error *error);
/* The same from zero-terminated text, which the table owns from here on; path names it in errors.
 */
CP_MUST_CHECK cp_status cp_csv_table_parse(const char *path, char *content, cp_csv_table *table,
                                           cp_error *error);
void cp_csv_table_destroy(cp_csv_table *table);

/* Text of a column in a row. Errors: CP_BAD_INPUT naming a column that is missing. */
CP_MUST_CHECK cp_status cp_csv_table_text(const cp_csv_table *table, size_t row, const char *column,
                                          const char **text, cp_error *error);
/* Number within [smallest, largest]; where blank is allowed an empty field is NAN. Errors:
 * CP_BAD_INPUT with file, line, column, what was found and what is allowed. */
CP_MUST_CHECK cp_status cp_csv_table_number(const cp_csv_table *table, size_t row,
                                            const char *column, double smallest, double largest,
                                            bool blank_allowed, double *value, cp_error *error);

#endif
