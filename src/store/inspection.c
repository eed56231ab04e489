/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/inspection.h"

#include "core/hash.h"
#include "store/pulse_columns.h"
#include "store/store_sqlite.h"

#include <stdio.h>
#include <string.h>

static cp_inspection_result *add(cp_inspection *inspection, const char *what)
{
    cp_inspection_result *result = &inspection->result[inspection->count++];
    *result = (cp_inspection_result){.what = what};
    return result;
}

static void note(cp_inspection_result *result, const char *text)
{
    if (result->wrong++ == 0)
        snprintf(result->first, sizeof result->first, "%s", text);
}

static const char *text_of(const cp_statement *s, int column)
{
    const unsigned char *text = sqlite3_column_text(s->handle, column);
    return text != NULL ? (const char *)text : "";
}

// ---- rows that a query finds to be wrong ---------------------------------------------------

// A rule: how many rows it speaks of, and a query for those that break it, in words.
typedef struct rule {
    const char *what;
    const char *count;
    const char *broken;
} rule;

static const rule RULES[] = {
    {"references", "SELECT count(*) FROM sqlite_schema WHERE type = 'table'",
     "SELECT 'a row of ' || \"table\" || ' names one of ' || \"parent\" || ' that is not there' "
     "FROM pragma_foreign_key_check"},
    {"vehicles of crashes", "SELECT count(*) FROM crash",
     "SELECT 'crash ' || id || ' has not one vehicle a and one b' FROM crash AS c WHERE 2 <> "
     "(SELECT count(*) FROM crash_vehicle AS v WHERE v.crash_id = c.id)"},
    {"copies in crash_vehicle", "SELECT count(*) FROM crash_vehicle",
     "SELECT 'vehicle ' || v.role || ' of crash ' || v.crash_id || ' does not agree with its "
     "crash' FROM crash_vehicle AS v JOIN crash AS c ON c.id = v.crash_id JOIN replication AS r "
     "ON r.id = c.replication_id WHERE v.scenario_id <> r.scenario_id OR v.variant_id <> "
     "r.variant_id OR v.crash_type <> c.crash_type"},
    {"numbers of crashes", "SELECT count(DISTINCT replication_id) FROM crash",
     "SELECT 'replication ' || replication_id || ' has a gap in the numbers of its crashes' FROM "
     "crash GROUP BY replication_id HAVING max(number) + 1 <> count(*)"},
    {"results without status done", "SELECT count(*) FROM replication",
     "SELECT 'replication ' || id || ' is ' || status || ' and has crashes' FROM replication AS r "
     "WHERE status <> 'done' AND EXISTS (SELECT 1 FROM crash AS c WHERE c.replication_id = r.id)"},
    {"exposure of finished replications", "SELECT count(*) FROM replication WHERE status = 'done'",
     "SELECT 'replication ' || id || ' is done and has no exposure' FROM replication WHERE status "
     "= 'done' AND (vehicle_km IS NULL OR vehicle_h IS NULL OR simulated_s IS NULL)"},
    {"running replications", "SELECT count(*) FROM replication WHERE status = 'running'",
     "SELECT 'replication ' || id || ' is running without an attempt' FROM replication AS r WHERE "
     "status = 'running' AND NOT EXISTS (SELECT 1 FROM attempt AS a WHERE a.replication_id = r.id "
     "AND a.outcome = 'running')"},
    {"driver errors of vehicles", "SELECT count(*) FROM crash_vehicle",
     "SELECT 'vehicle ' || v.role || ' of crash ' || v.crash_id || ' has not the ' || "
     "coalesce(v.error_count, 'no') || ' driver errors it counts' FROM crash_vehicle AS v WHERE "
     "coalesce(v.error_count, 0) <> (SELECT count(*) FROM crash_driver_error AS e WHERE e.crash_id "
     "= v.crash_id AND e.role = v.role)"},
    {"functions of vehicles", "SELECT count(*) FROM crash_function",
     "SELECT 'vehicle ' || v.role || ' of crash ' || v.crash_id || ' has not one row for each "
     "function of its variant' FROM crash_vehicle AS v JOIN variant AS t ON t.id = v.variant_id "
     "WHERE v.error_count IS NOT NULL AND json_array_length(t.functions) <> (SELECT count(*) FROM "
     "crash_function AS f WHERE f.crash_id = v.crash_id AND f.role = v.role)"},
    {"pulses of simulated vehicles", "SELECT count(*) FROM crash_vehicle",
     "SELECT 'vehicle ' || v.role || ' of crash ' || v.crash_id || CASE WHEN p.samples IS NULL "
     "THEN ' has no pulse' ELSE ' has a pulse but no severity' END FROM crash_vehicle AS v LEFT "
     "JOIN pulse AS p USING (crash_id, role) WHERE (v.delta_v_m_s IS NULL) <> (p.samples IS "
     "NULL)"},
};

// The same of counterfactual pairs.
static const rule PAIR_RULES[] = {
    {"treatments of crashes", "SELECT count(*) FROM counterfactual",
     "SELECT 'crash ' || n.crash_id || ' has not one outcome under each treatment' FROM "
     "null_treatment AS n WHERE (SELECT count(*) FROM counterfactual AS c WHERE c.crash_id = "
     "n.crash_id) <> (SELECT count(*) FROM variant WHERE is_baseline = 0)"},
    {"vehicles of treated crashes", "SELECT count(*) FROM counterfactual WHERE time_s IS NOT NULL",
     "SELECT 'crash ' || crash_id || ' under variant ' || variant_id || ' has not the vehicles of "
     "its outcome' FROM counterfactual AS c WHERE (SELECT count(*) FROM counterfactual_vehicle AS "
     "v WHERE v.crash_id = c.crash_id AND v.variant_id = c.variant_id) <> CASE WHEN time_s IS NULL "
     "THEN 0 ELSE 2 END"},
    {"driver errors of treated vehicles", "SELECT count(*) FROM counterfactual_vehicle",
     "SELECT 'vehicle ' || v.role || ' of crash ' || v.crash_id || ' under variant ' || "
     "v.variant_id || ' has not the driver errors it counts' FROM counterfactual_vehicle AS v "
     "WHERE "
     "coalesce(v.error_count, 0) <> (SELECT count(*) FROM counterfactual_driver_error AS e WHERE "
     "e.crash_id = v.crash_id AND e.variant_id = v.variant_id AND e.role = v.role)"},
    {"pulses of treated vehicles", "SELECT count(*) FROM counterfactual_vehicle",
     "SELECT 'vehicle ' || v.role || ' of crash ' || v.crash_id || ' under variant ' || "
     "v.variant_id || CASE WHEN p.samples IS NULL THEN ' has no pulse' ELSE ' has a pulse but no "
     "severity' END FROM counterfactual_vehicle AS v LEFT JOIN counterfactual_pulse AS p USING "
     "(crash_id, variant_id, role) WHERE (v.delta_v_m_s IS NULL) <> (p.samples IS NULL)"},
};

// Besides them the file, vehicle files, pulses and what is looked at in pairs.
_Static_assert(sizeof RULES / sizeof *RULES + sizeof PAIR_RULES / sizeof *PAIR_RULES + 8 <=
                   CP_INSPECTION_RESULTS_MAX,
               "no room for so many results");

static cp_status apply_rule(cp_store *store, const rule *applied, cp_inspection *inspection,
                            cp_error *error)
{
    cp_inspection_result *result = add(inspection, applied->what);
    cp_statement s;
    int row = 0;
    cp_status status =
        cp_store_integer(store, applied->what, applied->count, &result->looked_at, error);
    if (status != CP_OK)
        return status;
    status = cp_statement_prepare(store, applied->what, applied->broken, &s, error);
    while (status == CP_OK && (status = cp_statement_row(&s, &row, error)) == CP_OK && row)
        note(result, text_of(&s, 0));
    cp_statement_finish(&s);
    return status;
}

// ---- what SQL alone cannot tell ------------------------------------------------------------

static cp_status check_file(cp_store *store, cp_inspection *inspection, cp_error *error)
{
    cp_inspection_result *result = add(inspection, "file structure");
    cp_statement s;
    int row = 0;
    cp_status status =
        cp_store_integer(store, result->what, "PRAGMA page_count", &result->looked_at, error);
    if (status != CP_OK)
        return status;
    status = cp_statement_prepare(store, result->what, "PRAGMA integrity_check(100)", &s, error);
    while (status == CP_OK && (status = cp_statement_row(&s, &row, error)) == CP_OK && row)
        if (strcmp(text_of(&s, 0), "ok") != 0)
            note(result, text_of(&s, 0));
    cp_statement_finish(&s);
    return status;
}

static cp_status check_vehicle_files(cp_store *store, cp_inspection *inspection, cp_error *error)
{
    cp_inspection_result *result = add(inspection, "hashes of vehicle files");
    cp_statement s;
    int row = 0;
    cp_status status = cp_statement_prepare(
        store, result->what, "SELECT name, hash, yaml FROM vehicle_model", &s, error);
    while (status == CP_OK && (status = cp_statement_row(&s, &row, error)) == CP_OK && row) {
        char hex[CP_HASH_TEXT_SIZE], text[256];
        const char *yaml = text_of(&s, 2);
        cp_hash_bytes(yaml, (size_t)sqlite3_column_bytes(s.handle, 2), hex);
        result->looked_at++;
        snprintf(text, sizeof text, "vehicle model %.100s is not the file its hash tells of",
                 text_of(&s, 0));
        if (strcmp(hex, text_of(&s, 1)) != 0)
            note(result, text);
    }
    cp_statement_finish(&s);
    return status;
}

// One stored pulse; a damaged one is noted.
static cp_status check_pulse(const cp_statement *s, cp_inspection_result *result, cp_error *error)
{
    cp_pulse pulse = {0};
    cp_error damage = {0};
    char text[512], treatment[64] = "";
    result->looked_at++;
    cp_status status = cp_pulse_of_columns(s, 2, &pulse, &damage);
    cp_pulse_destroy(&pulse);
    if (status != CP_OK && status != CP_BAD_INPUT)
        return cp_fail(error, status, "%s", damage.text);
    if (sqlite3_column_type(s->handle, 6) != SQLITE_NULL)
        snprintf(treatment, sizeof treatment, " under variant %lld",
                 (long long)sqlite3_column_int64(s->handle, 6));
    snprintf(text, sizeof text, "vehicle %s of crash %lld%s: %.400s", text_of(s, 1),
             (long long)sqlite3_column_int64(s->handle, 0), treatment, damage.text);
    if (status == CP_BAD_INPUT)
        note(result, text);
    return CP_OK;
}

static cp_status check_pulses(cp_store *store, const char *what, const char *sql,
                              cp_inspection *inspection, cp_error *error)
{
    cp_inspection_result *result = add(inspection, what);
    cp_statement s;
    int row = 0;
    cp_status status = cp_statement_prepare(store, what, sql, &s, error);
    while (status == CP_OK && (status = cp_statement_row(&s, &row, error)) == CP_OK && row)
        status = check_pulse(&s, result, error);
    cp_statement_finish(&s);
    return status;
}

// Only a counterfactual study has pairs to look at.
static cp_status check_pairs(cp_store *store, cp_inspection *inspection, cp_error *error)
{
    int64_t pairs = 0;
    cp_status status = cp_store_integer(
        store, "reading the design", "SELECT count(*) FROM study WHERE design = 'counterfactual'",
        &pairs, error);
    for (size_t k = 0; status == CP_OK && pairs && k < sizeof PAIR_RULES / sizeof *PAIR_RULES; k++)
        status = apply_rule(store, &PAIR_RULES[k], inspection, error);
    if (status == CP_OK && pairs)
        status = check_pulses(store, "stored pulses of treated vehicles",
                              "SELECT crash_id, role, " CP_PULSE_COLUMNS
                              ", variant_id FROM counterfactual_pulse",
                              inspection, error);
    return status;
}

cp_status cp_inspection_run(cp_store *store, cp_inspection *inspection, cp_error *error)
{
    *inspection = (cp_inspection){0};
    cp_status status = check_file(store, inspection, error);
    for (size_t k = 0; status == CP_OK && k < sizeof RULES / sizeof *RULES; k++)
        status = apply_rule(store, &RULES[k], inspection, error);
    if (status == CP_OK)
        status = check_vehicle_files(store, inspection, error);
    if (status == CP_OK)
        status = check_pulses(store, "stored pulses",
                              "SELECT crash_id, role, " CP_PULSE_COLUMNS ", NULL FROM pulse",
                              inspection, error);
    if (status == CP_OK)
        status = check_pairs(store, inspection, error);
    for (int k = 0; k < inspection->count; k++)
        inspection->wrong += inspection->result[k].wrong;
    return status;
}
