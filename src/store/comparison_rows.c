/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/comparison_rows.h"

#include "core/hash.h"
#include "store/store_sqlite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Infinite bounds are open ones, and open is NULL.
static void bind_finite(cp_statement *s, int place, double value)
{
    cp_bind_real(s, place, isfinite(value) ? value : NAN);
}

// The same question has the same id, so its answer is replaced.
static cp_status comparison_id(const cp_comparison_rows *rows, int64_t *id, cp_error *error)
{
    size_t size = strlen(rows->baseline) + strlen(rows->scenario) + strlen(rows->by) +
                  strlen(rows->where_sql) + 4;
    char *key = malloc(size);
    if (key == NULL)
        return cp_fail_memory(error, "a comparison");
    snprintf(key, size, "%s|%s|%s|%s", rows->baseline, rows->scenario, rows->by, rows->where_sql);
    *id = cp_hash_row_id(key);
    free(key);
    return CP_OK;
}

static cp_status remove_older(cp_store *store, int64_t id, cp_error *error)
{
    static const char *const SQL[] = {"DELETE FROM comparison_figure WHERE comparison_id = ?1",
                                      "DELETE FROM comparison WHERE id = ?1"};
    for (size_t k = 0; k < 2; k++) {
        cp_statement s;
        cp_status status =
            cp_statement_prepare(store, "removing an older comparison", SQL[k], &s, error);
        if (status == CP_OK) {
            cp_bind_integer(&s, 1, id);
            status = cp_statement_run(&s, error);
        }
        cp_statement_finish(&s);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

static cp_status write_comparison(cp_store *store, int64_t id, const cp_comparison_rows *rows,
                                  cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "writing a comparison",
        "INSERT INTO comparison (id, baseline, scenario, by, where_sql, design, seed, repetitions,"
        " permutations, replications, crashes, answer, crashpulse_version)"
        " VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13)",
        &s, error);
    if (status == CP_OK) {
        cp_bind_integer(&s, 1, id);
        cp_bind_text(&s, 2, rows->baseline);
        cp_bind_text(&s, 3, rows->scenario);
        cp_bind_text(&s, 4, rows->by);
        cp_bind_text(&s, 5, rows->where_sql);
        cp_bind_text(&s, 6, rows->design);
        cp_bind_integer(&s, 7, (int64_t)rows->seed);
        cp_bind_integer(&s, 8, (int64_t)rows->repetitions);
        cp_bind_integer(&s, 9, (int64_t)rows->permutations);
        cp_bind_integer(&s, 10, (int64_t)rows->replications);
        cp_bind_integer(&s, 11, (int64_t)rows->crashes);
        cp_bind_text(&s, 12, rows->answer);
        cp_bind_text(&s, 13, CRASHPULSE_VERSION);
        status = cp_statement_run(&s, error);
    }
    cp_statement_finish(&s);
    return status;
}

static cp_status write_figures(cp_store *store, int64_t id, const cp_comparison_rows *rows,
                               cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "writing the figures of a comparison",
        "INSERT INTO comparison_figure (comparison_id, number, by_value, variant, against, scope,"
        " quantity, relation, value, low, high, interval)"
        " VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12)",
        &s, error);
    for (size_t k = 0; status == CP_OK && k < rows->figure_count; k++) {
        const cp_comparison_figure_row *f = &rows->figure[k];
        cp_bind_integer(&s, 1, id);
        cp_bind_integer(&s, 2, (int64_t)k);
        cp_bind_text(&s, 3, f->by_value);
        cp_bind_text(&s, 4, f->variant);
        cp_bind_text(&s, 5, f->against);
        cp_bind_text(&s, 6, f->scope);
        cp_bind_text(&s, 7, f->quantity);
        cp_bind_text(&s, 8, f->relation);
        bind_finite(&s, 9, f->value);
        bind_finite(&s, 10, f->low);
        bind_finite(&s, 11, f->high);
        cp_bind_text(&s, 12, f->interval);
        status = cp_statement_run(&s, error);
    }
    cp_statement_finish(&s);
    return status;
}

cp_status cp_comparison_rows_replace(cp_store *store, const cp_comparison_rows *rows,
                                     cp_error *error)
{
    int64_t id = 0;
    cp_status status = comparison_id(rows, &id, error);
    if (status == CP_OK)
        status = cp_store_begin(store, error);
    if (status == CP_OK)
        status = remove_older(store, id, error);
    if (status == CP_OK)
        status = write_comparison(store, id, rows, error);
    if (status == CP_OK)
        status = write_figures(store, id, rows, error);
    if (status == CP_OK)
        status = cp_store_commit(store, error);
    if (status != CP_OK)
        cp_store_rollback(store);
    return status;
}
