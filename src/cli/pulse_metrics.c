/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/pulse_metrics.h"

#include "core/log.h"
#include "core/safe_text.h"
#include "core/units.h"
#include "pulse/severity.h"

#include <math.h>
#include <string.h>

#define NUMBER_COUNT 19

// A figure: name in JSON and CSV, label and digits in the table.
typedef struct number {
    const char *name;
    const char *label;
    int digits;
    double value;
} number;

// What is told of a record.
typedef struct metrics {
    cp_severity severity;
    const char *olc_status;
    bool has_olc;
    bool is_delta_v_final;
    double end_s;    // of the record
    double travel_m; // largest integral of v_x
} metrics;

static double travel_m(const cp_pulse *pulse)
{
    const double *vx_m_s = pulse->channel[CP_CHANNEL_VX];
    double way_m = 0.0, largest_m = 0.0;
    for (size_t k = 1; k < pulse->sample_count; k++) {
        way_m += 0.5 * (vx_m_s[k - 1] + vx_m_s[k]) * pulse->sample_interval_s;
        largest_m = fmax(largest_m, way_m);
    }
    return largest_m;
}

static cp_status find_metrics(const cp_pulse_record *record, metrics *m, cp_error *error)
{
    const cp_pulse *pulse = &record->pulse;
    double separation_s = isfinite(record->separation_s) ? record->separation_s : 0.0;
    cp_status status =
        cp_severity_of_pulse(pulse, separation_s, !record->against_car, &m->severity, error);
    if (status != CP_OK)
        return status;
    const cp_olc *olc = &m->severity.olc;
    m->end_s = (double)(pulse->sample_count - 1) * pulse->sample_interval_s;
    m->travel_m = travel_m(pulse);
    bool frontal = record->side[0] == '\0' || strcmp(record->side, "front") == 0;
    bool decided = cp_olc_is_decided(olc, m->end_s, record->separation_s);
    m->has_olc = frontal && decided && olc->status == CP_OLC_VALUE;
    m->olc_status = !frontal  ? cp_olc_status_text(CP_OLC_NOT_FRONT_CONTACT)
                    : decided ? cp_olc_status_text(olc->status)
                              : "record_ends_early";
    // The largest change in the last sample may have grown on.
    m->is_delta_v_final = record->separation_s <= m->end_s + 1e-6 ||
                          m->severity.end_s < m->end_s - 0.5 * pulse->sample_interval_s;
    if (frontal && !decided)
        cp_log_warning("%s: ends at %.1f ms, before its OLC is decided: none is taken from it",
                       record->source, 1e3 * m->end_s);
    if (!m->is_delta_v_final)
        cp_log_warning("%s: ends at %.1f ms, when its change of velocity still grows: delta-v is "
                       "at least that",
                       record->source, 1e3 * m->end_s);
    return CP_OK;
}

static void numbers_of(const cp_pulse_record *record, const metrics *m,
                       number numbers[NUMBER_COUNT])
{
    const cp_severity *s = &m->severity;
    const bool lateral = record->known[CP_CHANNEL_AY], yaw = record->known[CP_CHANNEL_YAW_RATE];
    const cp_pulse *pulse = &record->pulse;
    const number own[NUMBER_COUNT] = {
        {"samples", "samples", 0, (double)pulse->sample_count},
        {"interval_ms", "  every, ms", 3, 1e3 * pulse->sample_interval_s},
        {"end_ms", "  until, ms", 1, 1e3 * m->end_s},
        {"speed_km_h", "speed at first contact, km/h", 2,
         cp_km_h_from_m_s(pulse->channel[CP_CHANNEL_VX][0])},
        {"olc_g", "OLC, g", 2, m->has_olc ? s->olc.olc_g : NAN},
        {"olc_t1_ms", "  t1, ms", 1, m->has_olc ? 1e3 * s->olc.t1_s : NAN},
        {"olc_t2_ms", "  t2, ms", 1, m->has_olc ? 1e3 * s->olc.t2_s : NAN},
        {"delta_v_km_h", "delta-v, km/h", 2, cp_km_h_from_m_s(s->delta_v_m_s)},
        {"delta_v_x_km_h", "  along x, km/h", 2, cp_km_h_from_m_s(s->delta_v_x_m_s)},
        {"delta_v_y_km_h", "  along y, km/h", 2,
         lateral ? cp_km_h_from_m_s(s->delta_v_y_m_s) : NAN},
        {"delta_v_at_ms", "  at, ms", 1, 1e3 * s->end_s},
        {"peak_g", "peak, CFC60, g", 1, s->peak_g},
        {"mean_g", "mean, g", 1, s->mean_g},
        {"max_50ms_g", "highest 50 ms mean, g", 1, s->max_50ms_g},
        {"asi_1", "ASI", 2, lateral ? s->asi_1 : NAN},
        {"t_v0_ms", "time of v = 0, ms", 1, 1e3 * s->t_v0_s},
        {"travel_mm", "largest integral of v_x, mm", 0, 1e3 * m->travel_m},
        {"pdof_deg", "direction of force, deg", 1, lateral ? cp_deg_from_rad(s->pdof_rad) : NAN},
        {"yaw_change_deg_s", "change of yaw rate, deg/s", 1,
         yaw ? cp_deg_from_rad(s->yaw_change_rad_s) : NAN},
    };
    memcpy(numbers, own, sizeof own);
}

static json_t *real_json(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static cp_status print_json(const cp_pulse_record *record, const metrics *m,
                            const number numbers[NUMBER_COUNT], FILE *file, cp_error *error)
{
    char source[1024];
    cp_text_for_terminal(record->source, "", source, sizeof source);
    json_t *all =
        json_pack("{s:s, s:s, s:o, s:s, s:b}", "source", source, "vehicle", record->vehicle,
                  "contact_side", record->side[0] != '\0' ? json_string(record->side) : json_null(),
                  "olc_status", m->olc_status, "delta_v_final", m->is_delta_v_final);
    for (size_t k = 0; all != NULL && k < NUMBER_COUNT; k++)
        json_object_set_new(all, numbers[k].name, real_json(numbers[k].value));
    return cp_json_print(all, file, error);
}

static cp_status print_csv(const cp_pulse_record *record, const metrics *m,
                           const number numbers[NUMBER_COUNT], FILE *file, cp_error *error)
{
    enum { TEXTS = 5 };
    const char *column[TEXTS + NUMBER_COUNT] = {"source", "vehicle", "contact_side", "olc_status",
                                                "delta_v_final"};
    cp_table table;
    for (size_t k = 0; k < NUMBER_COUNT; k++)
        column[TEXTS + k] = numbers[k].name;
    cp_table_begin(&table, column, TEXTS + NUMBER_COUNT);
    cp_table_text(&table, record->source);
    cp_table_text(&table, record->vehicle);
    cp_table_text(&table, record->side);
    cp_table_text(&table, m->olc_status);
    cp_table_integer(&table, m->is_delta_v_final);
    for (size_t k = 0; k < NUMBER_COUNT; k++)
        cp_table_real(&table, numbers[k].value);
    cp_status status = cp_table_print(&table, CP_FORMAT_CSV, file, error);
    cp_table_destroy(&table);
    return status;
}

static cp_status print_table(const cp_pulse_record *record, const metrics *m,
                             const number numbers[NUMBER_COUNT], FILE *file, cp_error *error)
{
    static const char *const COLUMN[] = {"figure", "value"};
    cp_table table;
    cp_text_print(file, record->source, "");
    if (record->vehicle[0] != '\0') {
        fputs(", vehicle ", file);
        cp_text_print(file, record->vehicle, "");
    }
    fputs("\n\n", file);
    cp_table_begin(&table, COLUMN, 2);
    table.right_from = 1;
    cp_table_text(&table, "OLC status");
    cp_table_text(&table, m->olc_status);
    for (size_t k = 0; k < NUMBER_COUNT; k++) {
        char text[48];
        // "-0.0" is 0.0 to every reader.
        double shown = numbers[k].value;
        if (fabs(shown) < 0.5 * pow(10.0, -numbers[k].digits))
            shown = 0.0;
        snprintf(text, sizeof text, "%s%.*f",
                 strcmp(numbers[k].name, "delta_v_km_h") == 0 && !m->is_delta_v_final ? ">" : "",
                 numbers[k].digits, shown);
        cp_table_text(&table, numbers[k].label);
        cp_table_text(&table, isfinite(numbers[k].value) ? text : "-");
    }
    cp_status status = cp_table_print(&table, CP_FORMAT_TABLE, file, error);
    cp_table_destroy(&table);
    return status;
}

cp_status cp_pulse_metrics_print(const cp_pulse_record *record, cp_format format, FILE *file,
                                 cp_error *error)
{
    metrics m = {0};
    number numbers[NUMBER_COUNT];
    cp_status status = find_metrics(record, &m, error);
    if (status != CP_OK)
        return status;
    numbers_of(record, &m, numbers);
    if (format == CP_FORMAT_JSON)
        return print_json(record, &m, numbers, file, error);
    return format == CP_FORMAT_CSV ? print_csv(record, &m, numbers, file, error)
                                   : print_table(record, &m, numbers, file, error);
}
