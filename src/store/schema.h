/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_SCHEMA_H
#define STORE_SCHEMA_H

#include "store/store.h"

#include <stdbool.h>

/* Versions of the schema; for the files of this folder only. Version N is what the first N files of
 * db/schema make, run one after the other; PRAGMA user_version tells it. A file is never changed
 * once databases were written with it: what is to be different goes into the next one. */

/* The SQL of version k + 1, zero-terminated; CP_STORE_VERSION entries. */
extern const unsigned char *const CP_SCHEMA[];

/* The first version that tells how crashes came about; what is older has NULL there. */
#define CP_SCHEMA_OF_CAUSES 12

/* Bring the database from whatever version it has to CP_STORE_VERSION and write the views, all in
 * one transaction or not at all. Every reference between tables is checked before the commit.
 * Errors: CP_STORE_FAILED, CP_BUSY. */
CP_MUST_CHECK cp_status cp_schema_migrate(cp_store *store, cp_error *error);

/* See to it that queries find the views of this program, whatever program wrote those in the file:
 * they are written anew when writable, else hidden by temporary ones. Does nothing when they are
 * there (as cp_schema_match says) and marked as the same. Views of the user stay. Errors:
 * CP_STORE_FAILED, CP_BUSY, CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_schema_refresh_views(cp_store *store, bool are_there, bool writable,
                                                cp_error *error);

/* Whose file it is and how old. version is 0 for an empty file. Errors: CP_BAD_INPUT for no
 * database, another program's, or one of a newer crashpulse. */
CP_MUST_CHECK cp_status cp_schema_check(cp_store *store, int *version, cp_error *error);

#endif
