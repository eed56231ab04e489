/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/background_rows.h"

#include "store/store_sqlite.h"

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

static cp_status delete_earlier(cp_store *store, int64_t scenario, const cp_background_rows *rows,
                                cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "replacing a background",
        "DELETE FROM background WHERE scenario_id = ?1 AND seed = ?2 AND step_length_s = ?3", &s,
        error);
    cp_bind_integer(&s, 1, scenario);
    cp_bind_integer(&s, 2, (int64_t)rows->seed);
    cp_bind_real(&s, 3, rows->step_length_s);
    if (status == CP_OK)
        status = cp_statement_run(&s, error);
    cp_statement_finish(&s);
    return status;
}

static cp_status insert(cp_store *store, int64_t scenario, const cp_background_rows *rows,
                        cp_error *error)
{
    static const cp_background_contact NONE = {"none", "", 0};
    const cp_background_contact *contacts = rows->count > 0 ? rows->contacts : &NONE;
    size_t count = rows->count > 0 ? rows->count : 1;
    cp_statement s;
    cp_status status =
        cp_statement_prepare(store, "writing a background",
                             "INSERT INTO background (scenario_id, seed, step_length_s, "
                             "simulated_s, vehicle_km, reason, "
                             "crash_type, contacts) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
                             &s, error);
    for (size_t k = 0; k < count && status == CP_OK; k++) {
        cp_bind_integer(&s, 1, scenario);
        cp_bind_integer(&s, 2, (int64_t)rows->seed);
        cp_bind_real(&s, 3, rows->step_length_s);
        cp_bind_real(&s, 4, rows->simulated_s);
        cp_bind_real(&s, 5, rows->vehicle_km);
        cp_bind_text(&s, 6, contacts[k].reason);
        cp_bind_text(&s, 7, contacts[k].crash_type);
        cp_bind_integer(&s, 8, contacts[k].contacts);
        status = cp_statement_run(&s, error);
    }
    cp_statement_finish(&s);
    return status;
}

cp_status cp_background_rows_write(cp_store *store, const cp_background_rows *rows, cp_error *error)
{
    int64_t scenario = 0;
    cp_status status = cp_store_begin(store, error);
    if (status == CP_OK)
        status = find_scenario(store, rows->scenario, &scenario, error);
    if (status == CP_OK)
        status = delete_earlier(store, scenario, rows, error);
    if (status == CP_OK)
        status = insert(store, scenario, rows, error);
    if (status == CP_OK)
        status = cp_store_commit(store, error);
    if (status != CP_OK)
        cp_store_rollback(store);
    return status;
}
