/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/reference_pulse.h"

#include "core/file.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/units.h"
#include "exchange/ev5_pulse.h"
#include "exchange/pulse_csv.h"
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

// Velocity from the raw signal, then the signal itself through CFC60, from time 0 on.
static cp_status take_signal(const cp_ev5_test *test, const cp_pulse_source *source,
                             cp_ev5_channel *mean, double speed_m_s, cp_reference_pulse *pulse,
                             cp_error *error)
{
    size_t zero = (size_t)-mean->first_sample;
    cp_status status = allocate(pulse, mean->sample_count - zero, error);
    if (status != CP_OK)
        return status;
    pulse->interval_s = mean->interval_s;
    status = cp_ev5_velocity(test, source->sensor, source->sensor_count, mean, speed_m_s, false,
                             pulse->vx_m_s, error);
    if (status == CP_OK)
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

static cp_status load_test(const cp_pulse_source *source, cp_reference_pulse *pulse,
                           cp_error *error)
{
    cp_ev5_test test;
    cp_ev5_channel mean = {0};
    cp_status status = cp_ev5_load(source->path, &test, error);
    if (status != CP_OK)
        return status;
    double speed_m_s = isnan(source->speed_km_h) ? cp_ev5_speed_m_s(&test, source->sensor[0])
                                                 : cp_m_s_from_km_h(source->speed_km_h);
    double recorded_m_s = cp_ev5_speed_m_s(&test, source->sensor[0]);
    status = cp_ev5_mean_of_structure(&test, source->sensor, source->sensor_count, &mean, error);
    if (status == CP_OK)
        status = take_signal(&test, source, &mean, isnan(recorded_m_s) ? speed_m_s : recorded_m_s,
                             pulse, error);
    if (status == CP_OK)
        status = hash_folder(&test, source, pulse->hash, error);
    cp_ev5_describe(&test, source->sensor, source->sensor_count, pulse->source,
                    sizeof pulse->source);
    cp_ev5_channel_destroy(&mean);
    cp_ev5_destroy(&test);
    return status;
}

// ---- a pulse file ----------------------------------------------------------------------------

// Both the acceleration and the velocity are compared: neither is made from the other here.
static cp_status take_record(const cp_pulse_record *record, cp_reference_pulse *pulse,
                             cp_error *error)
{
    const cp_pulse *told = &record->pulse;
    cp_status status = allocate(pulse, told->sample_count, error);
    pulse->interval_s = told->sample_interval_s;
    pulse->lateral = record->known[CP_CHANNEL_AY];
    for (size_t k = 0; status == CP_OK && k < pulse->count; k++) {
        pulse->ax_g[k] = told->channel[CP_CHANNEL_AX][k] / CP_G0_M_S2;
        pulse->vx_m_s[k] = told->channel[CP_CHANNEL_VX][k];
        if (pulse->lateral) {
            pulse->ay_g[k] = told->channel[CP_CHANNEL_AY][k] / CP_G0_M_S2;
            pulse->vy_m_s[k] = told->channel[CP_CHANNEL_VY][k];
        }
    }
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
    cp_pulse_request request = cp_pulse_request_default(source->path);
    cp_pulse_record record = {0};
    cp_status status = cp_file_read_text(source->path, &content, &size, error);
    if (status != CP_OK)
        return status;
    cp_hash_bytes(content, size, pulse->hash);
    request.needs_both = true;
    status = cp_pulse_csv_parse(&request, content, &record, error);
    if (status == CP_OK)
        status = take_record(&record, pulse, error);
    snprintf(pulse->source, sizeof pulse->source, "%s", record.source);
    cp_pulse_record_destroy(&record);
    free(content);
    return status;
}

// ---- both ------------------------------------------------------------------------------------

// What the whole record shows.
static void find_marks(cp_reference_pulse *pulse)
{
    cp_olc olc = cp_olc_from_velocity(pulse->vx_m_s, pulse->count, pulse->interval_s);
    double end_s = (double)(pulse->count - 1) * pulse->interval_s;
    if (olc.status == CP_OLC_VALUE && !cp_olc_is_decided(&olc, end_s, NAN)) {
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
