/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sqlext/functions.h"

#include "pulse/pulse_codec.h"

#include <stdlib.h>
#include <string.h>

SQLITE_EXTENSION_INIT3

/* A table with arguments: pulse_samples(crash_id, role) of the table pulse of this database, or
 * pulse_samples(samples) of any pulse blob. One row a sample: sample (from 0), time_s, and the
 * channels. */

enum { SAMPLE, TIME_S, FIRST_CHANNEL, CRASH_OR_BLOB = FIRST_CHANNEL + CP_CHANNEL_COUNT, ROLE };

typedef struct samples_table {
    sqlite3_vtab base; /* first */
    sqlite3 *db;
} samples_table;

typedef struct samples_cursor {
    sqlite3_vtab_cursor base; /* first */
    cp_pulse pulse;
    size_t sample;
    sqlite3_value *argument[2]; /* as given, for the hidden columns */
} samples_cursor;

static int fail(sqlite3_vtab *table, const char *what)
{
    sqlite3_free(table->zErrMsg);
    table->zErrMsg = sqlite3_mprintf("pulse_samples: %s", what);
    return SQLITE_ERROR;
}

// ---- the table -----------------------------------------------------------------------------

static int connect(sqlite3 *db, void *data, int count, const char *const *words,
                   sqlite3_vtab **table, char **message)
{
    (void)data;
    (void)count;
    (void)words;
    (void)message;
    char *sql = sqlite3_mprintf("CREATE TABLE x (sample, time_s");
    for (int c = 0; c < CP_CHANNEL_COUNT && sql != NULL; c++)
        sql = sqlite3_mprintf("%z, %s", sql, CP_PULSE_COLUMN[c]);
    if (sql != NULL)
        sql = sqlite3_mprintf("%z, crash_or_samples HIDDEN, role HIDDEN)", sql);
    if (sql == NULL)
        return SQLITE_NOMEM;
    int result = sqlite3_declare_vtab(db, sql);
    sqlite3_free(sql);
    if (result == SQLITE_OK)
        result = sqlite3_vtab_config(db, SQLITE_VTAB_INNOCUOUS);
    if (result != SQLITE_OK)
        return result;
    samples_table *created = sqlite3_malloc(sizeof *created);
    if (created == NULL)
        return SQLITE_NOMEM;
    *created = (samples_table){.db = db};
    *table = &created->base;
    return SQLITE_OK;
}

static int disconnect(sqlite3_vtab *table)
{
    sqlite3_free(table);
    return SQLITE_OK;
}

// Arguments are constraints on the hidden columns; the plan number tells which were given.
static int best_index(sqlite3_vtab *table, sqlite3_index_info *info)
{
    int place[2] = {-1, -1};
    for (int k = 0; k < info->nConstraint; k++) {
        int argument = info->aConstraint[k].iColumn - CRASH_OR_BLOB;
        if (argument < 0 || info->aConstraint[k].op != SQLITE_INDEX_CONSTRAINT_EQ)
            continue;
        if (!info->aConstraint[k].usable)
            return SQLITE_CONSTRAINT; // another order of the join has it
        place[argument] = k;
    }
    if (place[0] < 0)
        return fail(table, "needs arguments: pulse_samples(crash_id, role) or "
                           "pulse_samples(samples)");
    for (int argument = 0; argument < 2; argument++) {
        if (place[argument] < 0)
            continue;
        info->aConstraintUsage[place[argument]].argvIndex = argument + 1;
        info->aConstraintUsage[place[argument]].omit = 1;
    }
    info->idxNum = place[1] >= 0 ? 2 : 1;
    info->estimatedCost = 300.0;
    info->estimatedRows = 300;
    if (info->nOrderBy == 1 && info->aOrderBy[0].iColumn <= TIME_S && !info->aOrderBy[0].desc)
        info->orderByConsumed = 1;
    return SQLITE_OK;
}

// ---- a cursor ------------------------------------------------------------------------------

static int open_cursor(sqlite3_vtab *table, sqlite3_vtab_cursor **cursor)
{
    (void)table;
    samples_cursor *opened = sqlite3_malloc(sizeof *opened);
    if (opened == NULL)
        return SQLITE_NOMEM;
    *opened = (samples_cursor){0};
    *cursor = &opened->base;
    return SQLITE_OK;
}

static void clear(samples_cursor *cursor)
{
    cp_pulse_destroy(&cursor->pulse);
    for (int k = 0; k < 2; k++) {
        sqlite3_value_free(cursor->argument[k]);
        cursor->argument[k] = NULL;
    }
    cursor->sample = 0;
}

static int close_cursor(sqlite3_vtab_cursor *cursor)
{
    clear((samples_cursor *)cursor);
    sqlite3_free(cursor);
    return SQLITE_OK;
}

// The pulse of one vehicle of a crash; no row, no samples.
static int load_stored(samples_cursor *cursor, sqlite3_value **values, cp_error *error)
{
    samples_table *table = (samples_table *)cursor->base.pVtab;
    sqlite3_stmt *statement = NULL;
    int result = sqlite3_prepare_v2(table->db,
                                    "SELECT codec, samples, sample_count, sample_interval_s FROM "
                                    "pulse WHERE crash_id = ?1 AND role = ?2",
                                    -1, &statement, NULL);
    if (result == SQLITE_OK)
        result = sqlite3_bind_value(statement, 1, values[0]);
    if (result == SQLITE_OK)
        result = sqlite3_bind_value(statement, 2, values[1]);
    if (result == SQLITE_OK)
        result = sqlite3_step(statement);
    cp_status status = CP_OK;
    if (result == SQLITE_ROW)
        status = cp_pulse_decode(
            sqlite3_column_int(statement, 0), sqlite3_column_blob(statement, 1),
            (size_t)sqlite3_column_bytes(statement, 1), sqlite3_column_int64(statement, 2),
            sqlite3_column_double(statement, 3), &cursor->pulse, error);
    else if (result != SQLITE_DONE)
        status = cp_fail(error, CP_STORE_FAILED, "%s", sqlite3_errmsg(table->db));
    sqlite3_finalize(statement);
    return status == CP_OK ? SQLITE_OK : SQLITE_ERROR;
}

static int load_blob(samples_cursor *cursor, sqlite3_value *value, cp_error *error)
{
    if (sqlite3_value_type(value) == SQLITE_NULL)
        return SQLITE_OK;
    cp_status status = CP_OK;
    if (sqlite3_value_type(value) != SQLITE_BLOB)
        status = cp_fail(error, CP_BAD_INPUT,
                         "a single argument must be a pulse, column samples "
                         "of table pulse");
    if (status == CP_OK)
        status = cp_pulse_decode_blob(sqlite3_value_blob(value), (size_t)sqlite3_value_bytes(value),
                                      &cursor->pulse, error);
    return status == CP_OK ? SQLITE_OK : SQLITE_ERROR;
}

static int filter(sqlite3_vtab_cursor *base, int plan, const char *text, int count,
                  sqlite3_value **values)
{
    samples_cursor *cursor = (samples_cursor *)base;
    cp_error error = {0};
    (void)text;
    clear(cursor);
    for (int k = 0; k < count && k < 2; k++) {
        cursor->argument[k] = sqlite3_value_dup(values[k]);
        if (cursor->argument[k] == NULL)
            return SQLITE_NOMEM;
    }
    int result =
        plan == 2 ? load_stored(cursor, values, &error) : load_blob(cursor, values[0], &error);
    if (result != SQLITE_OK)
        return error.status == CP_NO_MEMORY ? SQLITE_NOMEM : fail(base->pVtab, error.text);
    return SQLITE_OK;
}

static int next(sqlite3_vtab_cursor *base)
{
    ((samples_cursor *)base)->sample++;
    return SQLITE_OK;
}

static int at_end(sqlite3_vtab_cursor *base)
{
    const samples_cursor *cursor = (const samples_cursor *)base;
    return cursor->sample >= cursor->pulse.sample_count;
}

static int column(sqlite3_vtab_cursor *base, sqlite3_context *context, int place)
{
    const samples_cursor *cursor = (const samples_cursor *)base;
    if (place == SAMPLE)
        sqlite3_result_int64(context, (sqlite3_int64)cursor->sample);
    else if (place == TIME_S)
        sqlite3_result_double(context, (double)cursor->sample * cursor->pulse.sample_interval_s);
    else if (place < CRASH_OR_BLOB)
        sqlite3_result_double(context,
                              cursor->pulse.channel[place - FIRST_CHANNEL][cursor->sample]);
    else if (cursor->argument[place - CRASH_OR_BLOB] != NULL)
        sqlite3_result_value(context, cursor->argument[place - CRASH_OR_BLOB]);
    return SQLITE_OK;
}

static int row_id(sqlite3_vtab_cursor *base, sqlite3_int64 *id)
{
    *id = (sqlite3_int64)((const samples_cursor *)base)->sample;
    return SQLITE_OK;
}

int cp_sqlext_register_pulse_samples(sqlite3 *db)
{
    // Without a create method: usable as a function without CREATE VIRTUAL TABLE, and only so.
    static const sqlite3_module MODULE = {.xConnect = connect,
                                          .xDisconnect = disconnect,
                                          .xBestIndex = best_index,
                                          .xOpen = open_cursor,
                                          .xClose = close_cursor,
                                          .xFilter = filter,
                                          .xNext = next,
                                          .xEof = at_end,
                                          .xColumn = column,
                                          .xRowid = row_id};
    int result = sqlite3_create_module_v2(db, "pulse_samples", &MODULE, NULL, NULL);
    if (result == SQLITE_OK)
        result =
            sqlite3_create_module_v2(db, CP_SQLEXT_PREFIX "pulse_samples", &MODULE, NULL, NULL);
    return result;
}
