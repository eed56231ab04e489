/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/plan_rows.h"

#include "store/store_sqlite.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

int64_t cp_replication_row_id(const char *scenario, const char *variant, const char *sweep,
                              uint64_t seed)
{
    char key[4096];
    snprintf(key, sizeof key, "%s|%s|%s|%" PRIu64, scenario, variant, sweep, seed);
    // 39 bits: with 2^14 crashes below it an id is a whole number of a double.
    return cp_hash_row_id(key) >> 3;
}

// ---- the plan beside what the database holds -----------------------------------------------

// The plan in temporary tables made like those it is for; a read-only database has them too.
static const char PREPARE[] =
    "DROP TABLE IF EXISTS temp.planned_study; DROP TABLE IF EXISTS temp.planned_scenario;"
    "DROP TABLE IF EXISTS temp.planned_variant; DROP TABLE IF EXISTS temp.planned_vehicle_model;"
    "DROP TABLE IF EXISTS temp.planned_sweep_value; DROP TABLE IF EXISTS temp.plan;"
    "CREATE TEMP TABLE planned_study AS SELECT * FROM study WHERE false;"
    "CREATE TEMP TABLE planned_scenario AS SELECT * FROM scenario WHERE false;"
    "CREATE TEMP TABLE planned_variant AS SELECT * FROM variant WHERE false;"
    "CREATE TEMP TABLE planned_vehicle_model AS SELECT * FROM vehicle_model WHERE false;"
    "CREATE TEMP TABLE planned_sweep_value AS SELECT * FROM sweep_value WHERE false;"
    "CREATE TEMP TABLE plan (id INTEGER PRIMARY KEY, scenario_id, variant_id, number, seed, hash)";

// Replications with results, or being run, that the plan contradicts.
static const char CONTRADICTION[] =
    "SELECT s.name, v.name, r.number, p.id IS NULL, r.scenario_id, r.variant_id "
    "FROM replication AS r LEFT JOIN temp.plan AS p ON p.id = r.id "
    "JOIN scenario AS s ON s.id = r.scenario_id JOIN variant AS v ON v.id = r.variant_id "
    "WHERE r.status IN ('done', 'running') AND (p.id IS NULL OR p.hash <> r.configuration_hash) "
    "ORDER BY s.number, v.number, r.number LIMIT 1";

// First difference between the rows and the plan that concerns scenario ?1 and variant ?2.
static const char DIFFERENCE[] =
    "WITH d (what, was, is_now) AS ("
    "SELECT 'seed', o.seed, n.seed FROM study AS o, temp.planned_study AS n UNION ALL "
    "SELECT 'design', o.design, n.design FROM study AS o, temp.planned_study AS n UNION ALL "
    "SELECT 'duration_s', o.duration_s, n.duration_s "
    "FROM study AS o, temp.planned_study AS n UNION ALL "
    "SELECT 'warmup_s', o.warmup_s, n.warmup_s "
    "FROM study AS o, temp.planned_study AS n UNION ALL "
    "SELECT 'step_length_s', o.step_length_s, n.step_length_s "
    "FROM study AS o, temp.planned_study AS n UNION ALL "
    "SELECT 'stay_s', o.stay_s, n.stay_s FROM study AS o, temp.planned_study AS n UNION ALL "
    "SELECT 'history_s', o.history_s, n.history_s "
    "FROM study AS o, temp.planned_study AS n UNION ALL "
    "SELECT 'vehicles', o.vehicles, n.vehicles "
    "FROM study AS o, temp.planned_study AS n UNION ALL "
    "SELECT 'vehicle model ' || n.name, o.hash, n.hash "
    "FROM vehicle_model AS o JOIN temp.planned_vehicle_model AS n USING (name) UNION ALL "
    "SELECT 'vehicle model ' || name, 'not part of the study', hash FROM "
    "temp.planned_vehicle_model "
    "WHERE name NOT IN (SELECT name FROM vehicle_model) UNION ALL "
    "SELECT 'vehicle model ' || name, hash, 'not part of the study' FROM vehicle_model "
    "WHERE name NOT IN (SELECT name FROM temp.planned_vehicle_model) UNION ALL "
    "SELECT 'scenario ' || n.name || ': sumocfg', o.sumocfg, n.sumocfg "
    "FROM scenario AS o JOIN temp.planned_scenario AS n USING (id) WHERE id = ?1 UNION ALL "
    "SELECT 'scenario ' || n.name || ': sumo_options', o.sumo_options, n.sumo_options "
    "FROM scenario AS o JOIN temp.planned_scenario AS n USING (id) WHERE id = ?1 UNION ALL "
    "SELECT 'scenario ' || n.name || ': driver_errors', o.driver_errors, n.driver_errors "
    "FROM scenario AS o JOIN temp.planned_scenario AS n USING (id) WHERE id = ?1 UNION ALL "
    "SELECT 'scenario ' || n.name || ': SHA-256 of ' || f.key, f.value, "
    "coalesce((SELECT value FROM json_each(n.files) WHERE key = f.key), 'not there') "
    "FROM scenario AS o JOIN temp.planned_scenario AS n USING (id), json_each(o.files) AS f "
    "WHERE n.id = ?1 UNION ALL "
    "SELECT 'scenario ' || n.name || ': SHA-256 of ' || f.key, 'not there', f.value "
    "FROM scenario AS o JOIN temp.planned_scenario AS n USING (id), json_each(n.files) AS f "
    "WHERE n.id = ?1 AND f.key NOT IN (SELECT key FROM json_each(o.files)) UNION ALL "
    "SELECT 'variant ' || n.name || ': functions', o.functions, n.functions "
    "FROM variant AS o JOIN temp.planned_variant AS n USING (id) WHERE id = ?2 UNION ALL "
    // A counterfactual replication depends on all treatments.
    "SELECT 'treatment ' || n.name, coalesce(o.functions, 'not there'), n.functions "
    "FROM study JOIN temp.planned_variant AS n LEFT JOIN variant AS o ON o.id = n.id "
    "WHERE design = 'counterfactual' UNION ALL "
    "SELECT 'treatment ' || o.name, o.functions, 'not there' FROM study JOIN variant AS o "
    "WHERE design = 'counterfactual' AND o.id NOT IN (SELECT id FROM temp.planned_variant)) "
    "SELECT what, was, is_now FROM d WHERE was IS NOT is_now LIMIT 1";

static cp_status execute(cp_store *store, const char *sql, cp_error *error)
{
    if (sqlite3_exec(cp_store_sqlite(store), sql, NULL, NULL, NULL) != SQLITE_OK)
        return cp_store_fail(store, error, "planning");
    return CP_OK;
}

static const char *column_text(const cp_statement *statement, int column)
{
    const unsigned char *text = sqlite3_column_text(statement->handle, column);
    return text != NULL ? (const char *)text : "";
}

// ---- writing the plan ----------------------------------------------------------------------

static cp_status write_study(cp_store *store, const cp_study_row *row, cp_error *error)
{
    cp_statement s;
    cp_status status =
        cp_statement_prepare(store, "planning the study",
                             "INSERT INTO temp.planned_study (id, name, question, design, seed, "
                             "replications, duration_s, warmup_s, step_length_s, vehicles, yaml, "
                             "hash, stay_s, history_s) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, "
                             "?9, ?10, ?11, ?12, ?13, ?14)",
                             &s, error);
    if (status != CP_OK)
        return status;
    cp_bind_integer(&s, 1, cp_hash_row_id(row->name));
    cp_bind_text(&s, 2, row->name);
    cp_bind_text(&s, 3, row->question);
    cp_bind_text(&s, 4, row->design);
    cp_bind_integer(&s, 5, (int64_t)row->seed);
    cp_bind_integer(&s, 6, (int64_t)row->replications);
    cp_bind_real(&s, 7, row->duration_s);
    cp_bind_real(&s, 8, row->warmup_s);
    cp_bind_real(&s, 9, row->step_length_s);
    cp_bind_text(&s, 10, row->vehicles);
    cp_bind_text(&s, 11, row->yaml);
    cp_bind_text(&s, 12, row->hash);
    cp_bind_real(&s, 13, row->stay_s);
    cp_bind_real(&s, 14, row->history_s);
    status = cp_statement_run(&s, error);
    cp_statement_finish(&s);
    return status;
}

static cp_status write_scenarios(cp_store *store, const cp_plan_rows *rows, cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "planning a scenario",
        "INSERT INTO temp.planned_scenario VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)", &s, error);
    for (size_t k = 0; status == CP_OK && k < rows->scenario_count; k++) {
        const cp_scenario_row *row = &rows->scenario[k];
        cp_bind_integer(&s, 1, cp_hash_row_id(row->name));
        cp_bind_text(&s, 2, row->name);
        cp_bind_integer(&s, 3, (int64_t)k);
        cp_bind_text(&s, 4, row->sumocfg);
        cp_bind_text(&s, 5, row->sumo_options);
        cp_bind_text(&s, 6, row->files);
        cp_bind_text(&s, 7, row->driver_errors);
        status = cp_statement_run(&s, error);
    }
    cp_statement_finish(&s);
    return status;
}

static cp_status write_variants(cp_store *store, const cp_plan_rows *rows, cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "planning a variant", "INSERT INTO temp.planned_variant VALUES (?1, ?2, ?3, ?4, ?5)",
        &s, error);
    for (size_t k = 0; status == CP_OK && k < rows->variant_count; k++) {
        const cp_variant_row *row = &rows->variant[k];
        cp_bind_integer(&s, 1, cp_hash_row_id(row->name));
        cp_bind_text(&s, 2, row->name);
        cp_bind_integer(&s, 3, (int64_t)k);
        cp_bind_integer(&s, 4, row->is_baseline);
        cp_bind_text(&s, 5, row->functions);
        status = cp_statement_run(&s, error);
    }
    cp_statement_finish(&s);
    return status;
}

static cp_status write_sweeps(cp_store *store, const cp_plan_rows *rows, cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "planning a sweep",
        "INSERT INTO temp.planned_sweep_value VALUES (?1, ?2, ?3, ?4, ?5)", &s, error);
    for (size_t k = 0; status == CP_OK && k < rows->sweep_count; k++) {
        const cp_sweep_row *row = &rows->sweep[k];
        const char *owner =
            row->of_scenario ? rows->scenario[row->owner].name : rows->variant[row->owner].name;
        cp_bind_text(&s, 1, row->of_scenario ? "scenario" : "variant");
        cp_bind_integer(&s, 2, cp_hash_row_id(owner));
        cp_bind_text(&s, 3, row->base);
        cp_bind_text(&s, 4, row->parameter);
        cp_bind_real(&s, 5, row->value);
        status = cp_statement_run(&s, error);
    }
    cp_statement_finish(&s);
    return status;
}

static cp_status write_vehicle_models(cp_store *store, const cp_plan_rows *rows, cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "planning a vehicle model",
        "INSERT INTO temp.planned_vehicle_model VALUES (?1, ?2, ?3)", &s, error);
    for (size_t k = 0; status == CP_OK && k < rows->vehicle_model_count; k++) {
        const cp_vehicle_model_row *row = &rows->vehicle_model[k];
        cp_bind_text(&s, 1, row->name);
        cp_bind_text(&s, 2, row->hash);
        cp_bind_text(&s, 3, row->yaml);
        status = cp_statement_run(&s, error);
    }
    cp_statement_finish(&s);
    return status;
}

static cp_status write_planned(cp_store *store, const cp_plan_rows *rows, cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "planning a replication (two replications with the same row id?)",
        "INSERT INTO temp.plan VALUES (?1, ?2, ?3, ?4, ?5, ?6)", &s, error);
    for (size_t k = 0; status == CP_OK && k < rows->replication_count; k++) {
        const cp_replication_row *row = &rows->replication[k];
        cp_bind_integer(&s, 1, row->id);
        cp_bind_integer(&s, 2, cp_hash_row_id(rows->scenario[row->scenario].name));
        cp_bind_integer(&s, 3, cp_hash_row_id(rows->variant[row->variant].name));
        cp_bind_integer(&s, 4, (int64_t)row->number);
        cp_bind_integer(&s, 5, (int64_t)row->seed);
        cp_bind_text(&s, 6, row->configuration_hash);
        status = cp_statement_run(&s, error);
    }
    cp_statement_finish(&s);
    return status;
}

// ---- contradictions ------------------------------------------------------------------------

static cp_status check_same_study(cp_store *store, const cp_study_row *study, cp_error *error)
{
    cp_statement s;
    int row = 0;
    cp_status status = cp_statement_prepare(store, "reading the study",
                                            "SELECT name FROM study WHERE name <> ?1", &s, error);
    cp_bind_text(&s, 1, study->name);
    if (status == CP_OK)
        status = cp_statement_row(&s, &row, error);
    if (status == CP_OK && row)
        status =
            cp_fail(error, CP_BAD_INPUT, "%s: holds the study '%s', not '%s'; use another database",
                    cp_store_path(store), column_text(&s, 0), study->name);
    cp_statement_finish(&s);
    return status;
}

// What the two configurations of the scenario and variant found differ in; "" when no column tells.
static cp_status find_difference(cp_store *store, const cp_statement *found, char *text,
                                 size_t size, cp_error *error)
{
    cp_statement s;
    int row = 0;
    text[0] = '\0';
    cp_status status =
        cp_statement_prepare(store, "comparing configurations", DIFFERENCE, &s, error);
    cp_bind_integer(&s, 1, sqlite3_column_int64(found->handle, 4));
    cp_bind_integer(&s, 2, sqlite3_column_int64(found->handle, 5));
    if (status == CP_OK)
        status = cp_statement_row(&s, &row, error);
    if (status == CP_OK && row)
        snprintf(text, size, "%s was '%.400s', is now '%.400s'", column_text(&s, 0),
                 column_text(&s, 1), column_text(&s, 2));
    cp_statement_finish(&s);
    return status;
}

static cp_status check_results_agree(cp_store *store, cp_error *error)
{
    cp_statement s;
    int row = 0;
    char difference[1024];
    cp_status status =
        cp_statement_prepare(store, "comparing with the plan", CONTRADICTION, &s, error);
    if (status == CP_OK)
        status = cp_statement_row(&s, &row, error);
    if (status != CP_OK || !row)
        goto done;

    // A changed seed or design gives other replications altogether: then the finished one is
    // missing from the plan, but the study's row still tells why.
    bool missing = sqlite3_column_int(s.handle, 3);
    status = find_difference(store, &s, difference, sizeof difference, error);
    if (status == CP_OK && difference[0] == '\0')
        snprintf(difference, sizeof difference,
                 missing ? "the study file plans it no more"
                         : "the section counterfactual has changed, or this crashpulse describes "
                           "configurations in another way");
    if (status == CP_OK)
        status = cp_fail(error, CP_BAD_INPUT,
                         "%s: has results of another configuration (scenario %s, variant %s, "
                         "replication %s): %s; use another database or restore the study",
                         cp_store_path(store), column_text(&s, 0), column_text(&s, 1),
                         column_text(&s, 2), difference);
done:
    cp_statement_finish(&s);
    return status;
}

// The same row id for another natural key: too unlikely to handle, too bad to overlook.
static cp_status check_collisions(cp_store *store, cp_error *error)
{
    cp_statement s;
    int row = 0;
    cp_status status = cp_statement_prepare(
        store, "checking row ids",
        "SELECT p.id FROM temp.plan AS p JOIN replication AS r ON r.id = p.id "
        "WHERE r.scenario_id <> p.scenario_id OR r.variant_id <> p.variant_id OR r.seed <> p.seed",
        &s, error);
    if (status == CP_OK)
        status = cp_statement_row(&s, &row, error);
    if (status == CP_OK && row)
        status = cp_fail(error, CP_STORE_FAILED,
                         "%s: two replications have the same row id %s; change the study's seed",
                         cp_store_path(store), column_text(&s, 0));
    cp_statement_finish(&s);
    return status;
}

// The plan into the tables. Replications that never ran and are planned no more are forgotten, new
// ones added.
static const char EXCHANGE[] =
    "INSERT INTO study SELECT * FROM temp.planned_study WHERE true ON CONFLICT (id) DO UPDATE SET "
    "question = excluded.question, design = excluded.design, seed = excluded.seed, "
    "replications = excluded.replications, duration_s = excluded.duration_s, "
    "warmup_s = excluded.warmup_s, step_length_s = excluded.step_length_s, "
    "vehicles = excluded.vehicles, yaml = excluded.yaml, hash = excluded.hash, "
    "stay_s = excluded.stay_s, history_s = excluded.history_s;"
    "INSERT INTO scenario SELECT * FROM temp.planned_scenario WHERE true ON CONFLICT (id) DO "
    "UPDATE SET number = excluded.number, sumocfg = excluded.sumocfg, "
    "sumo_options = excluded.sumo_options, files = excluded.files, "
    "driver_errors = excluded.driver_errors;"
    "INSERT INTO variant SELECT * FROM temp.planned_variant WHERE true ON CONFLICT (id) DO UPDATE "
    "SET number = excluded.number, is_baseline = excluded.is_baseline, "
    "functions = excluded.functions;"
    "INSERT INTO vehicle_model SELECT * FROM temp.planned_vehicle_model WHERE true "
    "ON CONFLICT (name) DO UPDATE SET hash = excluded.hash, yaml = excluded.yaml;"
    "DELETE FROM attempt WHERE replication_id IN (SELECT id FROM replication WHERE status IN "
    "('planned', 'failed') AND id NOT IN (SELECT id FROM temp.plan));"
    "DELETE FROM replication WHERE status IN ('planned', 'failed') AND id NOT IN "
    "(SELECT id FROM temp.plan);"
    "INSERT INTO replication (id, scenario_id, variant_id, number, seed, configuration_hash) "
    "SELECT id, scenario_id, variant_id, number, seed, hash FROM temp.plan WHERE true "
    "ON CONFLICT (id) DO UPDATE SET number = excluded.number, "
    "configuration_hash = excluded.configuration_hash;"
    "DELETE FROM background_contact WHERE scenario_id NOT IN (SELECT scenario_id FROM "
    "replication);"
    "DELETE FROM background_run WHERE scenario_id NOT IN (SELECT scenario_id FROM replication);"
    "DELETE FROM scenario WHERE id NOT IN (SELECT scenario_id FROM replication);"
    // Treatments of a counterfactual study have no replications of their own.
    "DELETE FROM variant WHERE id NOT IN (SELECT variant_id FROM replication) AND id NOT IN "
    "(SELECT id FROM temp.planned_variant);"
    "DELETE FROM sweep_value; INSERT INTO sweep_value SELECT * FROM temp.planned_sweep_value";

// The plan into temporary tables, and whether it fits what the database holds.
static cp_status prepare_all(cp_store *store, const cp_plan_rows *rows, cp_error *error)
{
    cp_status status = execute(store, PREPARE, error);
    if (status == CP_OK)
        status = check_same_study(store, &rows->study, error);
    if (status == CP_OK)
        status = write_study(store, &rows->study, error);
    if (status == CP_OK)
        status = write_scenarios(store, rows, error);
    if (status == CP_OK)
        status = write_variants(store, rows, error);
    if (status == CP_OK)
        status = write_sweeps(store, rows, error);
    if (status == CP_OK)
        status = write_vehicle_models(store, rows, error);
    if (status == CP_OK)
        status = write_planned(store, rows, error);
    if (status == CP_OK)
        status = check_collisions(store, error);
    return status;
}

cp_status cp_plan_rows_write(cp_store *store, const cp_plan_rows *rows, cp_error *error)
{
    cp_status status = cp_store_begin(store, error);
    if (status != CP_OK)
        return status;
    status = prepare_all(store, rows, error);
    if (status == CP_OK)
        status = check_results_agree(store, error);
    if (status == CP_OK)
        status = execute(store, EXCHANGE, error);
    if (status == CP_OK)
        status = cp_store_commit(store, error);
    if (status != CP_OK)
        cp_store_rollback(store);
    return status;
}

// ---- looking only --------------------------------------------------------------------------

static cp_planned_state state_from(const char *status)
{
    static const struct {
        const char *text;
        cp_planned_state state;
    } STATE[] = {{"planned", CP_PLANNED_WAITING},
                 {"running", CP_PLANNED_RUNNING},
                 {"done", CP_PLANNED_DONE},
                 {"failed", CP_PLANNED_FAILED}};
    for (size_t k = 0; k < sizeof STATE / sizeof *STATE; k++)
        if (strcmp(STATE[k].text, status) == 0)
            return STATE[k].state;
    return CP_PLANNED_NEW;
}

static cp_status read_states(cp_store *store, const cp_plan_rows *rows, cp_planned_state *state,
                             cp_error *error)
{
    cp_statement s;
    cp_status status =
        cp_statement_prepare(store, "comparing with the plan",
                             "SELECT status FROM replication WHERE id = ?1", &s, error);
    for (size_t k = 0; status == CP_OK && k < rows->replication_count; k++) {
        int row = 0;
        cp_bind_integer(&s, 1, rows->replication[k].id);
        status = cp_statement_row(&s, &row, error);
        state[k] = row ? state_from(column_text(&s, 0)) : CP_PLANNED_NEW;
        sqlite3_reset(s.handle);
    }
    cp_statement_finish(&s);
    return status;
}

cp_status cp_plan_rows_compare(cp_store *store, const cp_plan_rows *rows, cp_planned_state *state,
                               size_t *dropped, cp_error *error)
{
    int64_t count = 0;
    for (size_t k = 0; k < rows->replication_count; k++)
        state[k] = CP_PLANNED_UNKNOWN;
    cp_status status = prepare_all(store, rows, error);
    if (status == CP_OK)
        status = read_states(store, rows, state, error);
    if (status == CP_OK)
        status = cp_store_integer(store, "comparing with the plan",
                                  "SELECT count(*) FROM replication WHERE status IN ('planned', "
                                  "'failed') AND id NOT IN (SELECT id FROM temp.plan)",
                                  &count, error);
    *dropped = (size_t)count;
    if (status == CP_OK)
        status = check_results_agree(store, error);
    return status;
}
