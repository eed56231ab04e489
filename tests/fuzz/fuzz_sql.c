/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The functions of the SQL extension with any arguments: a statement of FUNCTIONS, then for each of
 * its parameters a byte for the type and, of texts and blobs, one for the length. */
#include "fuzz.h"

#include <math.h>
#include <sqlite3.h>
#include <stdlib.h>
#include <string.h>

typedef int entry_point(sqlite3 *db, char **message, const struct sqlite3_api_routines *api);
entry_point sqlite3_crashpulsesql_init;

static const char *const STATEMENTS[] = {
    "SELECT olc(?1), olc_status(?1), delta_v(?1), peak(?1)",
    "SELECT olc(?1, ?2, ?3, ?4), olc_status(?1, ?2, ?3, ?4)",
    "SELECT delta_v(?1, ?2), cfc(?1, ?2)",
    "SELECT length(cfc(?1, 60)), olc(cfc(?1, 180)), peak(cfc(?1, ?2))",
    "SELECT median(column1) FROM (VALUES (?1), (?2), (?3), (?4), (?5), (?6))",
    "SELECT median(column1, column2) FROM (VALUES (?1, ?2), (?3, ?4), (?5, ?6))",
    "SELECT quantile(column1, ?6) FROM (VALUES (?1), (?2), (?3), (?4), (?5))",
    "SELECT quantile(column1, ?6, column2) FROM (VALUES (?1, ?2), (?3, ?4))",
    "SELECT median(column1) OVER (ROWS 2 PRECEDING) FROM (VALUES (?1), (?2), (?3), (?4), (?5))",
    "SELECT quantile(column1, ?6) OVER (ROWS BETWEEN 1 PRECEDING AND 1 FOLLOWING) FROM "
    "(VALUES (?1), (?2), (?3), (?4), (?5))",
    "SELECT cliffs_delta(column1, column2), ks_distance(column1, column2) FROM "
    "(VALUES (?1, ?2), (?3, ?4), (?5, ?6))",
    "SELECT cliffs_delta(column1, column2, column3), ks_distance(column1, column2, column3) FROM "
    "(VALUES (?1, ?2, ?3), (?4, ?5, ?6))",
    "SELECT count(*), sum(ax_m_s2), max(time_s) FROM pulse_samples(?1)",
    "SELECT * FROM pulse_samples(?1, ?2) LIMIT 5",
    "SELECT sample FROM pulse_samples(?1) WHERE sample = ?2 ORDER BY time_s DESC LIMIT 5",
};
enum { STATEMENT_COUNT = sizeof STATEMENTS / sizeof *STATEMENTS };

static sqlite3 *db;
static sqlite3_stmt *statement[STATEMENT_COUNT];

// What SQLite hands to extensions: the same as to one that it loads.
static const struct sqlite3_api_routines *routines;

static int keep_routines(sqlite3 *opened, char **message, const struct sqlite3_api_routines *api)
{
    (void)opened, (void)message;
    routines = api;
    return SQLITE_OK;
}

static void open_once(void)
{
    char *message = NULL;
    if (db != NULL)
        return;
    fuzz_must(sqlite3_auto_extension((void (*)(void))keep_routines) == SQLITE_OK &&
                  sqlite3_open(":memory:", &db) == SQLITE_OK &&
                  sqlite3_crashpulsesql_init(db, &message, routines) == SQLITE_OK,
              message != NULL ? message : "no SQLite");
    sqlite3_exec(db,
                 "CREATE TABLE pulse (crash_id, role, codec, sample_interval_s, sample_count, "
                 "samples)",
                 NULL, NULL, NULL);
    for (size_t k = 0; k < STATEMENT_COUNT; k++)
        fuzz_must(sqlite3_prepare_v2(db, STATEMENTS[k], -1, &statement[k], NULL) == SQLITE_OK,
                  sqlite3_errmsg(db));
}

// One parameter; how many bytes it took.
static size_t bind(sqlite3_stmt *s, int place, const uint8_t *data, size_t size)
{
    double real = 0.0;
    int64_t integer = 0;
    if (size < 1)
        return 0;
    uint8_t type = data[0] % 6;
    if (type == 0)
        sqlite3_bind_null(s, place);
    if (type == 1 || type == 2) {
        memcpy(&integer, data + 1, size < 9 ? size - 1 : 8);
        memcpy(&real, data + 1, size < 9 ? size - 1 : 8);
        if (type == 1)
            sqlite3_bind_int64(s, place, integer);
        else
            sqlite3_bind_double(s, place, real);
        return size < 9 ? size : 9;
    }
    if (type == 5) { // a small number: counts, classes, shares
        sqlite3_bind_double(s, place, size > 1 ? (data[1] - 20) / 16.0 : 0.0);
        return size < 2 ? size : 2;
    }
    if (type == 0 || size < 3)
        return 1;
    size_t length = data[1] | (size_t)data[2] << 8;
    length = length < size - 3 ? length : size - 3;
    if (type == 3)
        sqlite3_bind_text(s, place, (const char *)data + 3, (int)length, SQLITE_TRANSIENT);
    else
        sqlite3_bind_blob(s, place, data + 3, (int)length, SQLITE_TRANSIENT);
    return 3 + length;
}

void fuzz_sql(const uint8_t *data, size_t size)
{
    enum { ROWS_MAX = 100000 };
    open_once();
    if (size < 1)
        return;
    sqlite3_stmt *s = statement[data[0] % STATEMENT_COUNT];
    size_t at = 1;
    for (int place = 1; place <= sqlite3_bind_parameter_count(s); place++)
        at += bind(s, place, data + at, size - at);
    int result = SQLITE_ROW, rows = 0;
    while (result == SQLITE_ROW && rows++ <= ROWS_MAX)
        result = sqlite3_step(s);
    fuzz_must(result == SQLITE_DONE || result == SQLITE_ERROR || result == SQLITE_NOMEM ||
                  result == SQLITE_TOOBIG,
              sqlite3_errstr(result));
    fuzz_must(result != SQLITE_ERROR || strlen(sqlite3_errmsg(db)) > 0, "an error without words");
    sqlite3_reset(s);
    sqlite3_clear_bindings(s);
}
