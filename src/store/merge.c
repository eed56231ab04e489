/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/merge.h"

#include "store/store_sqlite.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// What the study is: the same in all its parts, row by row.
static const char *const STUDY_TABLE[] = {"study", "scenario", "variant", "vehicle_model",
                                          "sweep_value"};
#define STUDY_TABLE_COUNT (sizeof STUDY_TABLE / sizeof *STUDY_TABLE)

static const char *text_of(const cp_statement *s, int column)
{
    const unsigned char *text = sqlite3_column_text(s->handle, column);
    return text != NULL ? (const char *)text : "";
}

// SQL made by printf, without rows.
static cp_status run_sql(cp_store *store, cp_error *error, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *sql = sqlite3_vmprintf(format, arguments);
    va_end(arguments);
    if (sql == NULL)
        return cp_fail_memory(error, "merging");
    cp_status status = cp_store_execute(store, "merging", sql, error);
    sqlite3_free(sql);
    return status;
}

static cp_status number_sql(cp_store *store, int64_t *number, cp_error *error, const char *format,
                            ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *sql = sqlite3_vmprintf(format, arguments);
    va_end(arguments);
    if (sql == NULL)
        return cp_fail_memory(error, "merging");
    cp_status status = cp_store_integer(store, "merging", sql, number, error);
    sqlite3_free(sql);
    return status;
}

// ---- the same study ------------------------------------------------------------------------

// An empty database becomes one of the part's study: its rows and its plan, nothing done.
static cp_status take_plan(cp_store *store, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < STUDY_TABLE_COUNT; k++)
        status = run_sql(store, error, "INSERT INTO main.%s SELECT * FROM part.%s", STUDY_TABLE[k],
                         STUDY_TABLE[k]);
    if (status == CP_OK)
        status = run_sql(store, error,
                         "INSERT INTO main.replication (id, scenario_id, variant_id, sweep, "
                         "number, seed, configuration_hash) SELECT id, scenario_id, variant_id, "
                         "sweep, number, seed, configuration_hash FROM part.replication");
    return status;
}

static cp_status check_study(cp_store *store, const char *path, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < STUDY_TABLE_COUNT; k++) {
        int64_t differ = 0;
        const char *table = STUDY_TABLE[k];
        status = number_sql(store, &differ, error,
                            "SELECT (SELECT count(*) FROM (SELECT * FROM main.%s EXCEPT SELECT * "
                            "FROM part.%s)) + (SELECT count(*) FROM (SELECT * FROM part.%s EXCEPT "
                            "SELECT * FROM main.%s))",
                            table, table, table, table);
        if (status == CP_OK && differ > 0)
            status = cp_fail(error, CP_BAD_INPUT,
                             "%s: holds another study than %s, or another state of it: their "
                             "tables %s differ",
                             path, cp_store_path(store), table);
    }
    return status;
}

// The first row of a query is what is wrong, in words.
static cp_status check_none(cp_store *store, const char *path, const char *sql, const char *what,
                            cp_error *error)
{
    cp_statement s;
    int row = 0;
    cp_status status = cp_statement_prepare(store, "merging", sql, &s, error);
    if (status == CP_OK)
        status = cp_statement_row(&s, &row, error);
    if (status == CP_OK && row)
        status =
            cp_fail(error, CP_BAD_INPUT, "%s: scenario %s, variant %s, replication %s %s %s", path,
                    text_of(&s, 0), text_of(&s, 1), text_of(&s, 2), what, cp_store_path(store));
    cp_statement_finish(&s);
    return status;
}

// Backgrounds of the same configuration are the same.
static cp_status check_backgrounds(cp_store *store, const char *path, cp_error *error)
{
    static const char RESULTS[] =
        "SELECT s.name, 'background', '' FROM part.background_run AS p JOIN main.background_run AS "
        "r USING (scenario_id, seed, step_length_s, configuration_hash) JOIN main.scenario AS s ON "
        "s.id = p.scenario_id WHERE configuration_hash <> '' AND ((p.simulated_s, p.vehicle_km, "
        "p.vehicle_h, p.departed) IS NOT (r.simulated_s, r.vehicle_km, r.vehicle_h, r.departed) OR "
        "(SELECT json_group_array(json_array(time_s, reason, vehicle_1, vehicle_2)) FROM (SELECT * "
        "FROM part.background_contact AS c WHERE (c.scenario_id, c.seed, c.step_length_s) = "
        "(p.scenario_id, p.seed, p.step_length_s) ORDER BY number)) <> "
        "(SELECT json_group_array(json_array(time_s, reason, vehicle_1, vehicle_2)) FROM (SELECT * "
        "FROM main.background_contact AS c WHERE (c.scenario_id, c.seed, c.step_length_s) = "
        "(p.scenario_id, p.seed, p.step_length_s) ORDER BY number))) LIMIT 1";
    return check_none(store, path, RESULTS, "has other results than in", error);
}

static cp_status check_replications(cp_store *store, const char *path, cp_error *error)
{
    static const char CONFIGURATION[] =
        "SELECT s.name, v.name, p.number FROM part.replication AS p JOIN part.scenario AS s ON "
        "s.id = p.scenario_id JOIN part.variant AS v ON v.id = p.variant_id LEFT JOIN "
        "main.replication AS r ON r.id = p.id WHERE r.configuration_hash IS NOT "
        "p.configuration_hash LIMIT 1";
    static const char RESULTS[] =
        "SELECT s.name, v.name, p.number FROM part.replication AS p JOIN main.replication AS r ON "
        "r.id = p.id JOIN main.scenario AS s ON s.id = p.scenario_id JOIN main.variant AS v ON "
        "v.id = p.variant_id WHERE p.status = 'done' AND r.status = 'done' AND "
        "((p.simulated_s, p.vehicle_km, p.vehicle_h, p.departed, p.counters) IS NOT "
        "(r.simulated_s, r.vehicle_km, r.vehicle_h, r.departed, r.counters) OR "
        "(SELECT json_group_array(json_array(id, time_s, closing_speed_m_s)) FROM (SELECT * FROM "
        "part.crash AS c WHERE c.replication_id = p.id ORDER BY id)) <> "
        "(SELECT json_group_array(json_array(id, time_s, closing_speed_m_s)) FROM (SELECT * FROM "
        "main.crash AS c WHERE c.replication_id = p.id ORDER BY id))) LIMIT 1";
    cp_status status = check_none(store, path, CONFIGURATION, "is configured otherwise in", error);
    if (status == CP_OK)
        status = check_none(store, path, RESULTS, "has other results than in", error);
    return status;
}

// ---- rows ----------------------------------------------------------------------------------

// Every table whose rows belong to a replication, by the column that tells which: crash first, the
// others name its rows.
static const char RESULT_TABLES[] =
    "SELECT m.name, max(c.name = 'crash_id') FROM main.sqlite_schema AS m JOIN "
    "pragma_table_info(m.name) AS c WHERE m.type = 'table' AND c.name IN ('replication_id', "
    "'crash_id') AND m.name <> 'attempt' GROUP BY m.name ORDER BY m.name <> 'crash', m.name <> "
    "'crash_vehicle', m.name";

static cp_status take_results(cp_store *store, cp_error *error)
{
    cp_statement s;
    int row = 0;
    cp_status status = cp_statement_prepare(store, "reading the schema", RESULT_TABLES, &s, error);
    while (status == CP_OK && (status = cp_statement_row(&s, &row, error)) == CP_OK && row) {
        const char *owner = sqlite3_column_int(s.handle, 1) ? "crash_id / 16384" : "replication_id";
        status = run_sql(store, error,
                         "INSERT INTO main.\"%w\" SELECT * FROM part.\"%w\" WHERE %s IN (SELECT id "
                         "FROM temp.taken)",
                         text_of(&s, 0), text_of(&s, 0), owner);
    }
    cp_statement_finish(&s);
    return status;
}

// All columns of a finished replication but those of the plan.
static cp_status take_replications(cp_store *store, cp_error *error)
{
    cp_statement s;
    int row = 0;
    char columns[2048] = "";
    cp_status status = cp_statement_prepare(
        store, "reading the schema",
        "SELECT group_concat('\"' || name || '\"') FROM pragma_table_info('replication') WHERE "
        "name "
        "NOT IN ('id', 'scenario_id', 'variant_id', 'sweep', 'number', 'seed', "
        "'configuration_hash')",
        &s, error);
    if (status == CP_OK)
        status = cp_statement_row(&s, &row, error);
    if (status == CP_OK)
        snprintf(columns, sizeof columns, "%s", text_of(&s, 0));
    cp_statement_finish(&s);
    if (status == CP_OK)
        status = run_sql(store, error,
                         "UPDATE main.replication SET (%s) = (SELECT %s FROM part.replication AS p "
                         "WHERE p.id = main.replication.id) WHERE id IN (SELECT id FROM "
                         "temp.taken)",
                         columns, columns);
    // A failure elsewhere is known here too, unless more is.
    if (status == CP_OK)
        status = run_sql(store, error,
                         "UPDATE main.replication SET status = 'failed' WHERE status = 'planned' "
                         "AND id IN (SELECT id FROM part.replication WHERE status = 'failed')");
    return status;
}

// Who worked on them, when and where; numbered on after those that are here.
static cp_status take_attempts(cp_store *store, cp_error *error)
{
    return run_sql(
        store, error,
        "INSERT INTO main.attempt SELECT a.replication_id, (SELECT coalesce(max(number), 0) FROM "
        "main.attempt AS m WHERE m.replication_id = a.replication_id) + row_number() OVER "
        "(PARTITION BY a.replication_id ORDER BY a.number), a.host, a.pid, a.process_start, "
        "a.started, a.wall_time_s, a.outcome, a.message FROM part.attempt AS a WHERE a.outcome <> "
        "'running' AND NOT EXISTS (SELECT 1 FROM main.attempt AS m WHERE m.replication_id = "
        "a.replication_id AND m.host = a.host AND m.pid = a.pid AND m.process_start = "
        "a.process_start AND m.started = a.started)");
}

// Backgrounds that are not here, of scenarios that are.
static cp_status take_backgrounds(cp_store *store, cp_error *error)
{
    static const char *const TABLE[] = {"background_contact", "background_run"};
    cp_status status = CP_OK;
    for (int k = 0; status == CP_OK && k < 2; k++)
        status = run_sql(store, error,
                         "INSERT INTO main.%s SELECT * FROM part.%s AS p WHERE scenario_id IN "
                         "(SELECT id FROM main.scenario) AND NOT EXISTS (SELECT 1 FROM "
                         "main.background_run AS r WHERE (r.scenario_id, r.seed, r.step_length_s) "
                         "= (p.scenario_id, p.seed, p.step_length_s))",
                         TABLE[k], TABLE[k]);
    return status;
}

static cp_status take_all(cp_store *store, const char *path, cp_merge_count *count, cp_error *error)
{
    int64_t studies = 0, taken = 0, done = 0;
    cp_status status = number_sql(store, &studies, error, "SELECT count(*) FROM main.study");
    if (status == CP_OK && studies == 0)
        status = take_plan(store, error);
    if (status == CP_OK)
        status = check_study(store, path, error);
    if (status == CP_OK)
        status = check_replications(store, path, error);
    if (status == CP_OK)
        status = check_backgrounds(store, path, error);
    if (status == CP_OK)
        status = cp_store_execute(
            store, "merging",
            "DROP TABLE IF EXISTS temp.taken; CREATE TEMP TABLE taken AS SELECT p.id FROM "
            "part.replication AS p JOIN main.replication AS r ON r.id = p.id WHERE p.status = "
            "'done' AND r.status <> 'done'; PRAGMA defer_foreign_keys = ON",
            error);
    if (status == CP_OK)
        status = number_sql(store, &taken, error, "SELECT count(*) FROM temp.taken");
    if (status == CP_OK)
        status = number_sql(store, &done, error,
                            "SELECT count(*) FROM part.replication WHERE status = 'done'");
    if (status == CP_OK)
        status = take_results(store, error);
    if (status == CP_OK)
        status = take_replications(store, error);
    if (status == CP_OK)
        status = take_attempts(store, error);
    if (status == CP_OK)
        status = take_backgrounds(store, error);
    if (status == CP_OK && taken > 0)
        status = run_sql(store, error,
                         "INSERT INTO main.merge_source (database, merged, replications) VALUES "
                         "(%Q, strftime('%%Y-%%m-%%dT%%H:%%M:%%fZ'), %lld)",
                         path, (long long)taken);
    *count = (cp_merge_count){.taken = (size_t)taken, .present = (size_t)(done - taken)};
    return status;
}

// Look at the part as a database of its own first: whose it is, and its version.
static cp_status check_part(cp_store *store, const char *path, cp_error *error)
{
    cp_store *part = NULL;
    int64_t studies = 0;
    struct stat own, entry;
    if (stat(cp_store_path(store), &own) == 0 && stat(path, &entry) == 0 &&
        own.st_dev == entry.st_dev && own.st_ino == entry.st_ino)
        return cp_fail(error, CP_BAD_INPUT, "%s: cannot be merged into itself (%s)", path,
                       cp_store_path(store));
    cp_status status = cp_store_open(path, CP_STORE_READ, &part, error);
    if (status == CP_OK)
        status = cp_store_integer(part, "reading", "SELECT count(*) FROM study", &studies, error);
    if (status == CP_OK && studies == 0)
        status = cp_fail(error, CP_BAD_INPUT, "%s: holds no study yet", path);
    cp_store_close(part);
    return status;
}

cp_status cp_merge(cp_store *store, const char *path, cp_merge_count *count, cp_error *error)
{
    *count = (cp_merge_count){0};
    cp_status status = check_part(store, path, error);
    char *file_name = cp_store_file_name(path);
    if (status == CP_OK && file_name == NULL)
        status = cp_fail_memory(error, path);
    if (status == CP_OK)
        status = run_sql(store, error, "ATTACH %Q AS part", file_name);
    free(file_name);
    if (status != CP_OK)
        return status;
    status = cp_store_begin(store, error);
    if (status == CP_OK)
        status = take_all(store, path, count, error);
    if (status == CP_OK)
        status = cp_store_commit(store, error);
    if (status != CP_OK)
        cp_store_rollback(store);
    cp_error ignored = {0};
    cp_status detached = cp_store_execute(store, "merging", "DETACH part", &ignored);
    return status == CP_OK && detached != CP_OK ? cp_fail(error, detached, "%s", ignored.text)
                                                : status;
}
