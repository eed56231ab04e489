/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_STORE_H
#define STORE_STORE_H

#include "core/error.h"

/* The database of a study: opening, creating, migrating, transactions. SQLite in WAL mode
 * while it is written, without a log when the last writer has left, with foreign keys on; a
 * connection waits up to 60 s for others before it says CP_BUSY. One connection belongs to one
 * thread and must not cross a fork. Only this folder sees SQLite. */
typedef struct cp_store cp_store;

typedef enum cp_store_mode {
    CP_STORE_READ,  /* must exist; nothing can be written */
    CP_STORE_WRITE, /* must exist; migrated when it is older */
    CP_STORE_CREATE /* created when absent or empty */
} cp_store_mode;

/* Version of the schema this program writes: number of the last file of db/schema. */
extern const int CP_STORE_VERSION;

/* Open path. The caller closes. Errors: CP_BAD_INPUT for a file that is missing, no database, not a
 * database of crashpulse, or written by a newer crashpulse; CP_BUSY; CP_STORE_FAILED. After a
 * failed creation no file is left that was not there before. */
CP_MUST_CHECK cp_status cp_store_open(const char *path, cp_store_mode mode, cp_store **store,
                                      cp_error *error);
/* Take SQLite's log into the database and leave it without one, so that it can be read without the
 * right to write and copied as one file; waits up to 2 s for readers to leave, then says that the
 * log stays. For the last to write; NULL is fine. */
void cp_store_finish(cp_store *store);
/* NULL is fine. An open transaction is rolled back. The last writing connection to leave finishes
 * the database, without waiting for anybody. */
void cp_store_close(cp_store *store);

/* Read the whole file for damage (SQLite's quick_check: every page, the structure of tables; not
 * whether indexes agree with them). Error: CP_STORE_FAILED with the first damage found. */
CP_MUST_CHECK cp_status cp_store_check_damage(cp_store *store, cp_error *error);

/* Load a SQLite extension (its functions, for queries on this connection). Errors: CP_IO_FAILED
 * with SQLite's words. */
CP_MUST_CHECK cp_status cp_store_load_extension(cp_store *store, const char *path, cp_error *error);

const char *cp_store_path(const cp_store *store);

/* A path as SQLite and its shell take it for a file, whatever its name (':memory:', 'file:x',
 * '-x'). The caller frees. NULL when memory is gone. */
char *cp_store_file_name(const char *path);

/* One writing transaction at a time. Begin takes the write lock at once, so that what is read in
 * it stays true until the commit. Rollback without a transaction is fine. */
CP_MUST_CHECK cp_status cp_store_begin(cp_store *store, cp_error *error);
CP_MUST_CHECK cp_status cp_store_commit(cp_store *store, cp_error *error);
void cp_store_rollback(cp_store *store);

#endif
