/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A crash out of rows of a database that anybody may have written: changes of cells, each a byte
 * for the column, one for the type, one for the length and the value; then the crash is read, and
 * simulated where it can be. The database is that of FUZZ_DB, made by `crashpulse assess`. */
#include "fuzz.h"

#include "store/result_rows.h"
#include "store/store_sqlite.h"
#include "store/stored_crash.h"
#include "store/stored_pulse.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS_MAX = 256 };

static cp_store *store;
static char update[COLUMNS_MAX][256];
static size_t column_count;
static int64_t crash_id;

static void list_columns(void)
{
    static const char QUERY[] =
        "SELECT format('UPDATE \"%w\" SET \"%w\" = ?1', t.name, c.name) FROM sqlite_schema AS t, "
        "pragma_table_xinfo(t.name) AS c WHERE t.name IN ('crash', 'crash_vehicle', "
        "'vehicle_model', 'replication', 'pulse') AND t.type = 'table' AND c.hidden = 0 AND NOT "
        "(c.name IN ('id', 'crash_id', 'role', 'replication_id') OR (t.name = 'vehicle_model' AND "
        "c.name = 'name')) ORDER BY 1";
    sqlite3_stmt *s = NULL;
    sqlite3_prepare_v2(cp_store_sqlite(store), QUERY, -1, &s, NULL);
    while (column_count < COLUMNS_MAX && sqlite3_step(s) == SQLITE_ROW)
        snprintf(update[column_count++], sizeof *update, "%s", sqlite3_column_text(s, 0));
    sqlite3_finalize(s);
    fuzz_must(column_count > 40, "no columns");
}

static void open_once(void)
{
    cp_error error = {0};
    if (store != NULL)
        return;
    const char *source = getenv("FUZZ_DB");
    char command[8192];
    snprintf(command, sizeof command, "cp '%s' rows.db", source != NULL ? source : "");
    fuzz_must(system(command) == 0, "FUZZ_DB: a database of crashpulse");
    cp_status status = cp_store_open("rows.db", CP_STORE_WRITE, &store, &error);
    fuzz_must(status == CP_OK, error.text);
    fuzz_must(cp_crash_library_begin(&error) == CP_OK, error.text);
    list_columns();
    // What checks of the schema and triggers of ours would not let in, a stranger's file may hold.
    sqlite3_db_config(cp_store_sqlite(store), SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, NULL);
    sqlite3_exec(cp_store_sqlite(store),
                 "PRAGMA ignore_check_constraints=ON; PRAGMA foreign_keys=OFF; "
                 "PRAGMA synchronous=OFF",
                 NULL, NULL, NULL);
    double id = 0.0;
    sqlite3_stmt *s = NULL;
    sqlite3_prepare_v2(cp_store_sqlite(store), "SELECT min(id) FROM crash", -1, &s, NULL);
    if (sqlite3_step(s) == SQLITE_ROW)
        id = (double)sqlite3_column_int64(s, 0);
    sqlite3_finalize(s);
    crash_id = (int64_t)id;
}

// One change; how many bytes it took, 0: no more.
static size_t change(const uint8_t *data, size_t size)
{
    static const double ODD[] = {0.0,  -0.0,  1e308, -1e308, 1e-308, INFINITY, -INFINITY, -1.0,
                                 50.0, 360.0, 1e9,   1e-9,   0.5,    10.0,     200.0,     3.5};
    sqlite3_stmt *s = NULL;
    if (size < 3)
        return 0;
    size_t length = data[2] < size - 3 ? data[2] : size - 3;
    const uint8_t *value = data + 3;
    if (sqlite3_prepare_v2(cp_store_sqlite(store), update[data[0] % column_count], -1, &s, NULL) !=
        SQLITE_OK)
        return 3 + length;
    double real = 0.0;
    memcpy(&real, value, length < 8 ? length : 8);
    if (data[1] % 6 == 1)
        sqlite3_bind_double(s, 1, ODD[data[2] % 16]);
    if (data[1] % 6 == 2)
        sqlite3_bind_double(s, 1, real);
    if (data[1] % 6 == 3)
        sqlite3_bind_text(s, 1, (const char *)value, (int)length, SQLITE_TRANSIENT);
    if (data[1] % 6 == 4)
        sqlite3_bind_blob(s, 1, value, (int)length, SQLITE_TRANSIENT);
    if (data[1] % 6 == 5)
        sqlite3_bind_int64(s, 1, (int64_t)data[2] - 128);
    sqlite3_step(s); // constraints that are left may refuse it
    sqlite3_finalize(s);
    return data[1] % 6 == 1 || data[1] % 6 == 5 || data[1] % 6 == 0 ? 3 : 3 + length;
}

static void simulate(const cp_stored_crash *crash)
{
    cp_crash_result result;
    cp_stored_match match;
    cp_error error = {0};
    // The beginning says most of it, in a tenth of the time.
    cp_crash_options options = crash->options;
    options.duration_s = fmin(options.duration_s, 0.03);
    options.longest_duration_s = fmin(options.longest_duration_s, 0.03);
    cp_status status = cp_crash_simulate(&crash->model[0], &crash->model[1], &crash->configuration,
                                         &options, &result, &error);
    fuzz_must(status == CP_OK || (status == CP_CRASH_FAILED && error.text[0] != '\0'), error.text);
    if (status == CP_OK) {
        for (int v = 0; v < result.vehicle_count; v++)
            for (int c = 0; c < CP_CHANNEL_COUNT; c++)
                for (size_t k = 0; k < result.pulse[v].sample_count; k++)
                    fuzz_must(isfinite(result.pulse[v].channel[c][k]), "a pulse not finite");
        status = cp_stored_crash_compare(store, crash, &result, &match, &error);
        fuzz_judge(status, &error);
    }
    cp_crash_result_destroy(&result);
}

void fuzz_rows(const uint8_t *data, size_t size)
{
    cp_stored_crash *crash = calloc(1, sizeof *crash);
    cp_pulse pulse = {0};
    cp_error error = {0};
    fuzz_must(crash != NULL, "no memory");
    open_once();
    sqlite3_exec(cp_store_sqlite(store), "BEGIN", NULL, NULL, NULL);
    for (size_t at = 0, took; (took = change(data + at, size - at)) > 0;)
        at += took;
    cp_status status = cp_stored_crash_read(store, crash_id, NULL, crash, &error);
    // SQLite's own words about JSON that is none come as a failure of the database.
    if (status != CP_STORE_FAILED)
        fuzz_judge(status, &error);
    fuzz_must(status == CP_OK || error.text[0] != '\0', "an error without words");
    if (status == CP_OK)
        simulate(crash);
    error = (cp_error){0};
    bool there = false;
    status = cp_stored_pulse_read(store, crash_id, NULL, "a", &pulse, &there, &error);
    fuzz_judge(status, &error);
    cp_pulse_destroy(&pulse);
    sqlite3_exec(cp_store_sqlite(store), "ROLLBACK", NULL, NULL, NULL);
    free(crash);
}
