/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/result_rows.h"

#include "core/array.h"
#include "crash/validity.h"
#include "pulse/pulse_codec.h"
#include "store/counterfactual_rows.h"
#include "store/crash_binding.h"
#include "store/participant_binding.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const ROLE[2] = {"a", "b"};

// ---- collecting ----------------------------------------------------------------------------

cp_crash_row *cp_result_rows_add_crash(cp_result_rows *rows)
{
    return cp_array_add(rows->crash, rows->crash_count);
}

cp_contact_row *cp_result_rows_add_contact(cp_result_rows *rows)
{
    return cp_array_add(rows->contact, rows->contact_count);
}

cp_sumo_collision_row *cp_result_rows_add_sumo_collision(cp_result_rows *rows)
{
    return cp_array_add(rows->sumo_collision, rows->sumo_collision_count);
}

void cp_result_rows_destroy(cp_result_rows *rows)
{
    for (size_t k = 0; k < rows->crash_count; k++)
        cp_crash_row_destroy(&rows->crash[k]);
    if (rows->counterfactual != NULL)
        cp_counterfactual_rows_destroy(rows->counterfactual);
    free(rows->counterfactual);
    for (size_t k = 0; k < rows->contact_count; k++) {
        free(rows->contact[k].vehicle[0]);
        free(rows->contact[k].vehicle[1]);
    }
    for (size_t k = 0; k < rows->sumo_collision_count; k++) {
        free(rows->sumo_collision[k].collider);
        free(rows->sumo_collision[k].victim);
        free(rows->sumo_collision[k].type);
    }
    free(rows->crash);
    free(rows->contact);
    free(rows->sumo_collision);
    free(rows->sumo_version);
    free(rows->sumo_command_line);
    free(rows->counters);
    free(rows->crash_options);
    *rows = (cp_result_rows){0};
}

// ---- writing -------------------------------------------------------------------------------

static const char *crash_type(const cp_crash_row *crash)
{
    return cp_crash_type_text(crash->vehicle[0].side, crash->vehicle[1].side);
}

static cp_status write_crash(cp_statement *s, const cp_result_rows *rows, size_t number,
                             cp_error *error)
{
    const cp_crash_row *crash = &rows->crash[number];
    char validity[CP_VALIDITY_TEXT_SIZE];
    cp_bind_integer(s, 1, rows->replication_id * CP_CRASHES_MAX + (int64_t)number);
    cp_bind_integer(s, 2, rows->replication_id);
    cp_bind_integer(s, 3, (int64_t)number);
    cp_bind_real(s, 4, crash->time_s);
    cp_bind_real(s, 5, crash->contact_m.x);
    cp_bind_real(s, 6, crash->contact_m.y);
    cp_bind_text(s, 7, crash_type(crash));
    cp_bind_real(s, 8, crash->description.closing_speed_m_s);
    cp_bind_real(s, 9, crash->description.lateral_offset_m);
    cp_bind_real(s, 10, crash->description.angle_rad);
    cp_bind_real(s, 11, crash->description.overlap_1);
    cp_bind_text(s, 12,
                 cp_validity_text(crash->vehicle[0].outside | crash->vehicle[1].outside, validity));
    cp_bind_real(s, 13, crash->t_common_s);
    cp_bind_real(s, 14, crash->separation_s);
    cp_bind_real(s, 15, crash->shift_m);
    cp_bind_integer(s, 16, crash->is_secondary);
    if (crash->is_secondary && crash->follows != CP_FOLLOWS_NONE)
        cp_bind_integer(s, 17, rows->replication_id * CP_CRASHES_MAX + (int64_t)crash->follows);
    else
        cp_bind_real(s, 17, NAN);
    return cp_statement_run(s, error);
}

static cp_status write_vehicle(cp_statement *s, const cp_result_rows *rows, size_t number, int role,
                               cp_error *error)
{
    const cp_crash_row *crash = &rows->crash[number];
    char validity[CP_VALIDITY_TEXT_SIZE];
    cp_bind_integer(s, 1, rows->replication_id * CP_CRASHES_MAX + (int64_t)number);
    cp_bind_text(s, 2, ROLE[role]);
    cp_bind_integer(s, 3, rows->replication_id);
    cp_bind_text(s, 4, crash_type(crash));
    cp_bind_crash_vehicle(s, crash, role, validity);
    return cp_statement_run(s, error);
}

static cp_status write_pulse(cp_statement *s, const cp_result_rows *rows, size_t number, int role,
                             cp_error *error)
{
    const cp_crash_vehicle_row *vehicle = &rows->crash[number].vehicle[role];
    if (vehicle->pulse == NULL)
        return CP_OK;
    cp_bind_integer(s, 1, rows->replication_id * CP_CRASHES_MAX + (int64_t)number);
    cp_bind_text(s, 2, ROLE[role]);
    cp_bind_integer(s, 3, CP_PULSE_CODEC);
    cp_bind_real(s, 4, vehicle->sample_interval_s);
    cp_bind_integer(s, 5, (int64_t)vehicle->sample_count);
    cp_bind_blob(s, 6, vehicle->pulse, vehicle->pulse_size);
    return cp_statement_run(s, error);
}

static cp_status write_members(cp_statement *s, const cp_result_rows *rows, size_t number, int role,
                               cp_error *error)
{
    cp_bind_integer(s, 1, rows->replication_id * CP_CRASHES_MAX + (int64_t)number);
    cp_bind_text(s, 2, ROLE[role]);
    return cp_write_members(s, 2, &rows->crash[number].vehicle[role], error);
}

static cp_status write_history(cp_statement *s, const cp_result_rows *rows, size_t number,
                               cp_error *error)
{
    const cp_crash_row *crash = &rows->crash[number];
    int64_t place[2] = {0, 0};
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < crash->history_count; k++) {
        const cp_history_row *row = &crash->history[k];
        cp_bind_integer(s, 1, rows->replication_id * CP_CRASHES_MAX + (int64_t)number);
        cp_bind_text(s, 2, ROLE[row->role]);
        cp_bind_integer(s, 3, place[row->role]++);
        cp_bind_real(s, 4, row->time_s);
        cp_bind_real(s, 5, row->front_m.x);
        cp_bind_real(s, 6, row->front_m.y);
        cp_bind_real(s, 7, row->yaw_rad);
        cp_bind_real(s, 8, row->speed_m_s);
        cp_bind_real(s, 9, row->acceleration_m_s2);
        status = cp_statement_run(s, error);
    }
    return status;
}

static cp_status write_crashes(cp_store *store, const cp_result_rows *rows, cp_error *error)
{
    cp_statement crash = {0}, vehicle = {0}, member = {0}, pulse = {0}, history = {0};
    cp_participant_writer participants = {0};
    if (rows->crash_count > CP_CRASHES_MAX)
        return cp_fail(error, CP_STORE_FAILED, "replication %lld has more than %d crashes",
                       (long long)rows->replication_id, CP_CRASHES_MAX);
    cp_status status = cp_statement_prepare(
        store, "writing a crash",
        "INSERT INTO crash (id, replication_id, number, time_s, x_m, y_m, crash_type, "
        "closing_speed_m_s, lateral_offset_m, angle_rad, overlap_1, validity, t_common_s, "
        "separation_s, shift_m, is_secondary, follows_crash_id) VALUES (?1, ?2, ?3, ?4, ?5, ?6, "
        "?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17)",
        &crash, error);
    if (status == CP_OK)
        status = cp_statement_prepare(
            store, "writing a vehicle of a crash",
            "INSERT INTO crash_vehicle SELECT ?1, ?2, scenario_id, variant_id, ?4, ?5, ?6, ?7, ?8, "
            "?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18, ?19, ?20, ?21, ?22, ?23, ?24, ?25, "
            "?26, ?27, ?28, ?29, ?30, ?31, ?32, ?33, ?34, ?35, ?36, ?37, ?38, ?39, ?40, ?41, ?42, "
            "?43, ?44, ?45, ?46, ?47, ?48, ?49, ?50, ?51, ?52 FROM replication WHERE id = ?3",
            &vehicle, error);
    if (status == CP_OK)
        status = cp_statement_prepare(
            store, "writing an OLC of an ensemble",
            "INSERT INTO crash_vehicle_member VALUES (?1, ?2, ?3, ?4, ?5)", &member, error);
    if (status == CP_OK)
        status = cp_statement_prepare(store, "writing a pulse",
                                      "INSERT INTO pulse VALUES (?1, ?2, ?3, ?4, ?5, ?6)", &pulse,
                                      error);
    if (status == CP_OK)
        status = cp_statement_prepare(
            store, "writing the history of a crash",
            "INSERT INTO pre_crash_sample (crash_id, role, number, time_s, front_x_m, front_y_m, "
            "yaw_rad, speed_m_s, acceleration_m_s2) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)",
            &history, error);
    if (status == CP_OK)
        status = cp_participant_writer_prepare(&participants, store, false, error);
    for (size_t k = 0; status == CP_OK && k < rows->crash_count; k++) {
        status = write_crash(&crash, rows, k, error);
        for (int role = 0; status == CP_OK && role < 2; role++) {
            status = write_vehicle(&vehicle, rows, k, role, error);
            if (status == CP_OK)
                status = write_members(&member, rows, k, role, error);
            if (status == CP_OK)
                status = write_pulse(&pulse, rows, k, role, error);
        }
        if (status == CP_OK)
            status = write_history(&history, rows, k, error);
        if (status == CP_OK)
            status = cp_participant_writer_write(&participants,
                                                 rows->replication_id * CP_CRASHES_MAX + (int64_t)k,
                                                 NULL, &rows->crash[k].participants, error);
    }
    cp_participant_writer_finish(&participants);
    cp_statement_finish(&history);
    cp_statement_finish(&pulse);
    cp_statement_finish(&member);
    cp_statement_finish(&vehicle);
    cp_statement_finish(&crash);
    return status;
}

static cp_status write_contacts(cp_store *store, const cp_result_rows *rows, cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "writing a contact", "INSERT INTO contact VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
        &s, error);
    for (size_t k = 0; status == CP_OK && k < rows->contact_count; k++) {
        const cp_contact_row *contact = &rows->contact[k];
        cp_bind_integer(&s, 1, rows->replication_id);
        cp_bind_integer(&s, 2, (int64_t)k);
        cp_bind_real(&s, 3, contact->time_s);
        cp_bind_real(&s, 4, contact->contact_m.x);
        cp_bind_real(&s, 5, contact->contact_m.y);
        cp_bind_text(&s, 6, contact->verdict);
        cp_bind_text(&s, 7, contact->vehicle[0]);
        cp_bind_text(&s, 8, contact->vehicle[1]);
        status = cp_statement_run(&s, error);
    }
    cp_statement_finish(&s);
    return status;
}

static cp_status write_sumo_collisions(cp_store *store, const cp_result_rows *rows, cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "writing a collision of SUMO",
        "INSERT INTO sumo_collision (replication_id, number, time_s, collider, victim, sumo_type, "
        "found_as, gap_m) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
        &s, error);
    for (size_t k = 0; status == CP_OK && k < rows->sumo_collision_count; k++) {
        const cp_sumo_collision_row *collision = &rows->sumo_collision[k];
        cp_bind_integer(&s, 1, rows->replication_id);
        cp_bind_integer(&s, 2, (int64_t)k);
        cp_bind_real(&s, 3, collision->time_s);
        cp_bind_text(&s, 4, collision->collider);
        cp_bind_text(&s, 5, collision->victim);
        cp_bind_text(&s, 6, collision->type);
        cp_bind_text(&s, 7, collision->found_as);
        cp_bind_real(&s, 8, collision->gap_m);
        status = cp_statement_run(&s, error);
    }
    cp_statement_finish(&s);
    return status;
}

// The attempt must still be ours: whoever took us for dead may have started another.
static cp_status finish_attempt(cp_store *store, const cp_result_rows *rows, cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "ending a claim",
        "UPDATE attempt SET outcome = 'done', wall_time_s = ?3 WHERE replication_id = ?1 AND "
        "number = ?2 AND outcome = 'running'",
        &s, error);
    cp_bind_integer(&s, 1, rows->replication_id);
    cp_bind_integer(&s, 2, rows->attempt);
    cp_bind_real(&s, 3, rows->wall_time_s);
    if (status == CP_OK)
        status = cp_statement_run(&s, error);
    cp_statement_finish(&s);
    if (status == CP_OK && sqlite3_changes(cp_store_sqlite(store)) != 1)
        status = cp_fail(error, CP_RUN_FAILED, "%s: the claim on replication %lld was taken away",
                         cp_store_path(store), (long long)rows->replication_id);
    return status;
}

static cp_status finish_replication(cp_store *store, const cp_result_rows *rows, cp_error *error)
{
    cp_statement s;
    cp_status status = cp_statement_prepare(
        store, "finishing a replication",
        "UPDATE replication SET status = 'done', crashpulse_version = ?2, sumo_version = ?3, "
        "sumo_command_line = ?4, simulated_s = ?5, vehicle_km = ?6, vehicle_h = ?7, departed = ?8, "
        "counters = ?9, crash_options = ?10 WHERE id = ?1 AND status = 'running'",
        &s, error);
    cp_bind_integer(&s, 1, rows->replication_id);
    cp_bind_text(&s, 2, CRASHPULSE_VERSION);
    cp_bind_text(&s, 3, rows->sumo_version);
    cp_bind_text(&s, 4, rows->sumo_command_line);
    cp_bind_real(&s, 5, rows->simulated_s);
    cp_bind_real(&s, 6, rows->vehicle_km);
    cp_bind_real(&s, 7, rows->vehicle_h);
    cp_bind_integer(&s, 8, (int64_t)rows->departed);
    cp_bind_text(&s, 9, rows->counters);
    cp_bind_text(&s, 10, rows->crash_options);
    if (status == CP_OK)
        status = cp_statement_run(&s, error);
    cp_statement_finish(&s);
    return status;
}

cp_status cp_result_rows_commit(cp_store *store, const cp_result_rows *rows, cp_error *error)
{
    cp_status status = cp_store_begin(store, error);
    if (status != CP_OK)
        return status;
    status = finish_attempt(store, rows, error);
    if (status == CP_OK)
        status = write_crashes(store, rows, error);
    if (status == CP_OK)
        status = write_contacts(store, rows, error);
    if (status == CP_OK)
        status = write_sumo_collisions(store, rows, error);
    if (status == CP_OK && rows->counterfactual != NULL)
        status =
            cp_counterfactual_rows_write(store, rows->replication_id, rows->counterfactual, error);
    if (status == CP_OK)
        status = finish_replication(store, rows, error);
    if (status == CP_OK)
        status = cp_store_commit(store, error);
    if (status != CP_OK)
        cp_store_rollback(store);
    return status;
}
