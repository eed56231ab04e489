/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_COMPARISON_ROWS_H
#define STORE_COMPARISON_ROWS_H

#include "store/store.h"

#include <stddef.h>
#include <stdint.h>

/* The results of a comparison as rows that SQL can join. Columns: db/schema/005_comparison.sql. */

typedef struct cp_comparison_figure_row {
    const char *by_value;
    const char *variant;
    const char *against;
    const char *scope;
    const char *quantity;
    const char *relation;
    double value; /* NAN or infinite: NULL */
    double low;
    double high;
    const char *interval; /* NULL: none is meant */
} cp_comparison_figure_row;

/* All texts are borrowed; empty, not NULL, where nothing was asked for. */
typedef struct cp_comparison_rows {
    const char *baseline;
    const char *scenario;
    const char *by;
    const char *where_sql;
    const char *design;
    uint64_t seed;
    size_t repetitions;
    size_t permutations;
    size_t replications;
    size_t crashes;
    const char *answer;
    const cp_comparison_figure_row *figure;
    size_t figure_count;
} cp_comparison_rows;

/* Write them in one transaction in place of the same comparison made before. Errors: CP_BUSY,
 * CP_STORE_FAILED. */
CP_MUST_CHECK cp_status cp_comparison_rows_replace(cp_store *store, const cp_comparison_rows *rows,
                                                   cp_error *error);

#endif
