/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sqlext/functions.h"

#include <stddef.h>

SQLITE_EXTENSION_INIT1

int cp_sqlext_has(sqlite3 *db, const char *name, int arguments)
{
    // A statement that calls it can be prepared or not; none of the functions is looked up
    // otherwise.
    sqlite3_stmt *statement = NULL;
    char *sql = sqlite3_mprintf("SELECT %s(NULL%.*s)", name, 6 * (arguments - 1),
                                ", NULL, NULL, NULL, NULL");
    int found = sql != NULL && sqlite3_prepare_v2(db, sql, -1, &statement, NULL) == SQLITE_OK;
    sqlite3_finalize(statement);
    sqlite3_free(sql);
    return found;
}

// SQLite finds it by the name of the file, crashpulse_sql.so.
int sqlite3_crashpulsesql_init(sqlite3 *db, char **message, const sqlite3_api_routines *api);

__attribute__((visibility("default"))) int
sqlite3_crashpulsesql_init(sqlite3 *db, char **message, const sqlite3_api_routines *api)
{
    SQLITE_EXTENSION_INIT2(api)
    // Window functions and flags are older than 3.38; what views of the database use is not.
    if (sqlite3_libversion_number() < 3038000) {
        *message = sqlite3_mprintf("crashpulse_sql needs SQLite 3.38 or newer, this is %s",
                                   sqlite3_libversion());
        return SQLITE_ERROR;
    }
    // Loaded before into this connection: all of it is there.
    if (cp_sqlext_has(db, CP_SQLEXT_PREFIX "ks_distance", 3))
        return SQLITE_OK;
    int result = cp_sqlext_register_scalars(db);
    if (result == SQLITE_OK)
        result = cp_sqlext_register_aggregates(db);
    if (result == SQLITE_OK)
        result = cp_sqlext_register_pulse_samples(db);
    if (result != SQLITE_OK)
        *message = sqlite3_mprintf("crashpulse_sql: %s", sqlite3_errmsg(db));
    return result;
}
