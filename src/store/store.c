/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/store.h"

#include "core/file.h"
#include "store/store_sqlite.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define BUSY_TIMEOUT_MS 60000
#define APPLICATION_ID 0x43504c53 /* "CPLS" */

struct cp_store {
    char *path;
    sqlite3 *handle;
    int in_transaction;
};

// The files of db/schema and db/views.sql, embedded at build time.
extern const unsigned char cp_schema_001[];
extern const unsigned char cp_schema_002[];
extern const unsigned char cp_views[];

static const unsigned char *const MIGRATION[CP_STORE_VERSION] = {cp_schema_001, cp_schema_002};

sqlite3 *cp_store_sqlite(cp_store *store)
{
    return store->handle;
}

const char *cp_store_path(const cp_store *store)
{
    return store->path;
}

cp_status cp_store_fail(cp_store *store, cp_error *error, const char *what)
{
    int code = sqlite3_errcode(store->handle) & 0xff;
    cp_status status = CP_STORE_FAILED;
    if (code == SQLITE_BUSY || code == SQLITE_LOCKED)
        status = CP_BUSY;
    else if (code == SQLITE_NOMEM)
        status = CP_NO_MEMORY;
    return cp_fail(error, status, "%s: %s: %s", store->path, what, sqlite3_errmsg(store->handle));
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

static cp_status execute(cp_store *store, const char *what, const char *sql, cp_error *error)
{
    if (sqlite3_exec(store->handle, sql, NULL, NULL, NULL) != SQLITE_OK)
        return cp_store_fail(store, error, what);
    return CP_OK;
}

static cp_status read_integer(cp_store *store, const char *what, const char *sql, int64_t *value,
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

// ---- transactions --------------------------------------------------------------------------

cp_status cp_store_begin(cp_store *store, cp_error *error)
{
    cp_status status = execute(store, "beginning a transaction", "BEGIN IMMEDIATE", error);
    store->in_transaction = status == CP_OK;
    return status;
}

cp_status cp_store_commit(cp_store *store, cp_error *error)
{
    cp_status status = execute(store, "committing", "COMMIT", error);
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

// ---- opening -------------------------------------------------------------------------------

// Bring the schema from version to CP_STORE_VERSION, all or nothing.
static cp_status migrate(cp_store *store, cp_error *error)
{
    cp_status status = cp_store_begin(store, error);
    int64_t version = 0;
    if (status == CP_OK) // again under the lock: another process may have been faster
        status = read_integer(store, "reading its version", "PRAGMA user_version", &version, error);
    for (int64_t k = version; status == CP_OK && k < CP_STORE_VERSION; k++)
        status = execute(store, "writing the schema", (const char *)MIGRATION[k], error);
    if (status == CP_OK)
        status = execute(store, "writing the views", (const char *)cp_views, error);
    if (status == CP_OK) {
        char stamp[128];
        snprintf(stamp, sizeof stamp, "PRAGMA application_id=%d; PRAGMA user_version=%d",
                 APPLICATION_ID, CP_STORE_VERSION);
        status = execute(store, "writing its version", stamp, error);
    }
    if (status == CP_OK)
        status = cp_store_commit(store, error);
    if (status != CP_OK)
        cp_store_rollback(store);
    return status;
}

// Whose file it is and how old, before anything is changed in it.
static cp_status check_version(cp_store *store, cp_store_mode mode, cp_error *error)
{
    int64_t application = 0, version = 0, objects = 0;
    cp_status status =
        read_integer(store, "reading", "SELECT count(*) FROM sqlite_schema", &objects, error);
    if (status != CP_OK && (sqlite3_errcode(store->handle) & 0xff) == SQLITE_NOTADB)
        return cp_fail(error, CP_BAD_INPUT, "%s: is not a database", store->path);
    if (status == CP_OK)
        status = read_integer(store, "reading", "PRAGMA application_id", &application, error);
    if (status == CP_OK)
        status = read_integer(store, "reading", "PRAGMA user_version", &version, error);
    if (status != CP_OK)
        return status;

    bool empty = objects == 0 && application == 0 && version == 0;
    if (application != APPLICATION_ID && !(empty && mode == CP_STORE_CREATE))
        return cp_fail(error, CP_BAD_INPUT, "%s: is not a database of crashpulse", store->path);
    if (version > CP_STORE_VERSION)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: was written by a newer crashpulse (schema version %lld, this program "
                       "knows up to %d)",
                       store->path, (long long)version, CP_STORE_VERSION);
    if (version == CP_STORE_VERSION)
        return CP_OK;
    if (mode == CP_STORE_READ)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: was written by an older crashpulse (schema version %lld, this program "
                       "reads %d); 'crashpulse run' brings it up to date",
                       store->path, (long long)version, CP_STORE_VERSION);
    return migrate(store, error);
}

static cp_status open_handle(cp_store *store, cp_store_mode mode, cp_error *error)
{
    struct stat entry;
    bool exists = stat(store->path, &entry) == 0;
    if (exists && S_ISDIR(entry.st_mode))
        return cp_fail(error, CP_BAD_INPUT, "%s: is a directory, not a database", store->path);
    if (!exists && mode != CP_STORE_CREATE)
        return cp_fail(error, CP_BAD_INPUT, "%s: no such database", store->path);

    int flags = mode == CP_STORE_READ ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE;
    if (mode == CP_STORE_CREATE)
        flags |= SQLITE_OPEN_CREATE;
    if (sqlite3_open_v2(store->path, &store->handle, flags, NULL) != SQLITE_OK)
        return cp_fail(error, CP_BAD_INPUT, "%s: cannot be opened: %s", store->path,
                       store->handle != NULL ? sqlite3_errmsg(store->handle) : "out of memory");
    sqlite3_busy_timeout(store->handle, BUSY_TIMEOUT_MS);
    cp_status status = check_version(store, mode, error);
    if (status == CP_OK && mode != CP_STORE_READ)
        status = execute(store, "setting it up",
                         "PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL", error);
    if (status == CP_OK)
        status = execute(store, "setting it up", "PRAGMA foreign_keys=ON", error);

    // A creation that failed leaves nothing behind.
    if (status != CP_OK && !exists) {
        sqlite3_close(store->handle);
        store->handle = NULL;
        unlink(store->path);
    }
    return status;
}

cp_status cp_store_open(const char *path, cp_store_mode mode, cp_store **store, cp_error *error)
{
    *store = NULL;
    cp_store *opened = calloc(1, sizeof *opened);
    if (opened != NULL)
        opened->path = strdup(path);
    if (opened == NULL || opened->path == NULL) {
        free(opened);
        return cp_fail_memory(error, path);
    }
    cp_status status = open_handle(opened, mode, error);
    if (status != CP_OK) {
        cp_store_close(opened);
        return status;
    }
    *store = opened;
    return CP_OK;
}

void cp_store_close(cp_store *store)
{
    if (store == NULL)
        return;
    if (store->handle != NULL)
        cp_store_rollback(store);
    sqlite3_close(store->handle);
    free(store->path);
    free(store);
}
