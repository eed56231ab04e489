/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_OUTPUT_H
#define CLI_OUTPUT_H

#include "core/error.h"

#include <jansson.h>

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Results for people (a table, numbers rounded) and for programs (JSON and CSV, numbers with 17
 * significant digits, so that reading them gives the same bits back). */

typedef enum cp_format { CP_FORMAT_TABLE, CP_FORMAT_JSON, CP_FORMAT_CSV } cp_format;

/* "table", "json" or "csv"; false for anything else. */
bool cp_format_from_text(const char *text, cp_format *format);

/* Cells row by row. Zero-initialise; after a failed call go on, the first failure is reported by
 * cp_table_print. */
typedef struct cp_table {
    size_t column_count;
    size_t row_count;
    json_t *columns;   /* names */
    json_t *cells;     /* row by row: null, integer, real, text */
    size_t right_from; /* columns from this one on stand right; 0: those of numbers only */
    bool failed;       /* memory is gone */
} cp_table;

/* Start with columns. The caller destroys. */
void cp_table_begin(cp_table *table, const char *const *column, size_t column_count);
void cp_table_destroy(cp_table *table);

/* Add the next cell; rows follow each other. Real numbers that are not finite are null. */
void cp_table_null(cp_table *table);
void cp_table_integer(cp_table *table, int64_t value);
void cp_table_real(cp_table *table, double value);
void cp_table_text(cp_table *table, const char *text);
/* Takes the reference of value; NULL is a failure. */
void cp_table_json(cp_table *table, json_t *value);

/* Print: numbers right, text left; JSON as an array of objects. Errors: CP_NO_MEMORY,
 * CP_IO_FAILED. */
CP_MUST_CHECK cp_status cp_table_print(const cp_table *table, cp_format format, FILE *file,
                                       cp_error *error);

/* Print a JSON value with all digits, indented, and release it; NULL is CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_json_print(json_t *value, FILE *file, cp_error *error);

/* One CSV field of text, quoted where it must be. One that begins with = + - @ and is no number
 * gets a ' in front, so that no spreadsheet takes it for a formula. */
void cp_csv_text(FILE *file, const char *text);

#endif
