/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/reference_pulse.h"

#include "core/csv_row.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/units.h"
#include "core/yaml_file.h"
#include "exchange/nhtsa_ev5.h"
#include "pulse/cfc_filter.h"
#include "pulse/olc.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// A record's speed and the one stated for it may differ by this share (noise of a sample).
static const double SPEED_TOLERANCE_1 = 0.1;

double cp_samples_at(const double *values, size_t count, double interval_s, double time_s)
{
    double place = time_s / interval_s;
    if (place >= (double)(count - 1))
        return values[count - 1];
    size_t k = place > 0.0 ? (size_t)place : 0;
    double share = fmax(0.0, place - (double)k);
    return values[k] + share * (values[k + 1] - values[k]);
}

// Room for count samples of the four channels.
static cp_status allocate(cp_reference_pulse *pulse, size_t count, cp_error *error)
{
    pulse->ax_g = calloc(count > 0 ? count : 1, 4 * sizeof *pulse->ax_g);
    if (pulse->ax_g == NULL)
        return cp_fail_memory(error, "reference pulse");
    pulse->ay_g = pulse->ax_g + count;
    pulse->vx_m_s = pulse->ay_g + count;
    pulse->vy_m_s = pulse->vx_m_s + count;
    pulse->count = count;
    return CP_OK;
}

// ---- a real test -----------------------------------------------------------------------------

static cp_status check_sensor(const cp_ev5_test *test, int sensor, cp_error *error)
{
    const cp_ev5_instrument *instrument = cp_ev5_find(test, sensor);
    if (instrument == NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s: has no curve number %d", test->path, sensor);
    if (strcmp(instrument->sensor, "AC") != 0 || instrument->axis[0] != 'X')
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: curve %d is no longitudinal accelerometer (sensor AC, axis X): "
                       "sensor %s, axis %s (%s)",
                       test->path, instrument->line, sensor, instrument->sensor, instrument->axis,
                       instrument->comment);
    if (strcmp(instrument->status, "AM") != 0)
        return cp_fail(
            error, CP_BAD_INPUT,
            "%s:%zu: the data status of curve %d must be AM (as measured), found %s (%s)",
            test->path, instrument->line, sensor, instrument->status, instrument->comment);
    return CP_OK;
}

// Mean of the sensors into mean, which takes over the first one's room.
static cp_status mean_of_sensors(const cp_ev5_test *test, const cp_pulse_source *source,
                                 cp_ev5_channel *mean, cp_error *error)
{
    double share = 1.0 / (double)source->sensor_count;
    for (size_t k = 0; k < source->sensor_count; k++) {
        cp_ev5_channel channel = {0};
        cp_status status = check_sensor(test, source->sensor[k], error);
        if (status == CP_OK)
            status = cp_ev5_channel_load(test, source->sensor[k], &channel, error);
        if (status != CP_OK)
            return status;
        if (k == 0) {
            *mean = channel;
            for (size_t i = 0; i < mean->sample_count; i++)
                mean->value[i] *= share;
            continue;
        }
        bool alike = channel.first_sample == mean->first_sample &&
                     channel.sample_count == mean->sample_count &&
                     fabs(channel.interval_s - mean->interval_s) < 1e-12;
        for (size_t i = 0; alike && i < mean->sample_count; i++)
            mean->value[i] += share * channel.value[i];
        cp_ev5_channel_destroy(&channel);
        if (!alike)
            return cp_fail(error, CP_BAD_INPUT, "%s: curves %d and %d are sampled differently",
                           test->path, source->sensor[0], source->sensor[k]);
    }
    if (mean->first_sample > 0 || mean->first_sample + (long)mean->sample_count < 2)
        return cp_fail(error, CP_BAD_INPUT, "%s: curve %d does not begin at or before time 0",
                       test->path, source->sensor[0]);
    return CP_OK;
}

// Velocity from the raw signal, then the signal itself through CFC60, from time 0 on.
static cp_status take_signal(const cp_ev5_channel *mean, double speed_m_s,
                             cp_reference_pulse *pulse, cp_error *error)
{
    size_t zero = (size_t)-mean->first_sample;
    cp_status status = allocate(pulse, mean->sample_count - zero, error);
    if (status != CP_OK)
        return status;
    pulse->interval_s = mean->interval_s;
    pulse->vx_m_s[0] = speed_m_s;
    for (size_t k = 1; k < pulse->count; k++)
        pulse->vx_m_s[k] =
            pulse->vx_m_s[k - 1] +
            0.5 * (mean->value[zero + k - 1] + mean->value[zero + k]) * mean->interval_s;
    status = cp_cfc_filter(mean->value, mean->sample_count, mean->interval_s, 60.0, error);
    for (size_t k = 0; status == CP_OK && k < pulse->count; k++)
        pulse->ax_g[k] = mean->value[zero + k] / CP_G0_M_S2;
    return status;
}

// Hash of the hashes of the EV5 file and the curves, in the order given.
static cp_status hash_folder(const cp_ev5_test *test, const cp_pulse_source *source,
                             char hash[CP_HASH_TEXT_SIZE], cp_error *error)
{
    char all[(CP_PULSE_SENSORS_MAX + 1) * CP_HASH_TEXT_SIZE], one[CP_HASH_TEXT_SIZE];
    cp_status status = cp_hash_file(test->path, one, error);
    snprintf(all, sizeof all, "%s", one);
    for (size_t k = 0; status == CP_OK && k < source->sensor_count; k++) {
        char *path = cp_ev5_curve_path(test, source->sensor[k]);
        status = path != NULL ? cp_hash_file(path, one, error) : cp_fail_memory(error, "hash");
        free(path);
        if (status == CP_OK)
            snprintf(all + strlen(all), sizeof all - strlen(all), "%s", one);
    }
    cp_hash_bytes(all, strlen(all), hash);
    return status;
}

static void name_sensors(const cp_ev5_test *test, const cp_pulse_source *source,
                         cp_reference_pulse *pulse)
{
    int used = snprintf(pulse->source, sizeof pulse->source, "%s.EV5, channel%s", test->name,
                        source->sensor_count > 1 ? "s" : "");
    for (size_t k = 0; k < source->sensor_count; k++)
        used += snprintf(pulse->source + used, sizeof pulse->source - (size_t)used, "%s%d",
                         k == 0                          ? " "
                         : k + 1 == source->sensor_count ? " and "
                                                         : ", ",
                         source->sensor[k]);
}

// Speed of the vehicle the first sensor sits on.
static double recorded_speed_m_s(const cp_ev5_test *test, int sensor)
{
    const cp_ev5_instrument *instrument = cp_ev5_find(test, sensor);
    for (size_t k = 0; k < test->vehicle_count; k++)
        if (instrument != NULL && test->vehicle[k].number == instrument->vehicle)
            return test->vehicle[k].speed_m_s;
    return test->closing_speed_m_s;
}

static cp_status load_test(const cp_pulse_source *source, cp_reference_pulse *pulse,
                           cp_error *error)
{
    cp_ev5_test test;
    cp_ev5_channel mean = {0};
    cp_status status = cp_ev5_load(source->path, &test, error);
    if (status != CP_OK)
        return status;
    double speed_m_s = recorded_speed_m_s(&test, source->sensor[0]);
    status = mean_of_sensors(&test, source, &mean, error);
    if (status == CP_OK)
        status = take_signal(&mean, speed_m_s, pulse, error);
    if (status == CP_OK)
        status = hash_folder(&test, source, pulse->hash, error);
    name_sensors(&test, source, pulse);
    cp_ev5_channel_destroy(&mean);
    cp_ev5_destroy(&test);
    return status;
}

// ---- a pulse file ----------------------------------------------------------------------------

enum { COLUMN_TIME, COLUMN_AX, COLUMN_VX, COLUMN_AY, COLUMN_VY, COLUMN_COUNT };
enum { COLUMNS_NEEDED = COLUMN_AY };

static const char *const COLUMN_NAME[COLUMN_COUNT] = {"time_s", "ax_m_s2", "vx_m_s", "ay_m_s2",
                                                      "vy_m_s"};

// Places of the columns in the file's rows; CP_CSV_FIELDS_MAX: not there.
typedef struct columns {
    size_t count;
    size_t place[COLUMN_COUNT];
    size_t vehicle;
} columns;

static cp_status find_columns(const char *path, char *header, columns *found, cp_error *error)
{
    char *fields[CP_CSV_FIELDS_MAX];
    found->count = cp_csv_split(header, fields, CP_CSV_FIELDS_MAX);
    cp_status status = cp_csv_check_fields(path, 1, found->count, found->count, error);
    if (status != CP_OK)
        return status;
    found->vehicle = CP_CSV_FIELDS_MAX;
    for (int c = 0; c < COLUMN_COUNT; c++)
        found->place[c] = CP_CSV_FIELDS_MAX;
    for (size_t k = 0; k < found->count; k++) {
        for (size_t other = 0; other < k; other++)
            if (strcmp(fields[k], fields[other]) == 0)
                return cp_fail(error, CP_BAD_INPUT, "%s:1: column %s is given twice", path,
                               fields[k]);
        if (strcmp(fields[k], "vehicle") == 0)
            found->vehicle = k;
        for (int c = 0; c < COLUMN_COUNT; c++)
            if (strcmp(fields[k], COLUMN_NAME[c]) == 0)
                found->place[c] = k;
    }
    for (int c = 0; c < COLUMNS_NEEDED; c++)
        if (found->place[c] == CP_CSV_FIELDS_MAX)
            return cp_fail(error, CP_BAD_INPUT, "%s:1: column %s is missing", path, COLUMN_NAME[c]);
    return CP_OK;
}

// One row into value; *skip when it is another vehicle's.
static cp_status read_row(const char *path, size_t line_number, char *line, const columns *found,
                          double value[COLUMN_COUNT], bool *skip, cp_error *error)
{
    char *fields[CP_CSV_FIELDS_MAX];
    size_t count = cp_csv_split(line, fields, CP_CSV_FIELDS_MAX);
    cp_status status = cp_csv_check_fields(path, line_number, count, found->count, error);
    if (status != CP_OK)
        return status;
    *skip = found->vehicle < count && strcmp(fields[found->vehicle], "a") != 0;
    for (int c = 0; c < COLUMN_COUNT && !*skip; c++) {
        value[c] = 0.0;
        if (found->place[c] == CP_CSV_FIELDS_MAX)
            continue;
        const char *text = fields[found->place[c]];
        if (!cp_parse_number(text, &value[c]))
            return cp_fail(error, CP_BAD_INPUT, "%s:%zu: %s must be a number, found '%s'", path,
                           line_number, COLUMN_NAME[c], text);
    }
    return CP_OK;
}

// Times must go on in even steps from 0; the second one tells the step.
static cp_status check_time(const char *path, size_t line_number, size_t k, double time_s,
                            cp_reference_pulse *pulse, cp_error *error)
{
    if (k == 1)
        pulse->interval_s = time_s;
    if (k == 1 && !(time_s > 0.0 && time_s <= 0.01))
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: time_s must rise in even steps of at most 0.01 s, found %g", path,
                       line_number, time_s);
    double expected_s = (double)k * pulse->interval_s;
    if (fabs(time_s - expected_s) > 0.01 * pulse->interval_s + 1e-9)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: time_s must be %g, in even steps, found %g",
                       path, line_number, expected_s, time_s);
    return CP_OK;
}

static cp_status read_rows(const char *path, char *content, cp_reference_pulse *pulse,
                           cp_error *error)
{
    size_t lines = 1, number = 0, k = 0;
    for (const char *c = content; *c != '\0'; c++)
        lines += *c == '\n';
    cp_status status = allocate(pulse, lines, error);
    columns found = {0};
    for (char *rest = content; status == CP_OK && rest != NULL;) {
        char *line = cp_csv_next_line(&rest);
        bool skip = false;
        double value[COLUMN_COUNT];
        if (++number == 1) {
            status = find_columns(path, line, &found, error);
            continue;
        }
        if (line[strspn(line, " \t")] == '\0')
            continue;
        status = read_row(path, number, line, &found, value, &skip, error);
        if (status != CP_OK || skip)
            continue;
        status = check_time(path, number, k, value[COLUMN_TIME], pulse, error);
        pulse->ax_g[k] = value[COLUMN_AX] / CP_G0_M_S2;
        pulse->ay_g[k] = value[COLUMN_AY] / CP_G0_M_S2;
        pulse->vx_m_s[k] = value[COLUMN_VX];
        pulse->vy_m_s[k] = value[COLUMN_VY];
        k++;
    }
    if (status == CP_OK && k < 2)
        status = cp_fail(error, CP_BAD_INPUT, "%s: fewer than two samples", path);
    pulse->count = k;
    pulse->lateral =
        found.place[COLUMN_AY] != CP_CSV_FIELDS_MAX && found.place[COLUMN_VY] != CP_CSV_FIELDS_MAX;
    return status;
}

static cp_status load_file(const cp_pulse_source *source, cp_reference_pulse *pulse,
                           cp_error *error)
{
    char *content = NULL;
    size_t size = 0;
    struct stat kind;
    if (stat(source->path, &kind) == 0 && S_ISDIR(kind.st_mode))
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: is a folder; the pulse of a test in it needs the numbers of its "
                       "channels",
                       source->path);
    cp_status status = cp_file_read_text(source->path, &content, &size, error);
    if (status != CP_OK)
        return status;
    cp_hash_bytes(content, size, pulse->hash);
    status = read_rows(source->path, content, pulse, error);
    free(content);
    const char *slash = strrchr(source->path, '/');
    snprintf(pulse->source, sizeof pulse->source, "%s", slash != NULL ? slash + 1 : source->path);
    return status;
}

// ---- both ------------------------------------------------------------------------------------

// What the whole record shows.
static void find_marks(cp_reference_pulse *pulse)
{
    cp_olc olc = cp_olc_from_velocity(pulse->vx_m_s, pulse->count, pulse->interval_s);
    double end_s = (double)(pulse->count - 1) * pulse->interval_s;
    if (olc.status == CP_OLC_VALUE && olc.t2_s > end_s) {
        cp_log_warning(
            "%s: ends at %.1f ms, before its OLC is decided (%.1f ms at its last speed): "
            "none is taken from it",
            pulse->source, 1e3 * end_s, 1e3 * olc.t2_s);
        olc.olc_g = NAN;
    }
    pulse->marks = (cp_pulse_marks){.olc_g = olc.olc_g, .t_v0_s = NAN};
    double way_m = 0.0;
    for (size_t k = 0; k < pulse->count; k++) {
        pulse->marks.peak_g = fmax(pulse->marks.peak_g, -pulse->ax_g[k]);
        if (k == 0)
            continue;
        double before_m_s = pulse->vx_m_s[k - 1], now_m_s = pulse->vx_m_s[k];
        way_m += 0.5 * (before_m_s + now_m_s) * pulse->interval_s;
        pulse->marks.crush_m = fmax(pulse->marks.crush_m, way_m);
        if (isnan(pulse->marks.t_v0_s) && now_m_s <= 0.0)
            pulse->marks.t_v0_s =
                ((double)(k - 1) + before_m_s / (before_m_s - now_m_s)) * pulse->interval_s;
    }
}

// Condition and stretch to compare; the record's own speed where none is stated.
static cp_status set_condition(const cp_pulse_source *source, cp_reference_pulse *pulse,
                               cp_error *error)
{
    double recorded_km_h = cp_km_h_from_m_s(pulse->vx_m_s[0]);
    double speed_km_h = isnan(source->speed_km_h) ? recorded_km_h : source->speed_km_h;
    if (!(recorded_km_h > 0.0) ||
        fabs(speed_km_h - recorded_km_h) > SPEED_TOLERANCE_1 * recorded_km_h)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: the record begins at %.4g km/h, which does not go with a speed of "
                       "%.4g km/h",
                       source->path, recorded_km_h, speed_km_h);
    double end_s = (double)(pulse->count - 1) * pulse->interval_s;
    pulse->until_s = isnan(source->until_s) ? end_s : source->until_s;
    if (!(pulse->until_s >= 0.01 && pulse->until_s <= end_s + 1e-9))
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: until must lie between 0.01 s and the end of the record at %g s, "
                       "found %g",
                       source->path, end_s, pulse->until_s);
    pulse->weight_1 = source->weight_1;
    pulse->condition = (cp_reference_case){
        .speed_km_h = speed_km_h,
        .offset_mm = source->offset_mm,
        .angle_deg = source->angle_deg,
        .olc_g = isnan(pulse->marks.olc_g) ? 0.0 : pulse->marks.olc_g,
    };
    pulse->count = (size_t)floor(pulse->until_s / pulse->interval_s + 1e-6) + 1;
    return CP_OK;
}

cp_status cp_reference_pulse_load(const cp_pulse_source *source, cp_reference_pulse *pulse,
                                  cp_error *error)
{
    *pulse = (cp_reference_pulse){0};
    cp_status status = source->sensor_count > 0 ? load_test(source, pulse, error)
                                                : load_file(source, pulse, error);
    if (status == CP_OK) {
        find_marks(pulse);
        status = set_condition(source, pulse, error);
    }
    if (status != CP_OK)
        cp_reference_pulse_destroy(pulse);
    return status;
}

void cp_reference_pulse_destroy(cp_reference_pulse *pulse)
{
    free(pulse->ax_g);
    *pulse = (cp_reference_pulse){0};
}
