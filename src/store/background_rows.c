/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/background_rows.h"

#include "core/array.h"
#include "core/memory_stream.h"
#include "store/store_sqlite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- collecting ----------------------------------------------------------------------------

cp_background_contact_row *cp_background_rows_add_contact(cp_background_rows *rows)
{
    return cp_array_add(rows->contact, rows->contact_count);
}

void cp_background_rows_destroy(cp_background_rows *rows)
{
    for (size_t k = 0; k < rows->contact_count; k++) {
        free(rows->contact[k].vehicle[0]);
        free(rows->contact[k].vehicle[1]);
    }
    free(rows->contact);
    free(rows->sumo_version);
    free(rows->sumo_command_line);
    *rows = (cp_background_rows){0};
}

// ---- writing -------------------------------------------------------------------------------

static cp_status find_scenario(cp_store *store, const char *name, int64_t *id, cp_error *error)
{
    cp_statement s;
    int row = 0;
    cp_status status = cp_statement_prepare(store, "reading a scenario",
                                            "SELECT id FROM scenario WHERE name = ?1", &s, error);
    cp_bind_text(&s, 1, name);
    if (status == CP_OK)
        status = cp_statement_row(&s, &row, error);
    if (status == CP_OK && !row)
        status = cp_fail(error, CP_BAD_INPUT,
                         "%s: has no scenario '%s'; 'crashpulse run' brings it there",
                         cp_store_path(store), name);
    if (status == CP_OK)
        *id = sqlite3_column_int64(s.handle, 0);
    cp_statement_finish(&s);
    return status;
}

// The same run again.
static cp_status delete_earlier(cp_store *store, int64_t scenario, const cp_background_rows *rows,
                                cp_error *error)
{
    static const char *const SQL[] = {
        "DELETE FROM background_contact WHERE scenario_id = ?1 AND (seed, step_length_s) IN "
        "(SELECT seed, step_length_s FROM background_run WHERE scenario_id = ?1 AND seed = ?2 "
        "AND step_length_s = ?3)",
        "DELETE FROM background_run WHERE scenario_id = ?1 AND seed = ?2 AND step_length_s = ?3"};
    cp_status status = CP_OK;
    for (int k = 0; k < 2 && status == CP_OK; k++) {
        cp_statement s;
        status = cp_statement_prepare(store, "replacing a background", SQL[k], &s, error);
        cp_bind_integer(&s, 1, scenario);
        cp_bind_integer(&s, 2, (int64_t)rows->seed);
        cp_bind_real(&s, 3, rows->step_length_s);
        if (status == CP_OK)
            status = cp_statement_run(&s, error);
        cp_statement_finish(&s);
    }
    return status;
}

static cp_status insert_run(cp_store *store, int64_t scenario, const cp_background_rows *rows,
                            cp_error *error)
{
    cp_statement s;
    cp_status status =
        cp_statement_prepare(store, "writing a background",
                             "INSERT INTO background_run (scenario_id, seed, step_length_s, "
                             "simulated_s, vehicle_km, vehicle_h, departed, configuration_hash, "
                             "crashpulse_version, sumo_version, sumo_command_line) VALUES (?1, ?2, "
                             "?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11)",
                             &s, error);
    cp_bind_integer(&s, 1, scenario);
    cp_bind_integer(&s, 2, (int64_t)rows->seed);
    cp_bind_real(&s, 3, rows->step_length_s);
    cp_bind_real(&s, 4, rows->simulated_s);
    cp_bind_real(&s, 5, rows->vehicle_km);
    cp_bind_real(&s, 6, rows->vehicle_h);
    cp_bind_integer(&s, 7, (int64_t)rows->departed);
    cp_bind_text(&s, 8, rows->configuration_hash);
    cp_bind_text(&s, 9, CRASHPULSE_VERSION);
    cp_bind_text(&s, 10, rows->sumo_version);
    cp_bind_text(&s, 11, rows->sumo_command_line);
    if (status == CP_OK)
        status = cp_statement_run(&s, error);
    cp_statement_finish(&s);
    return status;
}

static cp_status insert_contacts(cp_store *store, int64_t scenario, const cp_background_rows *rows,
                                 cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "writing a background",
        "INSERT INTO background_contact (scenario_id, seed, step_length_s, number, time_s, x_m, "
        "y_m, reason, crash_type, closing_speed_m_s, lateral_offset_m, angle_rad, vehicle_1, "
        "vehicle_2) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14)",
        &s, error);
    for (size_t k = 0; k < rows->contact_count && status == CP_OK; k++) {
        const cp_background_contact_row *contact = &rows->contact[k];
        cp_bind_integer(&s, 1, scenario);
        cp_bind_integer(&s, 2, (int64_t)rows->seed);
        cp_bind_real(&s, 3, rows->step_length_s);
        cp_bind_integer(&s, 4, (int64_t)k);
        cp_bind_real(&s, 5, contact->time_s);
        cp_bind_real(&s, 6, contact->contact_m.x);
        cp_bind_real(&s, 7, contact->contact_m.y);
        cp_bind_text(&s, 8, contact->reason);
        cp_bind_text(&s, 9, contact->crash_type);
        cp_bind_real(&s, 10, contact->closing_speed_m_s);
        cp_bind_real(&s, 11, contact->lateral_offset_m);
        cp_bind_real(&s, 12, contact->angle_rad);
        cp_bind_text(&s, 13, contact->vehicle[0]);
        cp_bind_text(&s, 14, contact->vehicle[1]);
        status = cp_statement_run(&s, error);
    }
    cp_statement_finish(&s);
    return status;
}

cp_status cp_background_rows_write(cp_store *store, const cp_background_rows *rows, cp_error *error)
{
    int64_t scenario = 0;
    cp_status status = cp_store_begin(store, error);
    if (status != CP_OK)
        return status;
    status = find_scenario(store, rows->scenario, &scenario, error);
    if (status == CP_OK)
        status = delete_earlier(store, scenario, rows, error);
    if (status == CP_OK)
        status = insert_run(store, scenario, rows, error);
    if (status == CP_OK)
        status = insert_contacts(store, scenario, rows, error);
    if (status == CP_OK)
        status = cp_store_commit(store, error);
    if (status != CP_OK)
        cp_store_rollback(store);
    return status;
}

// ---- looking -------------------------------------------------------------------------------

cp_status cp_background_rows_check(cp_store *store, const char *scenario, cp_error *error)
{
    int64_t id = 0;
    return find_scenario(store, scenario, &id, error);
}

// Configuration hashes of all that is planned, as a JSON list; the caller frees.
static char *planned_hashes(const cp_plan_rows *plan)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = cp_memory_stream(&text, &size);
    if (out == NULL)
        return NULL;
    fputc('[', out);
    for (size_t k = 0; k < plan->background_count; k++)
        fprintf(out, "%s\"%s\"", k > 0 ? "," : "", plan->background[k].configuration_hash);
    fputc(']', out);
    int failed = ferror(out);
    if (fclose(out) == 0 && !failed)
        return text;
    free(text);
    return NULL;
}

cp_status cp_background_rows_drop_stale(cp_store *store, const cp_plan_rows *plan, cp_error *error)
{
#define STALE                                                                                      \
    "configuration_hash <> '' AND configuration_hash NOT IN (SELECT value FROM json_each(?1))"
    static const char *const SQL[] = {
        "DELETE FROM background_contact WHERE (scenario_id, seed, step_length_s) IN (SELECT "
        "scenario_id, seed, step_length_s FROM background_run WHERE " STALE ")",
        "DELETE FROM background_run WHERE " STALE};
#undef STALE
    // A study that plans none keeps what there is.
    if (plan->background_count == 0)
        return CP_OK;
    char *hashes = planned_hashes(plan);
    cp_status status =
        hashes != NULL ? cp_store_begin(store, error) : cp_fail_memory(error, "backgrounds");
    if (status != CP_OK) {
        free(hashes);
        return status;
    }
    for (int k = 0; k < 2 && status == CP_OK; k++) {
        cp_statement s;
        status = cp_statement_prepare(store, "dropping stale backgrounds", SQL[k], &s, error);
        cp_bind_text(&s, 1, hashes);
        if (status == CP_OK)
            status = cp_statement_run(&s, error);
        cp_statement_finish(&s);
    }
    if (status == CP_OK)
        status = cp_store_commit(store, error);
    if (status != CP_OK)
        cp_store_rollback(store);
    free(hashes);
    return status;
}

cp_status cp_background_rows_missing(cp_store *store, const cp_plan_rows *plan, bool *missing,
                                     cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "reading the backgrounds",
        "SELECT count(*) FROM background_run AS b JOIN scenario AS s ON s.id = b.scenario_id WHERE "
        "s.name = ?1 AND b.configuration_hash = ?2",
        &s, error);
    for (size_t k = 0; status == CP_OK && k < plan->background_count; k++) {
        const cp_background_plan_row *row = &plan->background[k];
        int found = 0;
        cp_bind_text(&s, 1, plan->scenario[row->scenario].name);
        cp_bind_text(&s, 2, row->configuration_hash);
        status = cp_statement_row(&s, &found, error);
        missing[k] = status == CP_OK && sqlite3_column_int(s.handle, 0) == 0;
        // To its end, ready for the next.
        while (status == CP_OK && found)
            status = cp_statement_row(&s, &found, error);
        sqlite3_reset(s.handle);
    }
    cp_statement_finish(&s);
    return status;
}
