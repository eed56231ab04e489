/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_EXAMPLE_QUERY_H
#define REPORT_EXAMPLE_QUERY_H

#include <stddef.h>

/* The files of db/queries: what users ask, and what stands behind the figures of a report. */
typedef struct cp_example_query {
    const char *name; /* of the file, without .sql */
    const char *sql;  /* the whole file, opening comment included */
} cp_example_query;

extern const cp_example_query CP_EXAMPLE_QUERY[];
extern const size_t CP_EXAMPLE_QUERY_COUNT;

#endif
