/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/participant_binding.h"

#include <math.h>

static const char *const ROLE[2] = {"a", "b"};

int cp_participant_error_count(const cp_participant_rows *rows, int role)
{
    int count = 0;
    if (!rows->is_known)
        return -1;
    for (size_t k = 0; k < rows->error_count; k++)
        count += rows->error[k].role == role;
    return count;
}

static cp_status write_errors(cp_statement *s, int key, const cp_participant_rows *rows,
                              cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < rows->error_count; k++) {
        const cp_driver_error_row *row = &rows->error[k];
        cp_bind_text(s, key + 1, ROLE[row->role]);
        cp_bind_integer(s, key + 2, (int64_t)row->number);
        cp_bind_text(s, key + 3, row->name);
        cp_bind_text(s, key + 4, row->towards);
        cp_bind_real(s, key + 5, row->began_s);
        cp_bind_real(s, key + 6, row->ended_s);
        cp_bind_integer(s, key + 7, row->is_cause);
        status = cp_statement_run(s, error);
    }
    return status;
}

static cp_status write_functions(cp_statement *s, int key, const cp_participant_rows *rows,
                                 cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < rows->function_count; k++) {
        const cp_function_row *row = &rows->function[k];
        cp_bind_text(s, key + 1, ROLE[row->role]);
        cp_bind_integer(s, key + 2, (int64_t)row->number);
        cp_bind_text(s, key + 3, row->name);
        cp_bind_text(s, key + 4, row->state);
        cp_bind_real(s, key + 5, row->warned_s);
        cp_bind_real(s, key + 6, row->requested_s);
        cp_bind_real(s, key + 7, row->braking_s);
        cp_bind_real(s, key + 8, row->steering_s);
        cp_bind_real(s, key + 9, row->released_s);
        cp_bind_real(s, key + 10, row->brake_request_m_s2);
        cp_bind_real(s, key + 11, row->deceleration_m_s2);
        cp_bind_real(s, key + 12, row->speed_taken_off_m_s);
        status = cp_statement_run(s, error);
    }
    return status;
}

cp_status cp_participant_writer_prepare(cp_participant_writer *w, cp_store *store, bool is_treated,
                                        cp_error *error)
{
    const char *what = "writing driver errors and functions of a crash";
    cp_status status = cp_statement_prepare(
        store, what,
        is_treated ? "INSERT INTO counterfactual_driver_error VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, "
                     "?8, ?9)"
                   : "INSERT INTO crash_driver_error VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
        &w->driver_error, error);
    if (status == CP_OK)
        status = cp_statement_prepare(
            store, what,
            is_treated
                ? "INSERT INTO counterfactual_function VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, "
                  "?10, ?11, ?12, ?13, ?14)"
                : "INSERT INTO crash_function VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, "
                  "?11, ?12, ?13)",
            &w->function, error);
    return status;
}

cp_status cp_participant_writer_write(cp_participant_writer *w, int64_t crash_id,
                                      const int64_t *variant_id, const cp_participant_rows *rows,
                                      cp_error *error)
{
    cp_statement *statement[2] = {&w->driver_error, &w->function};
    int key = variant_id != NULL ? 2 : 1;
    for (int k = 0; k < 2; k++) {
        cp_bind_integer(statement[k], 1, crash_id);
        if (variant_id != NULL)
            cp_bind_integer(statement[k], 2, *variant_id);
    }
    cp_status status = write_errors(&w->driver_error, key, rows, error);
    return status == CP_OK ? write_functions(&w->function, key, rows, error) : status;
}

void cp_participant_writer_finish(cp_participant_writer *w)
{
    cp_statement_finish(&w->driver_error);
    cp_statement_finish(&w->function);
}
