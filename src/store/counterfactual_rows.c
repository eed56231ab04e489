/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/counterfactual_rows.h"

#include "core/array.h"
#include "core/hash.h"
#include "crash/validity.h"
#include "pulse/pulse_codec.h"
#include "store/crash_binding.h"
#include "store/participant_binding.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const OUTCOME_TEXT[] = {
#define CP_OUTCOME_TEXT(name, text) [name] = text,
    CP_OUTCOMES(CP_OUTCOME_TEXT)
#undef CP_OUTCOME_TEXT
};

static const char *const NULL_STATUS_TEXT[] = {
#define CP_NULL_STATUS_TEXT(name, text) [name] = text,
    CP_NULL_STATUSES(CP_NULL_STATUS_TEXT)
#undef CP_NULL_STATUS_TEXT
};

static const char *const ROLE[2] = {"a", "b"};

const char *cp_outcome_text(cp_outcome outcome)
{
    return OUTCOME_TEXT[outcome];
}

const char *cp_null_status_text(cp_null_status status)
{
    return NULL_STATUS_TEXT[status];
}

double cp_crash_row_olc_g(const cp_crash_row *crash)
{
    double largest_g = NAN;
    for (int role = 0; role < 2; role++) {
        const cp_crash_vehicle_row *vehicle = &crash->vehicle[role];
        if (vehicle->side != CP_SIDE_FRONT)
            continue;
        if (vehicle->severity.olc.status == CP_OLC_SIMULATION_FAILED)
            return NAN;
        bool has_value = vehicle->severity.olc.status == CP_OLC_VALUE;
        largest_g = fmax(largest_g, has_value ? vehicle->severity.olc.olc_g : 0.0);
    }
    return largest_g;
}

// ---- collecting ----------------------------------------------------------------------------

cp_null_treatment_row *cp_counterfactual_rows_add_null(cp_counterfactual_rows *rows)
{
    return cp_array_add(rows->null_treatment, rows->null_treatment_count);
}

cp_counterfactual_row *cp_counterfactual_rows_add(cp_counterfactual_rows *rows)
{
    return cp_array_add(rows->row, rows->row_count);
}

void cp_counterfactual_rows_destroy(cp_counterfactual_rows *rows)
{
    for (size_t k = 0; k < rows->null_treatment_count; k++)
        free(rows->null_treatment[k].sample);
    for (size_t k = 0; k < rows->row_count; k++) {
        cp_crash_row_destroy(&rows->row[k].treated);
        free(rows->row[k].sample);
    }
    free(rows->null_treatment);
    free(rows->row);
    *rows = (cp_counterfactual_rows){0};
}

// ---- writing -------------------------------------------------------------------------------

/* The statements of one write, and whose rows they write. */
typedef struct writer {
    int64_t replication_id;
    cp_statement null_treatment, row, vehicle, member, pulse, sample;
    cp_participant_writer participants;
} writer;

static int64_t crash_id(const writer *w, size_t crash)
{
    return w->replication_id * CP_CRASHES_MAX + (int64_t)crash;
}

static const char *text_or_null(const char *text)
{
    return text[0] != '\0' ? text : NULL;
}

static cp_status write_samples(writer *w, size_t crash, const char *variant,
                               const cp_sample_row *sample, size_t count, cp_error *error)
{
    cp_statement *s = &w->sample;
    int64_t number[2] = {0, 0};
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < count; k++) {
        cp_bind_integer(s, 1, crash_id(w, crash));
        cp_bind_integer(s, 2, cp_hash_row_id(variant));
        cp_bind_text(s, 3, ROLE[sample[k].role]);
        cp_bind_integer(s, 4, number[sample[k].role]++);
        cp_bind_real(s, 5, sample[k].time_s);
        cp_bind_real(s, 6, sample[k].front_m.x);
        cp_bind_real(s, 7, sample[k].front_m.y);
        cp_bind_real(s, 8, sample[k].yaw_rad);
        cp_bind_real(s, 9, sample[k].speed_m_s);
        cp_bind_real(s, 10, sample[k].acceleration_m_s2);
        cp_bind_real(s, 11, sample[k].ttc_s);
        cp_bind_real(s, 12, sample[k].brake_request_m_s2);
        status = cp_statement_run(s, error);
    }
    return status;
}

static cp_status write_null_treatment(writer *w, const cp_null_treatment_row *row, cp_error *error)
{
    cp_statement *s = &w->null_treatment;
    cp_bind_integer(s, 1, crash_id(w, row->crash));
    cp_bind_text(s, 2, cp_null_status_text(row->status));
    cp_bind_real(s, 3, row->lead_s);
    cp_bind_real(s, 4, row->checkpoint_s);
    cp_bind_text(s, 5, text_or_null(row->detail));
    cp_status status = cp_statement_run(s, error);
    return status == CP_OK
               ? write_samples(w, row->crash, row->variant, row->sample, row->sample_count, error)
               : status;
}

// Parameters 8 to 19: the treated crash, or NULLs.
static void bind_treated(cp_statement *s, const cp_counterfactual_row *row,
                         char validity[CP_VALIDITY_TEXT_SIZE])
{
    const cp_crash_row *crash = &row->treated;
    bool has = row->has_crash;
    cp_bind_real(s, 8, has ? crash->time_s : NAN);
    cp_bind_real(s, 9, has ? crash->contact_m.x : NAN);
    cp_bind_real(s, 10, has ? crash->contact_m.y : NAN);
    cp_bind_text(s, 11,
                 has ? cp_crash_type_text(crash->vehicle[0].side, crash->vehicle[1].side) : NULL);
    cp_bind_real(s, 12, has ? crash->description.closing_speed_m_s : NAN);
    cp_bind_real(s, 13, has ? crash->description.lateral_offset_m : NAN);
    cp_bind_real(s, 14, has ? crash->description.angle_rad : NAN);
    cp_bind_real(s, 15, has ? crash->description.overlap_1 : NAN);
    cp_bind_text(
        s, 16,
        has ? cp_validity_text(crash->vehicle[0].outside | crash->vehicle[1].outside, validity)
            : NULL);
    cp_bind_real(s, 17, has ? crash->t_common_s : NAN);
    cp_bind_real(s, 18, has ? crash->separation_s : NAN);
    cp_bind_real(s, 19, has ? crash->shift_m : NAN);
}

static cp_status write_vehicle(writer *w, const cp_counterfactual_row *row, int role,
                               cp_error *error)
{
    const cp_crash_vehicle_row *vehicle = &row->treated.vehicle[role];
    char validity[CP_VALIDITY_TEXT_SIZE];
    cp_statement *s = &w->vehicle;
    cp_bind_integer(s, 1, crash_id(w, row->crash));
    cp_bind_text(s, 2, ROLE[role]);
    cp_bind_integer(s, 3, cp_hash_row_id(row->variant));
    cp_bind_crash_vehicle(s, &row->treated, role, validity);
    cp_status status = cp_statement_run(s, error);
    cp_bind_integer(&w->member, 1, crash_id(w, row->crash));
    cp_bind_integer(&w->member, 2, cp_hash_row_id(row->variant));
    cp_bind_text(&w->member, 3, ROLE[role]);
    if (status == CP_OK)
        status = cp_write_members(&w->member, 3, vehicle, error);
    if (status != CP_OK || vehicle->pulse == NULL)
        return status;

    s = &w->pulse;
    cp_bind_integer(s, 1, crash_id(w, row->crash));
    cp_bind_integer(s, 2, cp_hash_row_id(row->variant));
    cp_bind_text(s, 3, ROLE[role]);
    cp_bind_integer(s, 4, CP_PULSE_CODEC);
    cp_bind_real(s, 5, vehicle->sample_interval_s);
    cp_bind_integer(s, 6, (int64_t)vehicle->sample_count);
    cp_bind_blob(s, 7, vehicle->pulse, vehicle->pulse_size);
    return cp_statement_run(s, error);
}

static cp_status write_row(writer *w, const cp_counterfactual_row *row, cp_error *error)
{
    cp_statement *s = &w->row;
    char validity[CP_VALIDITY_TEXT_SIZE];
    bool invalid = row->outcome == CP_OUTCOME_INVALID;
    cp_bind_integer(s, 1, crash_id(w, row->crash));
    cp_bind_integer(s, 2, cp_hash_row_id(row->variant));
    cp_bind_text(s, 3, cp_outcome_text(row->outcome));
    cp_bind_text(s, 4, cp_outcome_text(row->outcome_olc));
    cp_bind_text(s, 5, invalid ? cp_null_status_text(row->reason) : NULL);
    cp_bind_text(s, 6, text_or_null(row->detail));
    if (invalid) {
        cp_bind_text(s, 7, NULL);
        cp_bind_text(s, 20, NULL);
    } else {
        cp_bind_integer(s, 7, (int64_t)row->new_crashes);
        cp_bind_integer(s, 20, (int64_t)row->vanished_crashes);
    }
    bind_treated(s, row, validity);
    cp_status status = cp_statement_run(s, error);
    for (int role = 0; status == CP_OK && row->has_crash && role < 2; role++)
        status = write_vehicle(w, row, role, error);
    int64_t variant_id = cp_hash_row_id(row->variant);
    if (status == CP_OK && row->has_crash)
        status = cp_participant_writer_write(&w->participants, crash_id(w, row->crash), &variant_id,
                                             &row->treated.participants, error);
    return status == CP_OK
               ? write_samples(w, row->crash, row->variant, row->sample, row->sample_count, error)
               : status;
}

static cp_status prepare(writer *w, cp_store *store, cp_error *error)
{
    const char *what = "writing a counterfactual";
    cp_status status = cp_statement_prepare(
        store, "writing a null treatment",
        "INSERT INTO null_treatment (crash_id, status, lead_s, checkpoint_s, detail) "
        "VALUES (?1, ?2, ?3, ?4, ?5)",
        &w->null_treatment, error);
    if (status == CP_OK)
        status = cp_statement_prepare(
            store, what,
            "INSERT INTO counterfactual (crash_id, variant_id, outcome, outcome_olc, reason, "
            "detail, new_crashes, time_s, x_m, y_m, crash_type, closing_speed_m_s, "
            "lateral_offset_m, angle_rad, overlap_1, validity, t_common_s, separation_s, shift_m, "
            "vanished_crashes) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, "
            "?14, "
            "?15, ?16, ?17, ?18, ?19, ?20)",
            &w->row, error);
    if (status == CP_OK)
        status = cp_statement_prepare(
            store, what,
            "INSERT INTO counterfactual_vehicle VALUES (?1, ?3, ?2, ?5, ?6, ?7, ?8, ?9, ?10, ?11, "
            "?12, ?13, ?14, ?15, ?16, ?17, ?18, ?19, ?20, ?21, ?22, ?23, ?24, ?25, ?26, ?27, ?28, "
            "?29, ?30, ?31, ?32, ?33, ?34, ?35, ?36, ?37, ?38, ?39, ?40, ?41, ?42, ?43, ?44, ?45, "
            "?46, ?47, ?48, ?49, ?50, ?51, ?52)",
            &w->vehicle, error);
    if (status == CP_OK)
        status = cp_statement_prepare(
            store, what,
            "INSERT INTO counterfactual_vehicle_member VALUES (?1, ?2, ?3, ?4, ?5, ?6)", &w->member,
            error);
    if (status == CP_OK)
        status = cp_statement_prepare(
            store, what, "INSERT INTO counterfactual_pulse VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)",
            &w->pulse, error);
    if (status == CP_OK)
        status = cp_statement_prepare(store, "writing a time series",
                                      "INSERT INTO counterfactual_sample VALUES (?1, ?2, ?3, ?4, "
                                      "?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12)",
                                      &w->sample, error);
    if (status == CP_OK)
        status = cp_participant_writer_prepare(&w->participants, store, true, error);
    return status;
}

cp_status cp_counterfactual_rows_write(cp_store *store, int64_t replication_id,
                                       const cp_counterfactual_rows *rows, cp_error *error)
{
    writer w = {.replication_id = replication_id};
    cp_status status = prepare(&w, store, error);
    for (size_t k = 0; status == CP_OK && k < rows->null_treatment_count; k++)
        status = write_null_treatment(&w, &rows->null_treatment[k], error);
    for (size_t k = 0; status == CP_OK && k < rows->row_count; k++)
        status = write_row(&w, &rows->row[k], error);
    cp_participant_writer_finish(&w.participants);
    cp_statement_finish(&w.sample);
    cp_statement_finish(&w.pulse);
    cp_statement_finish(&w.member);
    cp_statement_finish(&w.vehicle);
    cp_statement_finish(&w.row);
    cp_statement_finish(&w.null_treatment);
    return status;
}
