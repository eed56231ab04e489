/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/crash_output.h"

#include "core/file.h"
#include "core/memory_stream.h"
#include "core/safe_text.h"
#include "core/units.h"
#include "crash/validity.h"

#include <math.h>
#include <stdlib.h>

#define NUMBER_COUNT 16

/* A number of one vehicle: name in JSON and CSV, label and digits in the table. */
typedef struct number {
    const char *name;
    const char *label;
    int digits;
    double value;
} number;

static void numbers_of(const cp_crash_run *run, int role, number numbers[NUMBER_COUNT])
{
    const cp_severity *s = &run->result.severity[role];
    bool touched = run->result.touched;
    bool frontal = touched && run->configuration.side[role] == CP_SIDE_FRONT;
    const number own[NUMBER_COUNT] = {
        {"olc_g", "OLC, g", 2, frontal ? s->olc.olc_g : NAN},
        {"olc_t1_ms", "  t1, ms", 1, frontal ? s->olc.t1_s * 1e3 : NAN},
        {"olc_t2_ms", "  t2, ms", 1, frontal ? s->olc.t2_s * 1e3 : NAN},
        {"delta_v_km_h", "delta-v, km/h", 2, cp_km_h_from_m_s(s->delta_v_m_s)},
        {"delta_v_x_km_h", "  along x, km/h", 2, cp_km_h_from_m_s(s->delta_v_x_m_s)},
        {"delta_v_y_km_h", "  along y, km/h", 2, cp_km_h_from_m_s(s->delta_v_y_m_s)},
        {"peak_g", "peak, CFC60, g", 1, s->peak_g},
        {"mean_g", "mean, g", 1, s->mean_g},
        {"max_50ms_g", "highest 50 ms mean, g", 1, s->max_50ms_g},
        {"max_50ms_y_g", "  sideways, g", 1, s->max_50ms_y_g},
        {"asi_1", "ASI", 2, s->asi_1},
        {"t_v0_ms", "time of v = 0, ms", 1, s->t_v0_s * 1e3},
        {"crush_mm", "dynamic crush, mm", 0, run->result.crush_m[role] * 1e3},
        {"intrusion_mm", "intrusion, mm", 0, run->result.struck[role].depth_m * 1e3},
        {"pdof_deg", "direction of force, deg", 1, cp_deg_from_rad(s->pdof_rad)},
        {"yaw_change_deg_s", "change of yaw rate, deg/s", 1, cp_deg_from_rad(s->yaw_change_rad_s)},
    };
    // Of an undisturbed motion nothing is told, as in a study.
    for (size_t k = 0; k < NUMBER_COUNT; k++) {
        numbers[k] = own[k];
        if (!touched)
            numbers[k].value = NAN;
    }
}

// OLC speaks of frontal contact only.
static const char *olc_status(const cp_crash_run *run, int role)
{
    bool frontal = run->configuration.side[role] == CP_SIDE_FRONT;
    if (frontal && !run->result.touched)
        return cp_olc_status_text(CP_OLC_SIMULATION_FAILED);
    return cp_olc_status_text(frontal ? run->result.severity[role].olc.status
                                      : CP_OLC_NOT_FRONT_CONTACT);
}

static const char *validity(const cp_crash_run *run, int role, char text[CP_VALIDITY_TEXT_SIZE])
{
    unsigned outside = cp_validity(run->model[0], run->model[1], &run->configuration,
                                   &run->description, role, NULL);
    outside |= cp_validity_of_meeting(run->result.touched, run->result.shift_m);
    return cp_validity_text(outside | (run->is_damaged ? CP_OUTSIDE_DAMAGED : 0), text);
}

// Where it was pushed in; of an undisturbed motion nowhere.
static const char *intrusion_zone(const cp_crash_run *run, int role)
{
    return run->result.touched ? cp_struck_zone_text(run->result.struck[role].zone) : NULL;
}

static const char *role_text(int role)
{
    return role == 0 ? "a" : "b";
}

static json_t *real_json(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *vehicle_json(const cp_crash_run *run, int role)
{
    char text[CP_VALIDITY_TEXT_SIZE];
    number numbers[NUMBER_COUNT];
    numbers_of(run, role, numbers);
    json_t *vehicle = json_pack("{s:s, s:s, s:s, s:s, s:s}", "role", role_text(role), "name",
                                run->model[role]->name, "contact_side",
                                cp_contact_side_text(run->configuration.side[role]), "validity",
                                validity(run, role, text), "olc_status", olc_status(run, role));
    for (size_t k = 0; k < NUMBER_COUNT; k++)
        json_object_set_new(vehicle, numbers[k].name, real_json(numbers[k].value));
    const char *zone = intrusion_zone(run, role);
    json_object_set_new(vehicle, "intrusion_zone", zone != NULL ? json_string(zone) : json_null());
    return vehicle;
}

json_t *cp_crash_configuration_json(const cp_crash_run *run)
{
    const cp_crash_description *d = &run->description;
    bool barrier = run->configuration.against_barrier;
    return json_pack("{s:s, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "vehicle",
                     run->model[0]->name, "against", barrier ? "barrier" : run->model[1]->name,
                     "speed_km_h", real_json(cp_km_h_from_m_s(d->speed_m_s[0])),
                     "opponent_speed_km_h",
                     barrier ? json_null() : real_json(cp_km_h_from_m_s(d->speed_m_s[1])),
                     "closing_speed_km_h", real_json(cp_km_h_from_m_s(d->closing_speed_m_s)),
                     "offset_mm", real_json(d->lateral_offset_m * 1e3), "angle_deg",
                     real_json(cp_deg_from_rad(d->angle_rad)), "overlap_1", real_json(d->overlap_1),
                     "duration_ms", real_json(run->duration_s * 1e3), "simulated_ms",
                     real_json((double)(run->result.pulse[0].sample_count - 1) *
                               run->result.pulse[0].sample_interval_s * 1e3));
}

static json_t *run_json(const cp_crash_run *run)
{
    json_t *vehicles = json_array();
    for (int role = 0; role < run->result.vehicle_count; role++)
        json_array_append_new(vehicles, vehicle_json(run, role));
    return json_pack("{s:o, s:o, s:o, s:o}", "configuration", cp_crash_configuration_json(run),
                     "vehicles", vehicles, "t_common_ms", real_json(run->result.t_common_s * 1e3),
                     "separation_ms", real_json(run->result.separation_s * 1e3));
}

static cp_status print_csv(const cp_crash_run *run, FILE *file, cp_error *error)
{
    const char *column[6 + NUMBER_COUNT] = {"role", "name", "contact_side", "validity",
                                            "olc_status"};
    char text[CP_VALIDITY_TEXT_SIZE];
    number numbers[NUMBER_COUNT];
    numbers_of(run, 0, numbers);
    for (size_t k = 0; k < NUMBER_COUNT; k++)
        column[5 + k] = numbers[k].name;
    column[5 + NUMBER_COUNT] = "intrusion_zone";
    cp_table table;
    cp_table_begin(&table, column, 6 + NUMBER_COUNT);
    for (int role = 0; role < run->result.vehicle_count; role++) {
        numbers_of(run, role, numbers);
        cp_table_text(&table, role_text(role));
        cp_table_text(&table, run->model[role]->name);
        cp_table_text(&table, cp_contact_side_text(run->configuration.side[role]));
        cp_table_text(&table, validity(run, role, text));
        cp_table_text(&table, olc_status(run, role));
        for (size_t k = 0; k < NUMBER_COUNT; k++)
            cp_table_real(&table, numbers[k].value);
        cp_table_text(&table, intrusion_zone(run, role) != NULL ? intrusion_zone(run, role) : "");
    }
    cp_status status = cp_table_print(&table, CP_FORMAT_CSV, file, error);
    cp_table_destroy(&table);
    return status;
}

void cp_crash_print_configuration(const cp_crash_run *run, FILE *file)
{
    const cp_crash_description *d = &run->description;
    cp_text_print(file, run->model[0]->name, "");
    fprintf(file, " at %.4g km/h against ", cp_km_h_from_m_s(d->speed_m_s[0]));
    if (run->configuration.against_barrier) {
        fputs("a rigid barrier", file);
    } else {
        cp_text_print(file, run->model[1]->name, "");
        fprintf(file, " at %.4g km/h", cp_km_h_from_m_s(d->speed_m_s[1]));
    }
    fprintf(file, ", offset %.0f mm, angle %.4g deg\n", d->lateral_offset_m * 1e3,
            cp_deg_from_rad(d->angle_rad));
    fprintf(file, "closing speed %.4g km/h", cp_km_h_from_m_s(d->closing_speed_m_s));
    if (isfinite(d->overlap_1))
        fprintf(file, ", overlap %.0f %%", d->overlap_1 * 100.0);
    fputs("\n\n", file);
}

static cp_status print_table(const cp_crash_run *run, FILE *file, cp_error *error)
{
    static const char *const COLUMN[] = {"vehicle", "a", "b"};
    char text[CP_VALIDITY_TEXT_SIZE];
    int count = run->result.vehicle_count;
    number numbers[2][NUMBER_COUNT];
    cp_table table;
    cp_crash_print_configuration(run, file);
    cp_table_begin(&table, COLUMN, 1 + (size_t)count);
    table.right_from = 1;
    cp_table_text(&table, "model");
    for (int role = 0; role < count; role++)
        cp_table_text(&table, run->model[role]->name);
    cp_table_text(&table, "struck on its");
    for (int role = 0; role < count; role++)
        cp_table_text(&table, cp_contact_side_text(run->configuration.side[role]));
    cp_table_text(&table, "validity");
    for (int role = 0; role < count; role++)
        cp_table_text(&table, validity(run, role, text));
    cp_table_text(&table, "OLC status");
    for (int role = 0; role < count; role++) {
        cp_table_text(&table, olc_status(run, role));
        numbers_of(run, role, numbers[role]);
    }
    cp_table_text(&table, "intrusion at");
    for (int role = 0; role < count; role++)
        cp_table_text(&table, intrusion_zone(run, role) != NULL ? intrusion_zone(run, role) : "-");
    for (size_t k = 0; k < NUMBER_COUNT; k++) {
        cp_table_text(&table, numbers[0][k].label);
        for (int role = 0; role < count; role++) {
            // "-0.0" is 0.0 to every reader.
            double shown = numbers[role][k].value;
            if (fabs(shown) < 0.5 * pow(10.0, -numbers[role][k].digits))
                shown = 0.0;
            snprintf(text, sizeof text, "%.*f", numbers[role][k].digits, shown);
            cp_table_text(&table, isfinite(numbers[role][k].value) ? text : "-");
        }
    }
    cp_status status = cp_table_print(&table, CP_FORMAT_TABLE, file, error);
    cp_table_destroy(&table);
    return status;
}

cp_status cp_crash_print(const cp_crash_run *run, cp_format format, FILE *file, cp_error *error)
{
    if (format == CP_FORMAT_JSON)
        return cp_json_print(run_json(run), file, error);
    return format == CP_FORMAT_CSV ? print_csv(run, file, error) : print_table(run, file, error);
}

static cp_status write_rows(const cp_crash_run *run, bool raw, FILE *out, cp_error *error)
{
    fputs("vehicle,time_s", out);
    for (size_t c = 0; c < CP_CHANNEL_COUNT; c++)
        fprintf(out, ",%s", CP_PULSE_COLUMN[c]);
    fputc('\n', out);
    for (int role = 0; role < run->result.vehicle_count; role++) {
        cp_pulse filtered = {0};
        const cp_pulse *pulse = &run->result.pulse[role];
        cp_status status = raw ? CP_OK : cp_pulse_filtered(pulse, 60.0, &filtered, error);
        if (status == CP_OK)
            status = cp_pulse_write_csv(raw ? pulse : &filtered, role_text(role), out, error);
        cp_pulse_destroy(&filtered);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

cp_status cp_crash_write_pulse(const cp_crash_run *run, bool raw, const char *path, cp_error *error)
{
    char *content = NULL;
    size_t size = 0;
    FILE *out = cp_memory_stream(&content, &size);
    if (!out)
        return cp_fail_memory(error, "a pulse");
    cp_status status = write_rows(run, raw, out, error);
    int failed = ferror(out);
    if ((fclose(out) != 0 || failed) && status == CP_OK)
        status = cp_fail_memory(error, "a pulse");
    if (status == CP_OK)
        status = cp_file_write(path, content, size, error);
    free(content);
    return status;
}
