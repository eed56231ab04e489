/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sqlext/functions.h"

SQLITE_EXTENSION_INIT1

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
    int result = cp_sqlext_register_scalars(db);
    if (result == SQLITE_OK)
        result = cp_sqlext_register_aggregates(db);
    if (result == SQLITE_OK)
        result = cp_sqlext_register_pulse_samples(db);
    if (result != SQLITE_OK)
        *message = sqlite3_mprintf("crashpulse_sql: %s", sqlite3_errmsg(db));
    return result;
}
