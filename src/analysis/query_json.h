/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_QUERY_JSON_H
#define ANALYSIS_QUERY_JSON_H

#include "store/query.h"

#include <jansson.h>

/* One cell as a JSON value; a blob becomes a text "blob of n bytes". NULL when memory is gone. */
json_t *cp_cell_json(const cp_cell *cell);

/* The rows of a query as an array of objects. The caller releases it. */
CP_MUST_CHECK cp_status cp_query_json(cp_store *store, const char *sql, json_t **rows,
                                      cp_error *error);

/* A number for JSON: null where it is not finite. */
json_t *cp_number_json(double value);

#endif
