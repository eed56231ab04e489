/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/store_sqlite.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/statvfs.h>
#include <time.h>

sqlite3 *cp_store_sqlite(cp_store *store)
{
    return store->handle;
}

const char *cp_store_path(const cp_store *store)
{
    return store->path;
}

// Whether there is no room where a database lies; SQLite does not always keep the system's word.
static bool is_disk_full(const char *path, int why)
{
    struct statvfs disk;
    if (why != 0)
        return why == ENOSPC || why == EDQUOT;
    return statvfs(path, &disk) == 0 && disk.f_blocks > 0 && disk.f_bavail == 0;
}

cp_status cp_store_fail(cp_store *store, cp_error *error, const char *what)
{
    int code = sqlite3_errcode(store->handle) & 0xff;
    cp_status status = CP_STORE_FAILED;
    if (code == SQLITE_BUSY || code == SQLITE_LOCKED)
        status = CP_BUSY;
    else if (code == SQLITE_NOMEM)
        status = CP_NO_MEMORY;
    // SQLite says that input or output failed; the system, why: no space, no rights.
    bool outside = code == SQLITE_IOERR || code == SQLITE_FULL || code == SQLITE_CANTOPEN;
    int why = outside ? sqlite3_system_errno(store->handle) : 0;
    if (code == SQLITE_FULL || (outside && is_disk_full(store->path, why)))
        return cp_fail(error, status,
                       "%s: %s: the disk is full (SQLite keeps logs beside a database, for reading "
                       "too)",
                       store->path, what);
    return cp_fail(error, status, "%s: %s: %s%s%s", store->path, what,
                   sqlite3_errmsg(store->handle), why != 0 ? ": " : "",
                   why != 0 ? strerror(why) : "");
}

// ---- statements ----------------------------------------------------------------------------

cp_status cp_statement_prepare(cp_store *store, const char *what, const char *sql,
                               cp_statement *statement, cp_error *error)
{
    *statement = (cp_statement){.store = store, .what = what};
    if (sqlite3_prepare_v2(store->handle, sql, -1, &statement->handle, NULL) != SQLITE_OK)
        return cp_store_fail(store, error, what);
    return CP_OK;
}

void cp_statement_finish(cp_statement *statement)
{
    sqlite3_finalize(statement->handle);
    statement->handle = NULL;
}

static void remember(cp_statement *statement, int result)
{
    if (statement->bind_result == SQLITE_OK)
        statement->bind_result = result;
}

void cp_bind_integer(cp_statement *statement, int place, int64_t value)
{
    remember(statement, sqlite3_bind_int64(statement->handle, place, value));
}

void cp_bind_real(cp_statement *statement, int place, double value)
{
    remember(statement, isnan(value) ? sqlite3_bind_null(statement->handle, place)
                                     : sqlite3_bind_double(statement->handle, place, value));
}

void cp_bind_text(cp_statement *statement, int place, const char *text)
{
    remember(statement, sqlite3_bind_text(statement->handle, place, text, -1, SQLITE_STATIC));
}

void cp_bind_blob(cp_statement *statement, int place, const void *bytes, size_t size)
{
    remember(statement, sqlite3_bind_blob64(statement->handle, place, bytes, size, SQLITE_STATIC));
}

cp_status cp_statement_row(cp_statement *statement, int *row, cp_error *error)
{
    *row = 0;
    if (statement->bind_result != SQLITE_OK)
        return cp_store_fail(statement->store, error, statement->what);
    int result = sqlite3_step(statement->handle);
    if (result != SQLITE_ROW && result != SQLITE_DONE)
        return cp_store_fail(statement->store, error, statement->what);
    *row = result == SQLITE_ROW;
    return CP_OK;
}

cp_status cp_statement_run(cp_statement *statement, cp_error *error)
{
    int row = 1;
    cp_status status = CP_OK;
    while (status == CP_OK && row)
        status = cp_statement_row(statement, &row, error);
    sqlite3_reset(statement->handle);
    return status;
}

cp_status cp_store_execute(cp_store *store, const char *what, const char *sql, cp_error *error)
{
    if (sqlite3_exec(store->handle, sql, NULL, NULL, NULL) != SQLITE_OK)
        return cp_store_fail(store, error, what);
    return CP_OK;
}

cp_status cp_store_integer(cp_store *store, const char *what, const char *sql, int64_t *value,
                           cp_error *error)
{
    cp_statement statement;
    int row = 0;
    cp_status status = cp_statement_prepare(store, what, sql, &statement, error);
    if (status == CP_OK)
        status = cp_statement_row(&statement, &row, error);
    if (status == CP_OK)
        *value = row ? sqlite3_column_int64(statement.handle, 0) : 0;
    cp_statement_finish(&statement);
    return status;
}

// ---- damage --------------------------------------------------------------------------------

cp_status cp_store_check_damage(cp_store *store, cp_error *error)
{
    cp_statement s;
    int row = 0;
    char found[512] = "";
    cp_status status =
        cp_statement_prepare(store, "looking for damage", "PRAGMA quick_check(1)", &s, error);
    if (status == CP_OK)
        status = cp_statement_row(&s, &row, error);
    // Structure so bad that the check itself gives up is damage as well.
    if (status == CP_OK && row)
        snprintf(found, sizeof found, "%.400s", (const char *)sqlite3_column_text(s.handle, 0));
    else if ((sqlite3_errcode(store->handle) & 0xff) == SQLITE_CORRUPT)
        snprintf(found, sizeof found, "%.400s", sqlite3_errmsg(store->handle));
    cp_statement_finish(&s);
    if (found[0] == '\0' || strcmp(found, "ok") == 0)
        return status;
    for (char *c = found; *c != '\0'; c++)
        if (*c == '\n')
            *c = ' ';
    return cp_fail(
        error, CP_STORE_FAILED,
        "%s: is damaged: %s; nothing was changed in it; 'crashpulse check' lists what is "
        "wrong, 'sqlite3 FILE .recover' saves what can be",
        store->path, found);
}

// ---- extensions ----------------------------------------------------------------------------

cp_status cp_store_load_extension(cp_store *store, const char *path, cp_error *error)
{
    // By this call only: SQL itself must not load anything.
    char *message = NULL;
    sqlite3_db_config(store->handle, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 1, NULL);
    int result = sqlite3_load_extension(store->handle, path, NULL, &message);
    sqlite3_db_config(store->handle, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0, NULL);
    cp_status status = CP_OK;
    if (result != SQLITE_OK)
        status = cp_fail(error, CP_IO_FAILED, "%s: cannot be loaded: %s", path,
                         message != NULL ? message : sqlite3_errmsg(store->handle));
    sqlite3_free(message);
    return status;
}

// ---- transactions --------------------------------------------------------------------------

// WAL mode. SQLite does not wait for others when it changes the mode: it is tried as long as for
// any other lock.
static cp_status keep_log(cp_store *store, cp_error *error)
{
    enum { PAUSE_MS = 20 };
    const struct timespec pause = {.tv_nsec = PAUSE_MS * 1000000L};
    cp_status status = CP_BUSY;
    for (int waited_ms = 0; status == CP_BUSY && waited_ms < CP_STORE_BUSY_TIMEOUT_MS;
         waited_ms += PAUSE_MS) {
        status = cp_store_execute(store, "setting it up",
                                  "PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL", error);
        if (status == CP_BUSY)
            nanosleep(&pause, NULL);
    }
    store->keeps_log = status == CP_OK;
    return status;
}

cp_status cp_store_begin(cp_store *store, cp_error *error)
{
    // Not before there is something to write: a database that is refused stays as it is.
    cp_status status = store->keeps_log ? CP_OK : keep_log(store, error);
    if (status == CP_OK)
        status = cp_store_execute(store, "beginning a transaction", "BEGIN IMMEDIATE", error);
    store->in_transaction = status == CP_OK;
    return status;
}

cp_status cp_store_commit(cp_store *store, cp_error *error)
{
    cp_status status = cp_store_execute(store, "committing", "COMMIT", error);
    if (status == CP_OK)
        store->in_transaction = 0;
    return status;
}

void cp_store_rollback(cp_store *store)
{
    // SQLite may have rolled back by itself already; then there is nothing left to do.
    if (store->in_transaction && !sqlite3_get_autocommit(store->handle))
        sqlite3_exec(store->handle, "ROLLBACK", NULL, NULL, NULL);
    store->in_transaction = 0;
}
