/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/claim.h"

#include "core/array.h"
#include "store/store_sqlite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The outcome of the attempt and what becomes of the replication.
static const struct {
    const char *outcome;
    const char *status;
} END_TEXT[] = {[CP_CLAIM_FAILED] = {"failed", "failed"},
                [CP_CLAIM_LOST] = {"lost", "planned"},
                [CP_CLAIM_INTERRUPTED] = {"interrupted", "planned"}};

cp_status cp_claim_waiting(cp_store *store, int64_t **ids, size_t *count, cp_error *error)
{
    cp_statement s;
    int row = 0;
    *ids = NULL;
    *count = 0;
    cp_status status = cp_statement_prepare(
        store, "reading the queue",
        "SELECT r.id FROM replication AS r JOIN scenario AS s ON s.id = r.scenario_id "
        "JOIN variant AS v ON v.id = r.variant_id WHERE r.status IN ('planned', 'failed') "
        "ORDER BY r.number, s.number, v.number",
        &s, error);
    while (status == CP_OK) {
        status = cp_statement_row(&s, &row, error);
        if (status != CP_OK || !row)
            break;
        int64_t *id = cp_array_add(*ids, *count);
        if (id != NULL)
            *id = sqlite3_column_int64(s.handle, 0);
        else
            status = cp_fail_memory(error, "queue of replications");
    }
    cp_statement_finish(&s);
    if (status != CP_OK) {
        free(*ids);
        *ids = NULL;
        *count = 0;
    }
    return status;
}

// ---- taking --------------------------------------------------------------------------------

static cp_status check_claimable(cp_store *store, int64_t replication_id,
                                 const char *configuration_hash, bool *waiting, cp_error *error)
{
    cp_statement s;
    int row = 0;
    cp_status status = cp_statement_prepare(
        store, "claiming",
        "SELECT status IN ('planned', 'failed'), configuration_hash = ?2 FROM replication "
        "WHERE id = ?1",
        &s, error);
    cp_bind_integer(&s, 1, replication_id);
    cp_bind_text(&s, 2, configuration_hash);
    if (status == CP_OK)
        status = cp_statement_row(&s, &row, error);
    if (status == CP_OK && !row)
        status = cp_fail(error, CP_BAD_INPUT, "%s: has no replication %lld", cp_store_path(store),
                         (long long)replication_id);
    if (status == CP_OK && !sqlite3_column_int(s.handle, 1))
        status = cp_fail(error, CP_BAD_INPUT,
                         "%s: the study or a file it names was changed during the run",
                         cp_store_path(store));
    *waiting = status == CP_OK && sqlite3_column_int(s.handle, 0);
    cp_statement_finish(&s);
    return status;
}

// One more attempt of a replication, numbered after the last; its number comes back.
static cp_status add_attempt(cp_store *store, int64_t replication_id, const cp_owner *owner,
                             int *attempt, cp_error *error)
{
    cp_statement s;
    int row = 0;
    cp_status status = cp_statement_prepare(
        store, "claiming",
        "INSERT INTO attempt (replication_id, number, host, pid, process_start, started, outcome) "
        "SELECT ?1, coalesce(max(number), 0) + 1, ?2, ?3, ?4, strftime('%Y-%m-%dT%H:%M:%fZ'), "
        "'running' FROM attempt WHERE replication_id = ?1 RETURNING number",
        &s, error);
    cp_bind_integer(&s, 1, replication_id);
    cp_bind_text(&s, 2, owner->host);
    cp_bind_integer(&s, 3, owner->pid);
    cp_bind_integer(&s, 4, owner->process_start);
    if (status == CP_OK)
        status = cp_statement_row(&s, &row, error);
    if (status == CP_OK)
        *attempt = sqlite3_column_int(s.handle, 0);
    while (status == CP_OK && row)
        status = cp_statement_row(&s, &row, error);
    cp_statement_finish(&s);
    return status;
}

static cp_status set_status(cp_store *store, int64_t replication_id, const char *text,
                            cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "setting a status", "UPDATE replication SET status = ?2 WHERE id = ?1", &s, error);
    cp_bind_integer(&s, 1, replication_id);
    cp_bind_text(&s, 2, text);
    if (status == CP_OK)
        status = cp_statement_run(&s, error);
    cp_statement_finish(&s);
    return status;
}

cp_status cp_claim_take(cp_store *store, int64_t replication_id, const char *configuration_hash,
                        const cp_owner *owner, int *attempt, cp_error *error)
{
    bool waiting = false;
    *attempt = 0;
    cp_status status = cp_store_begin(store, error);
    if (status != CP_OK)
        return status;
    status = check_claimable(store, replication_id, configuration_hash, &waiting, error);
    if (status == CP_OK && waiting)
        status = set_status(store, replication_id, "running", error);
    if (status == CP_OK && waiting)
        status = add_attempt(store, replication_id, owner, attempt, error);
    if (status == CP_OK)
        status = cp_store_commit(store, error);
    if (status != CP_OK) {
        cp_store_rollback(store);
        *attempt = 0;
    }
    return status;
}

// ---- ending --------------------------------------------------------------------------------

// End the running attempt of host and pid inside the open transaction.
static cp_status end_attempt(cp_store *store, int64_t replication_id, const char *host, int64_t pid,
                             cp_claim_end end, double wall_time_s, const char *message, bool *ended,
                             cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "ending a claim",
        "UPDATE attempt SET outcome = ?4, wall_time_s = ?5, message = ?6 WHERE replication_id = ?1 "
        "AND host = ?2 AND pid = ?3 AND outcome = 'running'",
        &s, error);
    cp_bind_integer(&s, 1, replication_id);
    cp_bind_text(&s, 2, host);
    cp_bind_integer(&s, 3, pid);
    cp_bind_text(&s, 4, END_TEXT[end].outcome);
    cp_bind_real(&s, 5, wall_time_s);
    cp_bind_text(&s, 6, message);
    if (status == CP_OK)
        status = cp_statement_run(&s, error);
    cp_statement_finish(&s);
    *ended = status == CP_OK && sqlite3_changes(cp_store_sqlite(store)) > 0;
    if (*ended)
        status = set_status(store, replication_id, END_TEXT[end].status, error);
    return status;
}

cp_status cp_claim_end_of(cp_store *store, int64_t replication_id, const char *host, int64_t pid,
                          cp_claim_end end, double wall_time_s, const char *message, bool *ended,
                          cp_error *error)
{
    *ended = false;
    cp_status status = cp_store_begin(store, error);
    if (status != CP_OK)
        return status;
    status = end_attempt(store, replication_id, host, pid, end, wall_time_s, message, ended, error);
    if (status == CP_OK)
        status = cp_store_commit(store, error);
    if (status != CP_OK)
        cp_store_rollback(store);
    return status;
}

cp_status cp_claim_record_failure(cp_store *store, int64_t replication_id, const cp_owner *owner,
                                  double wall_time_s, const char *message, cp_error *error)
{
    cp_statement s;
    int attempt = 0, waiting = 0;
    bool ended = false;
    cp_status status = cp_store_begin(store, error);
    if (status != CP_OK)
        return status;
    status = cp_statement_prepare(
        store, "recording a failure",
        "SELECT 1 FROM replication WHERE id = ?1 AND status IN ('planned', 'failed')", &s, error);
    cp_bind_integer(&s, 1, replication_id);
    if (status == CP_OK)
        status = cp_statement_row(&s, &waiting, error);
    cp_statement_finish(&s);
    if (status == CP_OK && waiting)
        status = add_attempt(store, replication_id, owner, &attempt, error);
    if (status == CP_OK && waiting)
        status = end_attempt(store, replication_id, owner->host, owner->pid, CP_CLAIM_FAILED,
                             wall_time_s, message, &ended, error);
    if (status == CP_OK)
        status = cp_store_commit(store, error);
    if (status != CP_OK)
        cp_store_rollback(store);
    return status;
}

// The first running attempt whose owner is dead.
static cp_status next_dead(cp_store *store, bool (*is_alive)(const cp_owner *owner),
                           int64_t *replication_id, cp_owner *owner, int *found, cp_error *error)
{
    cp_statement s;
    int row = 0;
    *found = 0;
    cp_status status = cp_statement_prepare(
        store, "looking for dead owners",
        "SELECT replication_id, host, pid, process_start FROM attempt WHERE outcome = 'running' "
        "ORDER BY replication_id",
        &s, error);
    while (status == CP_OK && !*found) {
        status = cp_statement_row(&s, &row, error);
        if (status != CP_OK || !row)
            break;
        *replication_id = sqlite3_column_int64(s.handle, 0);
        snprintf(owner->host, sizeof owner->host, "%s",
                 (const char *)sqlite3_column_text(s.handle, 1));
        owner->pid = sqlite3_column_int64(s.handle, 2);
        owner->process_start = sqlite3_column_int64(s.handle, 3);
        *found = !is_alive(owner);
    }
    cp_statement_finish(&s);
    return status;
}

cp_status cp_claim_release_dead(cp_store *store, bool (*is_alive)(const cp_owner *owner),
                                size_t *released, cp_error *error)
{
    int64_t replication_id = 0;
    cp_owner owner;
    int found = 1;
    *released = 0;
    cp_status status = cp_store_begin(store, error);
    while (status == CP_OK && found) {
        bool ended = false;
        status = next_dead(store, is_alive, &replication_id, &owner, &found, error);
        if (status == CP_OK && found)
            status = end_attempt(store, replication_id, owner.host, owner.pid, CP_CLAIM_LOST, NAN,
                                 "its process is gone", &ended, error);
        *released += ended;
    }
    if (status == CP_OK)
        status = cp_store_commit(store, error);
    if (status != CP_OK)
        cp_store_rollback(store);
    return status;
}
