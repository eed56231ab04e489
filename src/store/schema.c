/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/schema.h"

#include "core/hash.h"
#include "store/store_sqlite.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define APPLICATION_ID 0x43504c53 /* "CPLS" */

extern const unsigned char cp_views[]; /* db/views.sql, embedded */

// ---- views ---------------------------------------------------------------------------------

// Which views stand in a file: a view of its own says it, the SHA-256 of db/views.sql.
static void hash_views(char hex[CP_HASH_TEXT_SIZE])
{
    cp_hash_bytes(cp_views, strlen((const char *)cp_views), hex);
}

static cp_status write_views(cp_store *store, cp_error *error)
{
    char hex[CP_HASH_TEXT_SIZE], mark[256];
    hash_views(hex);
    snprintf(
        mark, sizeof mark,
        "DROP VIEW IF EXISTS views_written; CREATE VIEW views_written AS SELECT '%s' AS sha256",
        hex);
    cp_status status = cp_store_execute(store, "writing the views", (const char *)cp_views, error);
    if (status == CP_OK)
        status = cp_store_execute(store, "writing the views", mark, error);
    return status;
}

// Text with every occurrence of old replaced; NULL when memory is gone.
static char *replace(const char *text, const char *old, const char *replacement)
{
    size_t places = 0;
    for (const char *at = strstr(text, old); at != NULL; at = strstr(at + 1, old))
        places++;
    char *result = malloc(strlen(text) + places * strlen(replacement) + 1), *to = result;
    if (result == NULL)
        return NULL;
    for (const char *at = strstr(text, old); at != NULL; at = strstr(text, old)) {
        memcpy(to, text, (size_t)(at - text));
        to = stpcpy(to + (at - text), replacement);
        text = at + strlen(old);
    }
    strcpy(to, text);
    return result;
}

// Temporary views come before those of the file and leave it alone.
static cp_status hide_views(cp_store *store, cp_error *error)
{
    char *dropping =
        replace((const char *)cp_views, "DROP VIEW IF EXISTS ", "DROP VIEW IF EXISTS temp.");
    char *text = dropping != NULL ? replace(dropping, "CREATE VIEW ", "CREATE TEMP VIEW ") : NULL;
    cp_status status = text != NULL ? cp_store_execute(store, "making the views", text, error)
                                    : cp_fail_memory(error, "views");
    free(text);
    free(dropping);
    return status;
}

static cp_status rewrite_views(cp_store *store, cp_error *error)
{
    cp_status status = cp_store_begin(store, error);
    if (status != CP_OK)
        return status;
    status = write_views(store, error);
    if (status == CP_OK)
        status = cp_store_commit(store, error);
    if (status != CP_OK)
        cp_store_rollback(store);
    return status;
}

cp_status cp_schema_refresh_views(cp_store *store, bool are_there, bool writable, cp_error *error)
{
    char hex[CP_HASH_TEXT_SIZE], sql[256];
    int64_t same = 0;
    hash_views(hex);
    snprintf(
        sql, sizeof sql,
        "SELECT count(*) FROM sqlite_schema WHERE type = 'view' AND name = 'views_written' AND "
        "instr(sql, '%s') > 0",
        hex);
    cp_status status = cp_store_integer(store, "reading the views", sql, &same, error);
    if (status != CP_OK || (same && are_there))
        return status;
    return writable ? rewrite_views(store, error) : hide_views(store, error);
}

// ---- migration -----------------------------------------------------------------------------

// No row may point to one that is not there: migrations run without enforcement.
static cp_status check_references(cp_store *store, cp_error *error)
{
    cp_statement s;
    int row = 0;
    cp_status status = cp_statement_prepare(store, "checking references",
                                            "SELECT \"table\", \"parent\", count(*) FROM "
                                            "pragma_foreign_key_check GROUP BY 1, 2",
                                            &s, error);
    if (status == CP_OK)
        status = cp_statement_row(&s, &row, error);
    if (status == CP_OK && row)
        status =
            cp_fail(error, CP_STORE_FAILED, "%s: %d rows of %s name rows of %s that are not there",
                    cp_store_path(store), sqlite3_column_int(s.handle, 2),
                    (const char *)sqlite3_column_text(s.handle, 0),
                    (const char *)sqlite3_column_text(s.handle, 1));
    cp_statement_finish(&s);
    return status;
}

static cp_status migrate_locked(cp_store *store, cp_error *error)
{
    char stamp[128], what[64];
    int64_t version = 0;
    // Again under the lock: another process may have been faster.
    cp_status status =
        cp_store_integer(store, "reading its version", "PRAGMA user_version", &version, error);
    for (int64_t k = version; status == CP_OK && k < CP_STORE_VERSION; k++) {
        snprintf(what, sizeof what, "bringing the schema to version %d", (int)k + 1);
        status = cp_store_execute(store, what, (const char *)CP_SCHEMA[k], error);
    }
    if (status == CP_OK)
        status = write_views(store, error);
    if (status == CP_OK && version > 0)
        status = check_references(store, error);
    snprintf(stamp, sizeof stamp, "PRAGMA application_id=%d; PRAGMA user_version=%d",
             APPLICATION_ID, CP_STORE_VERSION);
    if (status == CP_OK)
        status = cp_store_execute(store, "writing its version", stamp, error);
    return status;
}

cp_status cp_schema_migrate(cp_store *store, cp_error *error)
{
    cp_status status = cp_store_begin(store, error);
    if (status != CP_OK)
        return status;
    // What a file of db/schema changes in the text of a table; by no other SQL.
    sqlite3_db_config(cp_store_sqlite(store), SQLITE_DBCONFIG_DEFENSIVE, 0, NULL);
    status = migrate_locked(store, error);
    if (status == CP_OK)
        status = cp_store_commit(store, error);
    if (status != CP_OK)
        cp_store_rollback(store);
    sqlite3_db_config(cp_store_sqlite(store), SQLITE_DBCONFIG_DEFENSIVE, 1, NULL);
    return status;
}

// ---- whose file ----------------------------------------------------------------------------

cp_status cp_schema_check(cp_store *store, int *version, cp_error *error)
{
    int64_t application = 0, number = 0, objects = 0;
    cp_status status =
        cp_store_integer(store, "reading", "SELECT count(*) FROM sqlite_schema", &objects, error);
    int code = sqlite3_errcode(cp_store_sqlite(store)) & 0xff;
    if (status != CP_OK && code == SQLITE_NOTADB)
        return cp_fail(error, CP_BAD_INPUT, "%s: is not a database", cp_store_path(store));
    if (status != CP_OK && code == SQLITE_CORRUPT)
        return cp_fail(error, CP_STORE_FAILED, "%s: is damaged: %s", cp_store_path(store),
                       sqlite3_errmsg(cp_store_sqlite(store)));
    if (status == CP_OK)
        status = cp_store_integer(store, "reading", "PRAGMA application_id", &application, error);
    if (status == CP_OK)
        status = cp_store_integer(store, "reading", "PRAGMA user_version", &number, error);
    if (status != CP_OK)
        return status;

    bool empty = objects == 0 && application == 0 && number == 0;
    if (!empty && application != APPLICATION_ID)
        return cp_fail(error, CP_BAD_INPUT, "%s: is not a database of crashpulse",
                       cp_store_path(store));
    if (number > CP_STORE_VERSION)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: was written by a newer crashpulse (schema version %lld, this program "
                       "knows up to %d)",
                       cp_store_path(store), (long long)number, CP_STORE_VERSION);
    *version = (int)number;
    return CP_OK;
}
