/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/store.h"

#include "core/file.h"
#include "core/log.h"
#include "store/schema.h"
#include "store/schema_match.h"
#include "store/store_file.h"
#include "store/store_sqlite.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

char *cp_store_file_name(const char *path)
{
    bool clear = path[0] == '/' || path[0] == '.';
    char *name = malloc(strlen(path) + 3);
    if (name != NULL)
        sprintf(name, "%s%s", clear ? "" : "./", path);
    return name;
}

// Say what an older database cannot tell of its crashes.
static cp_status tell_unknown(cp_store *store, int version, cp_error *error)
{
    int64_t crashes = 0;
    if (version == 0 || version >= CP_SCHEMA_OF_CAUSES)
        return CP_OK;
    cp_status status =
        cp_store_integer(store, "reading", "SELECT count(*) FROM crash", &crashes, error);
    if (status == CP_OK && crashes > 0)
        cp_log_info(
            "%s: of the %lld crashes written by an earlier version the driver errors, what "
            "functions did, lanes and masses are not known: NULL in crash_vehicle, no rows in "
            "crash_driver_error and crash_function",
            store->path, (long long)crashes);
    return status;
}

// Whose file it is and how old, before anything is changed in it. views: whether those of this
// program stand in it.
static cp_status check_version(cp_store *store, cp_store_mode mode, bool *views, cp_error *error)
{
    int version = 0;
    *views = false;
    // In one transaction: another process may bring it to a later version meanwhile.
    cp_status status = cp_store_execute(store, "reading", "BEGIN", error);
    if (status == CP_OK)
        status = cp_schema_check(store, &version, error);
    if (status == CP_OK && version > 0)
        status = cp_schema_match(store, version, views, error);
    sqlite3_exec(store->handle, "ROLLBACK", NULL, NULL, NULL);
    if (status != CP_OK || version == CP_STORE_VERSION)
        return status;
    if (version == 0 && mode != CP_STORE_CREATE)
        return cp_fail(error, CP_BAD_INPUT, "%s: is not a database of crashpulse", store->path);
    if (mode == CP_STORE_READ)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: was written by an older crashpulse (schema version %d, this program "
                       "reads %d); 'crashpulse check --upgrade' brings it up to date",
                       store->path, version, CP_STORE_VERSION);
    status = cp_schema_migrate(store, error);
    *views = status == CP_OK;
    return status == CP_OK ? tell_unknown(store, version, error) : status;
}

static cp_status fail_opening(cp_store *store, int code, cp_error *error)
{
    if (store->handle == NULL || (code & 0xff) == SQLITE_NOMEM)
        return cp_fail_memory(error, store->path);
    // A disk that fails or is full, and a process with too many files, are no fault of the file.
    int why = sqlite3_system_errno(store->handle);
    bool outside = why == EIO || why == EMFILE || why == ENFILE || why == ENOSPC;
    if ((code & 0xff) == SQLITE_IOERR || (code & 0xff) == SQLITE_FULL ||
        ((code & 0xff) == SQLITE_CANTOPEN && outside))
        return cp_store_fail(store, error, "cannot be opened");
    return cp_fail(error, CP_BAD_INPUT, "%s: cannot be opened: %s", store->path,
                   sqlite3_errmsg(store->handle));
}

// Open for reading with a parameter of SQLite's URIs.
static cp_status open_with(cp_store *store, const char *parameter, cp_error *error)
{
    // A file name within an URI: its special characters as %xx.
    char *uri = sqlite3_mprintf(store->file_name[0] == '/' ? "file://" : "file:");
    for (const char *c = store->file_name; *c != '\0' && uri != NULL; c++)
        uri = strchr("%?# ", *c) != NULL ? sqlite3_mprintf("%z%%%02x", uri, *c)
                                         : sqlite3_mprintf("%z%c", uri, *c);
    if (uri != NULL)
        uri = sqlite3_mprintf("%z?%s", uri, parameter);
    if (uri == NULL)
        return cp_fail_memory(error, store->path);
    int result = sqlite3_open_v2(uri, &store->handle, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, NULL);
    sqlite3_free(uri);
    return result == SQLITE_OK ? CP_OK : fail_opening(store, result, error);
}

static cp_status open_plain(cp_store *store, int flags, cp_error *error)
{
    if (sqlite3_open_v2(store->file_name, &store->handle, flags, NULL) != SQLITE_OK)
        return fail_opening(store, sqlite3_errcode(store->handle), error);
    return CP_OK;
}

// Without the right to write beside it a reader must do without files of its own; with the right
// to write there and not to the database it must not leave any, which would shut the owner out.
static cp_status open_for_reading(cp_store *store, cp_error *error)
{
    switch (cp_store_file_reading(store->path)) {
    case CP_STORE_READING_SHARED_LOG:
        return open_with(store, "readonly_shm=1", error);
    case CP_STORE_READING_UNCHANGING:
        return open_with(store, "immutable=1", error);
    case CP_STORE_READING_LOST_LOG:
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: has an unfinished log beside it (-wal) and cannot be written; whoever "
                       "may write it takes the log in by 'crashpulse check --upgrade', or copy "
                       "both files to a folder of your own",
                       store->path);
    case CP_STORE_READING_PLAIN:
        break;
    }
    return open_plain(store, SQLITE_OPEN_READONLY, error);
}

// SQLite's log is shared memory: what lies on another machine has none.
static void tell_network(const cp_store *store, cp_store_mode mode)
{
    bool writes = mode == CP_STORE_CREATE;
    if (!writes && (mode != CP_STORE_READ || !cp_store_file_has_log_mode(store->path)))
        return;
    const char *network = cp_store_file_network(store->path);
    if (network != NULL && writes)
        cp_log_warning("%s: lies on a network file system (%s): only processes of one machine may "
                       "use it until it is finished; on several machines run shards (--shard) with "
                       "a database each and merge them, best on a local disk",
                       store->path, network);
    else if (network != NULL)
        cp_log_warning("%s: lies on a network file system (%s) and is not finished: what another "
                       "machine writes there may be seen late or torn; read it on that machine, or "
                       "when it is finished",
                       store->path, network);
}

static cp_status open_file(cp_store *store, cp_store_mode mode, bool exists, cp_error *error)
{
    if (mode == CP_STORE_READ)
        return open_for_reading(store, error);
    if (exists && access(store->path, W_OK) != 0)
        return cp_fail(error, CP_IO_FAILED, "%s: cannot be written: %s", store->path,
                       strerror(errno));
    int create = mode == CP_STORE_CREATE ? SQLITE_OPEN_CREATE : 0;
    return open_plain(store, SQLITE_OPEN_READWRITE | create, error);
}

// A database may come from anybody: its schema runs no function that reaches out, nothing writes
// past SQL, and no value is larger than any of ours.
static cp_status set_limits(cp_store *store, cp_store_mode mode, cp_error *error)
{
    enum { VALUE_BYTES_MAX = 256 << 20 };
    int result = sqlite3_db_config(store->handle, SQLITE_DBCONFIG_DEFENSIVE, 1, NULL);
    // Our own checks of what is written take SQLite's JSON functions, which count as untrusted.
    if (result == SQLITE_OK && mode == CP_STORE_READ)
        result = sqlite3_db_config(store->handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
    if (result == SQLITE_OK && mode == CP_STORE_READ)
        result = sqlite3_db_config(store->handle, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, NULL);
    if (result != SQLITE_OK)
        return cp_store_fail(store, error, "setting it up");
    sqlite3_limit(store->handle, SQLITE_LIMIT_LENGTH, VALUE_BYTES_MAX);
    sqlite3_limit(store->handle, SQLITE_LIMIT_ATTACHED, 1);
    return CP_OK;
}

// Take the log in and leave WAL mode, which works for the last connection only.
static bool leave_log(cp_store *store)
{
    sqlite3_stmt *statement = NULL;
    bool left = sqlite3_prepare_v2(store->handle, "PRAGMA journal_mode=DELETE", -1, &statement,
                                   NULL) == SQLITE_OK &&
                sqlite3_step(statement) == SQLITE_ROW &&
                strcmp((const char *)sqlite3_column_text(statement, 0), "delete") == 0;
    sqlite3_finalize(statement);
    store->keeps_log = !left;
    return left;
}

void cp_store_finish(cp_store *store)
{
    enum { PAUSE_MS = 20, PATIENCE_MS = 2000 };
    const struct timespec pause = {.tv_nsec = PAUSE_MS * 1000000L};
    if (store == NULL || !store->may_write || store->in_transaction)
        return;
    for (int waited_ms = 0; !leave_log(store); waited_ms += PAUSE_MS) {
        if (waited_ms >= PATIENCE_MS) {
            cp_log_info("%s: is read by others at present, so its log (-wal) stays beside it; "
                        "'crashpulse check --upgrade' takes it in",
                        store->path);
            return;
        }
        nanosleep(&pause, NULL);
    }
}

static cp_status open_handle(cp_store *store, cp_store_mode mode, cp_error *error)
{
    struct stat entry;
    bool exists = stat(store->path, &entry) == 0;
    if (exists && S_ISDIR(entry.st_mode))
        return cp_fail(error, CP_BAD_INPUT, "%s: is a directory, not a database", store->path);
    if (!exists && mode != CP_STORE_CREATE)
        return cp_fail(error, CP_BAD_INPUT, "%s: no such database", store->path);

    tell_network(store, mode);
    cp_status status = open_file(store, mode, exists, error);
    if (status != CP_OK)
        return status;
    store->may_write = mode != CP_STORE_READ;
    sqlite3_busy_timeout(store->handle, CP_STORE_BUSY_TIMEOUT_MS);
    bool views = false;
    status = set_limits(store, mode, error);
    // For new files only: rows of some hundred bytes, packed pulses among them, fill larger pages
    // better.
    if (mode == CP_STORE_CREATE)
        sqlite3_exec(store->handle, "PRAGMA page_size=8192", NULL, NULL, NULL);
    if (status == CP_OK)
        status = check_version(store, mode, &views, error);
    if (status == CP_OK)
        status = cp_schema_refresh_views(store, views, mode != CP_STORE_READ, error);
    if (status == CP_OK)
        status = cp_store_execute(store, "setting it up", "PRAGMA foreign_keys=ON", error);

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
    if (opened == NULL)
        return cp_fail_memory(error, path);
    opened->path = strdup(path);
    opened->file_name = cp_store_file_name(path);
    if (opened->path == NULL || opened->file_name == NULL) {
        cp_store_close(opened);
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
    // Whoever leaves last leaves a file that can be read without the right to write.
    if (store->handle != NULL && store->may_write)
        leave_log(store);
    sqlite3_close(store->handle);
    free(store->path);
    free(store->file_name);
    free(store);
}
