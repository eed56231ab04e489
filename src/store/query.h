/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_QUERY_H
#define STORE_QUERY_H

#include "store/store.h"

#include <stddef.h>
#include <stdint.h>

/* Any reading SQL, row by row with typed cells: for tables on the terminal, JSON for reports, and
 * numbers for statistics. */

typedef enum cp_cell_type {
    CP_CELL_NULL,
    CP_CELL_INTEGER,
    CP_CELL_REAL,
    CP_CELL_TEXT,
    CP_CELL_BLOB
} cp_cell_type;

/* One value. integer is set for INTEGER; real for INTEGER and REAL (NAN otherwise); text (zero-
 * terminated) and size for TEXT and BLOB, text is "" otherwise, never NULL. */
typedef struct cp_cell {
    cp_cell_type type;
    int64_t integer;
    double real;
    const char *text;
    size_t size; /* bytes of text */
} cp_cell;

/* One row; everything in it is valid until the callback returns. */
typedef struct cp_row {
    size_t column_count;
    const char *const *column; /* names as the query gives them */
    const cp_cell *cell;
} cp_row;

/* What to do with the rows. columns (may be NULL) is called once before the first row, also when
 * there is none, with cell NULL. A status other than CP_OK from a callback ends the query and is
 * passed on. */
typedef struct cp_query_handler {
    cp_status (*columns)(void *context, const cp_row *row, cp_error *error);
    cp_status (*row)(void *context, const cp_row *row, cp_error *error);
    void *context;
} cp_query_handler;

/* Run one reading statement; parameter_count values are bound to ?1, ?2, ... (parameters may be
 * NULL when 0). Errors: CP_BAD_INPUT with SQLite's words for SQL that is wrong, that writes, or
 * that is more than one statement; CP_BUSY; CP_STORE_FAILED. */
CP_MUST_CHECK cp_status cp_query(cp_store *store, const char *sql, const cp_cell *parameters,
                                 size_t parameter_count, const cp_query_handler *handler,
                                 cp_error *error);

/* Parameters. text is borrowed. */
cp_cell cp_cell_integer(int64_t value);
cp_cell cp_cell_real(double value); /* NAN becomes NULL */
cp_cell cp_cell_text(const char *text);

/* The one value of a query with one row and one column as a number; an error otherwise. */
CP_MUST_CHECK cp_status cp_query_number(cp_store *store, const char *sql, double *value,
                                        cp_error *error);

#endif
