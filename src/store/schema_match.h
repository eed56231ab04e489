/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_SCHEMA_MATCH_H
#define STORE_SCHEMA_MATCH_H

#include "store/store.h"

#include <stdbool.h>

/* Whether the tables, indexes and triggers of this program in a file are those that db/schema
 * makes, version of them run; for the files of this folder only. What a stranger wrote in their
 * place would run with every statement of ours. Other tables, views and indexes may be there, other
 * triggers not. views: whether all of db/views.sql stand in the file as they are (looked at for the
 * present version only, else false). Errors: CP_BAD_INPUT with the first that differs. */
CP_MUST_CHECK cp_status cp_schema_match(cp_store *store, int version, bool *views, cp_error *error);

#endif
