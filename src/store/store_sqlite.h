/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_STORE_SQLITE_H
#define STORE_STORE_SQLITE_H

#include "store/store.h"

#include <sqlite3.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* SQLite under the store; for the files of this folder only. */

/* How long a connection waits for others. */
#define CP_STORE_BUSY_TIMEOUT_MS 60000

struct cp_store {
    char *path;
    char *file_name; /* the same as SQLite takes it: ':memory:' and 'file:x' are names too */
    sqlite3 *handle;
    int in_transaction;
    bool may_write;
    bool keeps_log; /* put into WAL mode by this connection */
};

sqlite3 *cp_store_sqlite(cp_store *store);

/* SQLite's last error as a status and message "path: what: SQLite's words". */
cp_status cp_store_fail(cp_store *store, cp_error *error, const char *what);

/* Run SQL without rows, one statement or several. */
CP_MUST_CHECK cp_status cp_store_execute(cp_store *store, const char *what, const char *sql,
                                         cp_error *error);
/* First column of the first row of a query; 0 without a row. */
CP_MUST_CHECK cp_status cp_store_integer(cp_store *store, const char *what, const char *sql,
                                         int64_t *value, cp_error *error);

/* A statement that names what it does in its errors. Zero-initialise, prepare, finish. Binding
 * remembers its first failure, which the next step reports. */
typedef struct cp_statement {
    cp_store *store;
    sqlite3_stmt *handle;
    const char *what; /* "writing a crash" */
    int bind_result;
} cp_statement;

CP_MUST_CHECK cp_status cp_statement_prepare(cp_store *store, const char *what, const char *sql,
                                             cp_statement *statement, cp_error *error);
void cp_statement_finish(cp_statement *statement);

/* Parameters by number from 1. NAN and a NULL text are bound as NULL. Text and blobs are borrowed
 * until the statement is reset. */
void cp_bind_integer(cp_statement *statement, int place, int64_t value);
void cp_bind_real(cp_statement *statement, int place, double value);
void cp_bind_text(cp_statement *statement, int place, const char *text);
void cp_bind_blob(cp_statement *statement, int place, const void *bytes, size_t size);

/* Next row of a query: *row says whether there is one. */
CP_MUST_CHECK cp_status cp_statement_row(cp_statement *statement, int *row, cp_error *error);
/* Run a statement without rows to its end and make it ready for the next binding. */
CP_MUST_CHECK cp_status cp_statement_run(cp_statement *statement, cp_error *error);

#endif
