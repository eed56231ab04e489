/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/pulse_validation.h"

#include "core/file.h"
#include "core/memory_stream.h"
#include "core/units.h"

#include <math.h>
#include <stdlib.h>

// ---- printing --------------------------------------------------------------------------------

#define ROW_COUNT 10

// One figure: of the reference, of the model, and how far apart; NAN: there is none.
typedef struct row {
    const char *name; // in JSON and CSV
    const char *label;
    int digits;
    double reference;
    double model;
    double error;
} row;

static row mark_row(const char *name, const char *label, int digits, double reference, double model)
{
    return (row){name, label, digits, reference, model, model - reference};
}

static row error_row(const char *name, const char *label, int digits, double error)
{
    return (row){name, label, digits, NAN, NAN, error};
}

static void find_rows(const cp_reference_pulse *pulse, const cp_pulse_error *found,
                      row rows[ROW_COUNT])
{
    const cp_pulse_marks *reference = &pulse->marks, *model = &found->model;
    const row all[ROW_COUNT] = {
        mark_row("olc_g", "OLC, g", 2, reference->olc_g, model->olc_g),
        mark_row("t_v0_ms", "time of v = 0, ms", 1, 1e3 * reference->t_v0_s, 1e3 * model->t_v0_s),
        mark_row("peak_g", "peak, CFC60, g", 1, reference->peak_g, model->peak_g),
        mark_row("crush_mm", "largest integral of v_x, mm", 0, 1e3 * reference->crush_m,
                 1e3 * model->crush_m),
        error_row("mae_vx_m_s", "mean abs. error of v_x, m/s", 3, found->vx_m_s),
        error_row("mae_vy_m_s", "mean abs. error of v_y, m/s", 3,
                  pulse->lateral ? found->vy_m_s : NAN),
        error_row("mae_ax_g", "mean abs. error of a_x, g", 2, found->ax_g),
        error_row("mae_ay_g", "mean abs. error of a_y, g", 2, pulse->lateral ? found->ay_g : NAN),
        error_row("error_t_v0_ms", "error of the time of v = 0 in the total, ms", 1,
                  1e3 * found->t_v0_s),
        error_row("total_error", "total error", 3, found->total),
    };
    for (size_t k = 0; k < ROW_COUNT; k++)
        rows[k] = all[k];
}

static json_t *real_json(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *result_json(const char *vehicle, const cp_reference_pulse *pulse,
                           const row rows[ROW_COUNT])
{
    json_t *result = json_pack("{s:s, s:s, s:f, s:f, s:f, s:f}", "vehicle", vehicle, "reference",
                               pulse->source, "speed_km_h", pulse->condition.speed_km_h,
                               "offset_mm", pulse->condition.offset_mm, "angle_deg",
                               pulse->condition.angle_deg, "until_ms", 1e3 * pulse->until_s);
    for (size_t k = 0; k < ROW_COUNT; k++)
        json_object_set_new(
            result, rows[k].name,
            isnan(rows[k].reference) && isnan(rows[k].model)
                ? real_json(rows[k].error)
                : json_pack("{s:o, s:o, s:o}", "reference", real_json(rows[k].reference), "model",
                            real_json(rows[k].model), "error", real_json(rows[k].error)));
    return result;
}

// A cell of the table for people; the one for programs has all digits.
static void add_number(cp_table *table, cp_format format, double value, int digits)
{
    char text[32];
    snprintf(text, sizeof text, "%.*f", digits, value);
    if (format == CP_FORMAT_CSV)
        cp_table_real(table, value);
    else
        cp_table_text(table, isfinite(value) ? text : "");
}

static cp_status print_rows(const row rows[ROW_COUNT], cp_format format, cp_error *error)
{
    static const char *const COLUMNS[] = {"measure", "reference", "model", "error"};
    cp_table table = {0};
    cp_table_begin(&table, COLUMNS, sizeof COLUMNS / sizeof *COLUMNS);
    table.right_from = 1;
    for (size_t k = 0; k < ROW_COUNT; k++) {
        if (format == CP_FORMAT_TABLE && isnan(rows[k].error))
            continue;
        cp_table_text(&table, format == CP_FORMAT_CSV ? rows[k].name : rows[k].label);
        add_number(&table, format, rows[k].reference, rows[k].digits);
        add_number(&table, format, rows[k].model, rows[k].digits);
        add_number(&table, format, rows[k].error, rows[k].digits);
    }
    cp_status status = cp_table_print(&table, format, stdout, error);
    cp_table_destroy(&table);
    return status;
}

static cp_status print(const char *vehicle, const cp_reference_pulse *pulse,
                       const cp_pulse_error *found, cp_format format, cp_error *error)
{
    row rows[ROW_COUNT];
    find_rows(pulse, found, rows);
    if (format == CP_FORMAT_JSON)
        return cp_json_print(result_json(vehicle, pulse, rows), stdout, error);
    if (format == CP_FORMAT_TABLE)
        printf("%s against %s: %.4g km/h, offset %g mm, angle %g deg, 0 to %g ms\n\n", vehicle,
               pulse->source, pulse->condition.speed_km_h, pulse->condition.offset_mm,
               pulse->condition.angle_deg, 1e3 * pulse->until_s);
    return print_rows(rows, format, error);
}

// ---- curves ----------------------------------------------------------------------------------

static void write_rows(const cp_reference_pulse *reference, const cp_pulse *model, FILE *file)
{
    fputs("time_s,reference_ax_g,reference_vx_m_s,reference_x_m,ax_g,vx_m_s,x_m\n", file);
    double way_m = 0.0, own_way_m = 0.0, last_m_s = 0.0;
    for (size_t k = 0; k < reference->count; k++) {
        double time_s = (double)k * reference->interval_s;
        double speed_m_s = cp_samples_at(model->channel[CP_CHANNEL_VX], model->sample_count,
                                         model->sample_interval_s, time_s);
        double ax_m_s2 = cp_samples_at(model->channel[CP_CHANNEL_AX], model->sample_count,
                                       model->sample_interval_s, time_s);
        if (k > 0) {
            way_m +=
                0.5 * (reference->vx_m_s[k - 1] + reference->vx_m_s[k]) * reference->interval_s;
            own_way_m += 0.5 * (last_m_s + speed_m_s) * reference->interval_s;
        }
        last_m_s = speed_m_s;
        fprintf(file, "%.10g,%.10g,%.10g,%.10g,%.10g,%.10g,%.10g\n", time_s, reference->ax_g[k],
                reference->vx_m_s[k], way_m, ax_m_s2 / CP_G0_M_S2, speed_m_s, own_way_m);
    }
}

static cp_status write_curves(const cp_reference_pulse *reference, const cp_crash_result *result,
                              const char *path, cp_error *error)
{
    cp_pulse filtered = {0};
    char *text = NULL;
    size_t size = 0;
    cp_status status = cp_pulse_filtered(&result->pulse[0], 60.0, &filtered, error);
    if (status != CP_OK)
        return status;
    FILE *stream = cp_memory_stream(&text, &size);
    if (stream != NULL) {
        write_rows(reference, &filtered, stream);
        if (fclose(stream) != 0)
            status = cp_fail_memory(error, path);
    } else {
        status = cp_fail_memory(error, path);
    }
    if (status == CP_OK)
        status = cp_file_write(path, text, size, error);
    free(text);
    cp_pulse_destroy(&filtered);
    return status;
}

cp_status cp_pulse_validate(const cp_vehicle_model *model, const cp_pulse_source *source,
                            const char *curves_path, cp_format format, cp_error *error)
{
    cp_reference_pulse reference;
    cp_crash_result result = {0};
    cp_pulse_error found;
    cp_status status = cp_reference_pulse_load(source, &reference, error);
    if (status != CP_OK)
        return status;
    status = cp_crash_library_begin(error);
    if (status == CP_OK) {
        status = cp_reference_pulse_simulate(
            model, &reference, cp_crash_options_default().time_step_s, &result, error);
        cp_crash_library_end();
    }
    if (status == CP_OK)
        status = cp_pulse_compare(&reference, &result, &found, NULL, error);
    if (status == CP_OK && curves_path != NULL)
        status = write_curves(&reference, &result, curves_path, error);
    if (status == CP_OK)
        status = print(model->name, &reference, &found, format, error);
    cp_crash_result_destroy(&result);
    cp_reference_pulse_destroy(&reference);
    return status;
}
