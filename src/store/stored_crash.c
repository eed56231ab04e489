/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/stored_crash.h"

#include "crash/drawn_car.h"
#include "pulse/pulse_codec.h"
#include "store/pulse_columns.h"
#include "store/result_rows.h"
#include "store/store_sqlite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const ROLE[2] = {"a", "b"};

char *cp_crash_options_json(const cp_crash_options *options)
{
    char text[256];
    snprintf(text, sizeof text,
             "{\"time_step_s\":%.17g,\"duration_s\":%.17g,\"longest_duration_s\":%.17g,"
             "\"coast_after_s\":%.17g}",
             options->time_step_s, options->duration_s, options->longest_duration_s,
             options->coast_after_s);
    return strdup(text);
}

// ---- reading -------------------------------------------------------------------------------

static double real_or_nan(const cp_statement *s, int column)
{
    return sqlite3_column_type(s->handle, column) == SQLITE_NULL
               ? NAN
               : sqlite3_column_double(s->handle, column);
}

static const char *text_of(const cp_statement *s, int column)
{
    const unsigned char *text = sqlite3_column_text(s->handle, column);
    return text != NULL ? (const char *)text : "";
}

// Rows of schema versions 1 and 2 have no options: what the program used then are the defaults
// below.
#define CRASH_COLUMNS                                                                              \
    "SELECT c.time_s, c.closing_speed_m_s, c.lateral_offset_m, c.angle_rad, c.overlap_1, "         \
    "coalesce(r.crash_options ->> 'time_step_s', 0.0005), "                                        \
    "coalesce(r.crash_options ->> 'duration_s', 0.2), "                                            \
    "coalesce(r.crash_options ->> 'longest_duration_s', 0.4), "                                    \
    "coalesce(r.crash_options ->> 'coast_after_s', 0.01), r.crashpulse_version, "
#define VEHICLE_COLUMNS                                                                            \
    "SELECT v.cog_x_m, v.cog_y_m, v.yaw_rad, v.velocity_x_m_s, v.velocity_y_m_s, "                 \
    "v.yaw_rate_rad_s, v.speed_m_s, v.velocity_angle_rad, v.contact_side, v.sumo_id, "             \
    "v.vehicle_model, m.yaml, v.length_m, v.width_m, coalesce(r.crash_options ->> "                \
    "'covers_outline', 0), v.sumo_type, instr(',' || v.validity || ',', ',no_model,') > 0, "       \
    "v.drawn "
#define OF_REPLICATION                                                                             \
    "JOIN crash AS c ON c.id = v.crash_id JOIN replication AS r ON r.id = c.replication_id "

// Queries for crash ?1 and vehicle ?2: of the study, and under treatment ?3.
static const char *const READ_CRASH[2] = {
    CRASH_COLUMNS
    "c.is_secondary FROM crash AS c JOIN replication AS r ON r.id = c.replication_id WHERE c.id = "
    "?1 AND ?3 IS NULL",
    CRASH_COLUMNS "instr(',' || c.validity || ',', ',damaged,') > 0 FROM counterfactual AS c JOIN "
                  "crash AS b ON b.id = c.crash_id JOIN replication "
                  "AS r ON r.id = b.replication_id WHERE c.crash_id = ?1 AND c.variant_id = ?3 AND "
                  "c.time_s IS NOT NULL"};
static const char *const READ_VEHICLE[2] = {
    VEHICLE_COLUMNS
    "FROM crash_vehicle AS v JOIN vehicle_model AS m ON m.name = v.vehicle_model " OF_REPLICATION
    "WHERE v.crash_id = ?1 AND v.role = ?2 AND ?3 IS NULL",
    VEHICLE_COLUMNS "FROM counterfactual_vehicle AS v JOIN vehicle_model AS m ON m.name = "
                    "v.vehicle_model " OF_REPLICATION
                    "WHERE v.crash_id = ?1 AND v.role = ?2 AND v.variant_id = ?3"};
static const char *const READ_PULSE[2] = {
    "SELECT " CP_PULSE_COLUMNS " FROM pulse WHERE crash_id = ?1 AND role = ?2 AND ?3 IS NULL",
    "SELECT " CP_PULSE_COLUMNS
    " FROM counterfactual_pulse WHERE crash_id = ?1 AND role = ?2 AND variant_id = ?3"};

// Prepare one of them for the crash and run it; row tells whether there is an answer.
static cp_status begin_reading(cp_store *store, const char *what, const char *const sql[2],
                               const cp_stored_crash *crash, int role, cp_statement *s, int *row,
                               cp_error *error)
{
    *row = 0;
    cp_status status = cp_statement_prepare(store, what, sql[crash->is_treated], s, error);
    if (status != CP_OK)
        return status;
    cp_bind_integer(s, 1, crash->id);
    cp_bind_text(s, 2, ROLE[role]);
    if (crash->is_treated)
        cp_bind_integer(s, 3, crash->variant_id);
    return cp_statement_row(s, row, error);
}

static cp_status find_treatment(cp_store *store, const char *treatment, cp_stored_crash *crash,
                                cp_error *error)
{
    cp_statement s;
    int row = 0;
    if (treatment == NULL)
        return CP_OK;
    cp_status status = cp_statement_prepare(store, "reading a treatment",
                                            "SELECT id FROM variant WHERE name = ?1", &s, error);
    cp_bind_text(&s, 1, treatment);
    if (status == CP_OK)
        status = cp_statement_row(&s, &row, error);
    if (status == CP_OK && !row)
        status = cp_fail(error, CP_BAD_INPUT, "%s: has no variant '%s'", cp_store_path(store),
                         treatment);
    if (status == CP_OK)
        crash->variant_id = sqlite3_column_int64(s.handle, 0);
    crash->is_treated = true;
    snprintf(crash->treatment, sizeof crash->treatment, "%s", treatment);
    cp_statement_finish(&s);
    return status;
}

// A value of a row within what any crash of ours has; anything may stand in a file of others.
static cp_status check_value(cp_store *store, const cp_stored_crash *crash, const char *column,
                             double value, double smallest, double largest, cp_error *error)
{
    if (value >= smallest && value <= largest)
        return CP_OK;
    return cp_fail(error, CP_BAD_INPUT, "%s: crash %lld: %s must be between %g and %g, found %g",
                   cp_store_path(store), (long long)crash->id, column, smallest, largest, value);
}

static cp_status check_options(cp_store *store, const cp_stored_crash *crash, cp_error *error)
{
    const cp_crash_options *o = &crash->options;
    cp_status status = check_value(store, crash, "time_step_s", o->time_step_s, 1e-6, 0.002, error);
    if (status == CP_OK)
        status = check_value(store, crash, "duration_s", o->duration_s, o->time_step_s, 2.0, error);
    if (status == CP_OK)
        status =
            check_value(store, crash, "longest_duration_s", o->longest_duration_s, 0.0, 2.0, error);
    if (status == CP_OK)
        status = check_value(store, crash, "coast_after_s", o->coast_after_s, o->time_step_s, 2.0,
                             error);
    return status;
}

static cp_status check_motion(cp_store *store, const cp_stored_crash *crash, int role,
                              cp_error *error)
{
    const cp_body_state *state = &crash->configuration.vehicle[role];
    const struct {
        const char *column;
        double value, largest;
    } VALUE[] = {{"cog_x_m", state->cog_m.x, 1e7},
                 {"cog_y_m", state->cog_m.y, 1e7},
                 {"yaw_rad", state->yaw_rad, 1e3},
                 {"velocity_x_m_s", state->velocity_m_s.x, 200.0},
                 {"velocity_y_m_s", state->velocity_m_s.y, 200.0},
                 {"yaw_rate_rad_s", state->yaw_rate_rad_s, 100.0}};
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < sizeof VALUE / sizeof *VALUE; k++)
        status = check_value(store, crash, VALUE[k].column, VALUE[k].value, -VALUE[k].largest,
                             VALUE[k].largest, error);
    return status;
}

// The outline that SUMO's vehicle had, in place of the model's own.
static cp_status cover(cp_store *store, cp_stored_crash *crash, int role, double length_m,
                       double width_m, cp_error *error)
{
    cp_status status = check_value(store, crash, "length_m", length_m, 0.1, 50.0, error);
    if (status == CP_OK)
        status = check_value(store, crash, "width_m", width_m, 0.1, 10.0, error);
    if (status == CP_OK)
        crash->model[role] = cp_vehicle_model_cover(&crash->model[role], length_m, width_m);
    return status;
}

// The car of a vehicle class that was drawn.
static cp_status take_drawn(cp_store *store, cp_stored_crash *crash, int role, const char *text,
                            cp_error *error)
{
    const cp_vehicle_model of_class = crash->model[role];
    cp_status status = cp_drawn_car_read(&of_class, text, &crash->model[role], error);
    return status == CP_OK
               ? CP_OK
               : cp_error_prefix(error, "%s: crash %lld: vehicle %s: ", cp_store_path(store),
                                 (long long)crash->id, ROLE[role]);
}

static cp_status read_crash(cp_store *store, const char *treatment, cp_stored_crash *crash,
                            cp_error *error)
{
    cp_statement s;
    int row = 0;
    cp_status status =
        begin_reading(store, "reading a crash", READ_CRASH, crash, 0, &s, &row, error);
    if (status == CP_OK && !row)
        status = treatment == NULL
                     ? cp_fail(error, CP_BAD_INPUT, "%s: has no crash %lld", cp_store_path(store),
                               (long long)crash->id)
                     : cp_fail(error, CP_BAD_INPUT,
                               "%s: crash %lld became no crash under %s (its outcome: table "
                               "counterfactual)",
                               cp_store_path(store), (long long)crash->id, treatment);
    if (status == CP_OK) {
        crash->time_s = sqlite3_column_double(s.handle, 0);
        crash->description.closing_speed_m_s = sqlite3_column_double(s.handle, 1);
        crash->description.lateral_offset_m = sqlite3_column_double(s.handle, 2);
        crash->description.angle_rad = sqlite3_column_double(s.handle, 3);
        crash->description.overlap_1 = real_or_nan(&s, 4);
        crash->options = cp_crash_options_default();
        crash->options.time_step_s = sqlite3_column_double(s.handle, 5);
        crash->options.duration_s = sqlite3_column_double(s.handle, 6);
        crash->options.longest_duration_s = sqlite3_column_double(s.handle, 7);
        crash->options.coast_after_s = sqlite3_column_double(s.handle, 8);
        snprintf(crash->crashpulse_version, sizeof crash->crashpulse_version, "%s", text_of(&s, 9));
        crash->is_secondary = sqlite3_column_int(s.handle, 10) != 0;
    }
    cp_statement_finish(&s);
    return status == CP_OK ? check_options(store, crash, error) : status;
}

static cp_status take_side(const char *text, cp_contact_side *side, cp_error *error)
{
    for (int k = CP_SIDE_FRONT; k <= CP_SIDE_REAR; k++) {
        *side = (cp_contact_side)k;
        if (strcmp(cp_contact_side_text(*side), text) == 0)
            return CP_OK;
    }
    return cp_fail(error, CP_BAD_INPUT, "contact_side '%s' is unknown", text);
}

static cp_status read_vehicle(cp_store *store, int role, cp_stored_crash *crash, cp_error *error)
{
    cp_statement s;
    int row = 0;
    cp_status status = begin_reading(store, "reading a vehicle of a crash", READ_VEHICLE, crash,
                                     role, &s, &row, error);
    if (status == CP_OK && !row)
        status = cp_fail(error, CP_BAD_INPUT, "%s: crash %lld has no vehicle %s",
                         cp_store_path(store), (long long)crash->id, ROLE[role]);
    if (status != CP_OK)
        goto done;
    crash->configuration.vehicle[role] = (cp_body_state){
        .cog_m = {sqlite3_column_double(s.handle, 0), sqlite3_column_double(s.handle, 1)},
        .yaw_rad = sqlite3_column_double(s.handle, 2),
        .velocity_m_s = {sqlite3_column_double(s.handle, 3), sqlite3_column_double(s.handle, 4)},
        .yaw_rate_rad_s = sqlite3_column_double(s.handle, 5)};
    crash->description.speed_m_s[role] = sqlite3_column_double(s.handle, 6);
    crash->description.velocity_angle_rad[role] = real_or_nan(&s, 7);
    snprintf(crash->sumo_id[role], sizeof crash->sumo_id[role], "%s", text_of(&s, 9));
    status = take_side(text_of(&s, 8), &crash->configuration.side[role], error);
    if (status == CP_OK && sqlite3_column_int(s.handle, 16))
        status = cp_fail(error, CP_BAD_INPUT,
                         "%s: crash %lld was not simulated: vehicle %s, of type %s, has no model",
                         cp_store_path(store), (long long)crash->id, ROLE[role], text_of(&s, 15));
    if (status == CP_OK) {
        char name[256];
        snprintf(name, sizeof name, "%.100s: vehicle_model %.64s", cp_store_path(store),
                 text_of(&s, 10));
        status = cp_vehicle_model_parse(name, text_of(&s, 11),
                                        (size_t)sqlite3_column_bytes(s.handle, 11),
                                        &crash->model[role], error);
    }
    if (status == CP_OK)
        status = take_drawn(store, crash, role, text_of(&s, 17), error);
    // As it was simulated; rows of earlier versions have the model's own outline.
    if (status == CP_OK && sqlite3_column_int(s.handle, 14))
        status = cover(store, crash, role, sqlite3_column_double(s.handle, 12),
                       sqlite3_column_double(s.handle, 13), error);
    if (status == CP_OK)
        status = check_motion(store, crash, role, error);
done:
    cp_statement_finish(&s);
    return status;
}

cp_status cp_stored_crash_read(cp_store *store, int64_t crash_id, const char *treatment,
                               cp_stored_crash *crash, cp_error *error)
{
    *crash = (cp_stored_crash){.id = crash_id};
    crash->configuration.barrier = cp_barrier_default();
    cp_status status = find_treatment(store, treatment, crash, error);
    if (status == CP_OK)
        status = read_crash(store, treatment, crash, error);
    for (int role = 0; status == CP_OK && role < 2; role++)
        status = read_vehicle(store, role, crash, error);
    return status;
}

// ---- comparing -----------------------------------------------------------------------------

// Other bytes: the same samples after all?
static cp_status compare_samples(const cp_statement *s, const cp_pulse *record, bool *same,
                                 cp_error *error)
{
    cp_pulse stored = {0};
    cp_status status = cp_pulse_of_columns(s, 0, &stored, error);
    *same = status == CP_OK && stored.sample_count == record->sample_count &&
            stored.sample_interval_s == record->sample_interval_s;
    for (int c = 0; *same && c < CP_CHANNEL_COUNT; c++)
        for (size_t k = 0; *same && k < stored.sample_count; k++)
            *same = stored.channel[c][k] ==
                    (double)llround(record->channel[c][k] / CP_PULSE_RESOLUTION[c]) *
                        CP_PULSE_RESOLUTION[c];
    cp_pulse_destroy(&stored);
    return status;
}

static cp_status compare_found(const cp_statement *s, const cp_pulse *raw, cp_stored_match *match,
                               cp_error *error)
{
    cp_pulse record = {0};
    void *bytes = NULL;
    size_t size = 0;
    bool same = false;
    cp_status status = cp_pulse_codec_record(raw, &record, error);
    if (status == CP_OK)
        status = cp_pulse_encode(&record, &bytes, &size, error);
    if (status != CP_OK)
        goto done;
    if (sqlite3_column_int(s->handle, 0) == CP_PULSE_CODEC &&
        size == (size_t)sqlite3_column_bytes(s->handle, 1) &&
        memcmp(bytes, sqlite3_column_blob(s->handle, 1), size) == 0) {
        *match = CP_STORED_SAME_BYTES;
        goto done;
    }
    status = compare_samples(s, &record, &same, error);
    *match = same ? CP_STORED_SAME_SAMPLES : CP_STORED_DIFFERENT;
done:
    free(bytes);
    cp_pulse_destroy(&record);
    return status;
}

static cp_status compare_pulse(cp_store *store, const cp_stored_crash *crash, int role,
                               const cp_pulse *raw, cp_stored_match *match, cp_error *error)
{
    cp_statement s;
    int row = 0;
    cp_status status =
        begin_reading(store, "reading a pulse", READ_PULSE, crash, role, &s, &row, error);
    *match = CP_STORED_NOTHING;
    if (status == CP_OK && row)
        status = compare_found(&s, raw, match, error);
    cp_statement_finish(&s);
    return status;
}

cp_status cp_stored_crash_compare(cp_store *store, const cp_stored_crash *crash,
                                  const cp_crash_result *result, cp_stored_match *match,
                                  cp_error *error)
{
    *match = CP_STORED_SAME_BYTES;
    cp_status status = CP_OK;
    for (int role = 0; status == CP_OK && role < 2; role++) {
        cp_stored_match one;
        status = compare_pulse(store, crash, role, &result->pulse[role], &one, error);
        if (status == CP_OK && one > *match)
            *match = one;
    }
    return status;
}
