/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/calibration.h"
#include "core/file.h"
#include "core/safe_text.h"
#include "core/units.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// So many pulses are listed in the head of the vehicle file.
enum { MISFITS_MAX = 4 };

// ---- the fitted vehicle ----------------------------------------------------------------------

static const cp_unknown *unknown_of(const cp_fit *fit, const char *name)
{
    for (size_t k = 0; k < fit->unknown_count; k++)
        if (strcmp(fit->unknown[k].name, name) == 0)
            return &fit->unknown[k];
    return NULL;
}

static double highest_speed(const cp_fit *fit, double sign)
{
    double best = -INFINITY;
    for (size_t k = 0; k < fit->reference.count; k++)
        best = fmax(best, sign * fit->reference.cases[k].speed_km_h);
    return sign * best;
}

static void write_range(FILE *file, const cp_fit *fit)
{
    cp_fit_range range = fit->range;
    if (range.given) {
        fprintf(file, "# calibrated range: %s\n", range.reason);
    } else {
        range.speed_min_km_h = highest_speed(fit, -1.0);
        range.speed_max_km_h = highest_speed(fit, 1.0);
        for (size_t k = 0; k < fit->reference.count; k++) {
            range.offset_max_mm =
                fmax(range.offset_max_mm, fabs(fit->reference.cases[k].offset_mm));
            range.angle_max_deg =
                fmax(range.angle_max_deg, fabs(fit->reference.cases[k].angle_deg));
        }
    }
    fprintf(file, "calibrated:\n  speed_min_km_h: %g\n  speed_max_km_h: %g\n", range.speed_min_km_h,
            range.speed_max_km_h);
    fprintf(file, "  offset_max_mm: %g\n  angle_max_deg: %g\n", range.offset_max_mm,
            range.angle_max_deg);
}

static void write_barrier(FILE *file, const cp_barrier *barrier)
{
    fprintf(file, "barrier:\n  width_m: %.9g\n  depth_m: %.9g\n  corner_radius_m: %.9g\n",
            barrier->width_m, barrier->depth_m, barrier->corner_radius_m);
    fprintf(file, "  pivot_m: %.9g\n  source: geometry of the reference study, see the fit\n",
            barrier->pivot_m);
}

// What the vehicle was fitted to and how far from it it is, as comment lines.
static void write_misfit(FILE *file, const cp_fit *fit, const cp_calibration *calibration)
{
    if (fit->objective == CP_FIT_PULSE)
        fprintf(file, "# weighted mean total error %.3f over %zu pulses\n", calibration->objective,
                fit->pulse_count);
    for (size_t k = 0; k < fit->pulse_count && k < MISFITS_MAX; k++) {
        const cp_reference_pulse *pulse = &fit->pulses[k];
        const cp_pulse_error *found = &calibration->work.pulse_error[k];
        fputs("# ", file);
        cp_text_print(file, pulse->source, "");
        fprintf(file, ": mean abs. error of v_x %.3f m/s over 0 to %.0f ms;\n", found->vx_m_s,
                1e3 * pulse->until_s);
        fprintf(file,
                "#   OLC %.2f g (reference %.2f), v = 0 at %.1f ms (%.1f), peak %.1f g (%.1f), "
                "crush %.0f mm (%.0f)\n",
                found->model.olc_g, pulse->marks.olc_g, 1e3 * found->model.t_v0_s,
                1e3 * pulse->marks.t_v0_s, found->model.peak_g, pulse->marks.peak_g,
                1e3 * found->model.crush_m, 1e3 * pulse->marks.crush_m);
    }
    if (fit->pulse_count > MISFITS_MAX)
        fprintf(file, "# every pulse: see the report\n");
    fprintf(file, "# mean absolute OLC error %.3f g, largest %.2f g, over %zu configurations\n",
            calibration->validation.mean_abs_error_g, calibration->validation.max_abs_error_g,
            fit->reference.count);
}

// How it was searched for.
static void write_way(FILE *file, const cp_fit *fit)
{
    if (cp_fit_draws_starts(fit)) {
        fprintf(file, "%zu starts, the base and vehicles drawn around it (seed %u), ", fit->starts,
                fit->seed);
        if (fit->offspring > 0)
            fprintf(file, "and %zu offspring of the best, each brought down by ", fit->offspring);
        else
            fprintf(file, "narrowed down by ");
        fprintf(file, "least squares (%zu evaluations for the last, time step %g s)",
                fit->slope_evaluations, fit->local_time_step_s);
    } else {
        fprintf(file,
                "%zu start%s of: global search `%s` (seed %u, population %zu, %zu generations, "
                "time step %g s), then least squares (%zu evaluations, time step %g s)",
                fit->starts, fit->starts == 1 ? "" : "s", fit->algorithm, fit->seed,
                fit->population, fit->generations, fit->global_time_step_s, fit->slope_evaluations,
                fit->local_time_step_s);
    }
    fprintf(file, "; from the best Nelder-Mead (%zu evaluations).\n", fit->local_evaluations);
}

static void write_source(FILE *file, const char *name)
{
    fprintf(file, "source: ");
    cp_text_write_yaml(file, name);
    fprintf(file, "}\n");
}

static void write_vehicle(FILE *file, const cp_fit *fit, const cp_calibration *calibration)
{
    const cp_vehicle_model *model = &calibration->model;
    fprintf(file,
            "# Made by crashpulse calibrate; the report of the fit stands beside this file.\n");
    fprintf(file, "# fit file sha256 %s\n# reference sha256 %s\n", fit->hash, fit->reference.hash);
    fprintf(file, "# ");
    write_way(file, fit);
    write_misfit(file, fit, calibration);
    fprintf(file, "vehicle: ");
    cp_text_write_yaml(file, fit->name);
    fputc('\n', file);
    if (fit->description[0] != '\0') {
        fprintf(file, "description: ");
        cp_text_write_yaml(file, fit->description);
        fputc('\n', file);
    }
    write_range(file, fit);
    write_barrier(file, &model->barrier);
    fprintf(file, "parameters:\n");
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++) {
        const cp_vehicle_parameter *parameter = &CP_VEHICLE_PARAMETER[k];
        const cp_unknown *unknown = unknown_of(fit, parameter->name);
        fprintf(file, "  - {name: %s, value: %.9g, unit: %s, ", parameter->name,
                cp_vehicle_model_get(model, k), parameter->unit);
        if (unknown != NULL)
            fprintf(file, "source: fitted within %g to %g}\n", unknown->min, unknown->max);
        else
            write_source(file, fit->base.name);
    }
}

// ---- the report ------------------------------------------------------------------------------

static void write_summary(FILE *file, const char *title, const cp_validation *validation)
{
    static const char *const VARIABLE[3] = {"speed km/h", "offset mm", "angle deg"};
    fprintf(file, "\n## %s\n\n", title);
    fprintf(file,
            "Mean absolute error %.3f g; quartiles %.2f / %.2f / %.2f g; largest %.2f g; signed "
            "errors %.2f to %+.2f g; %zu configurations.\n",
            validation->mean_abs_error_g, validation->quartile_g[0], validation->quartile_g[1],
            validation->quartile_g[2], validation->max_abs_error_g, validation->lowest_error_g,
            validation->highest_error_g, validation->count);
    for (int v = 0; v < 3; v++) {
        fprintf(file, "\n| %s | configurations | mean abs. error g |\n|---:|---:|---:|\n",
                VARIABLE[v]);
        for (size_t k = 0; k < validation->group_count[v]; k++)
            fprintf(file, "| %g | %zu | %.3f |\n", validation->group[v][k].value,
                    validation->group[v][k].count, validation->group[v][k].mean_abs_error_g);
    }
}

static void write_cases(FILE *file, const cp_fit *fit, const cp_calibration *calibration)
{
    fprintf(file, "\n## Every configuration\n\n| km/h | offset mm | angle deg | reference g | "
                  "model g | error g |");
    for (size_t c = 0; c < calibration->cross_count; c++) {
        char title[80];
        cp_cross_title(&calibration->cross[c], title);
        fprintf(file, " part | held out: %s, g |", title);
    }
    fprintf(file, "\n|---:|---:|---:|---:|---:|---:|");
    for (size_t c = 0; c < calibration->cross_count; c++)
        fprintf(file, "---:|---:|");
    fprintf(file, "\n");
    for (size_t k = 0; k < fit->reference.count; k++) {
        const cp_reference_case *row = &fit->reference.cases[k];
        fprintf(file, "| %g | %g | %g | %.2f | %.2f | %+.2f |", row->speed_km_h, row->offset_mm,
                row->angle_deg, row->olc_g, calibration->work.olc_g[k],
                calibration->work.olc_g[k] - row->olc_g);
        for (size_t c = 0; c < calibration->cross_count; c++)
            fprintf(file, " %zu | %.2f |", calibration->cross[c].part[k] + 1,
                    calibration->cross[c].held_out_g[k]);
        fprintf(file, "\n");
    }
}

static void write_cumulative(FILE *file, const cp_fit *fit, const cp_calibration *calibration)
{
    fprintf(file, "\n## Cumulative error\n\n| absolute error below g | share of configurations "
                  "|\n|---:|---:|\n");
    for (double limit_g = 0.25; limit_g < 6.0; limit_g *= sqrt(2.0)) {
        size_t below = 0;
        for (size_t k = 0; k < fit->reference.count; k++)
            below += fabs(calibration->work.olc_g[k] - fit->reference.cases[k].olc_g) < limit_g;
        fprintf(file, "| %.2f | %.3f |\n", limit_g, (double)below / (double)fit->reference.count);
    }
}

static void write_parameters(FILE *file, const cp_fit *fit, const cp_calibration *calibration)
{
    fprintf(file, "\n## Unknowns against their bounds\n\n| unknown | value | smallest | largest | "
                  "|\n|---|---:|---:|---:|---|\n");
    for (size_t k = 0; k < fit->unknown_count; k++) {
        const cp_unknown *unknown = &fit->unknown[k];
        double value = cp_unknown_get(&calibration->model, unknown->name);
        double share = (value - unknown->min) / (unknown->max - unknown->min);
        const char *remark = share < 0.01   ? "at its lower bound"
                             : share > 0.99 ? "at its upper bound"
                                            : "";
        fprintf(file, "| %s | %.4g | %g | %g | %s |\n", unknown->name, value, unknown->min,
                unknown->max, remark);
    }
}

// A value, or a dash where there is none.
static void write_mark(FILE *file, double value, double unit_si, int digits)
{
    if (isnan(value))
        fprintf(file, " - |");
    else
        fprintf(file, " %.*f |", digits, value / unit_si);
}

static void write_pulses(FILE *file, const cp_fit *fit, const cp_calibration *calibration)
{
    fprintf(file, "\n## Every pulse\n\nMean absolute errors from first contact to `until`, "
                  "accelerations through CFC60; marks as reference / model.\n\n"
                  "| pulse | km/h | offset mm | angle deg | until ms | total error | a_x g | a_y g "
                  "| v_x m/s | v_y m/s | v = 0 ms | | peak g | | crush mm | |\n"
                  "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|"
                  "---:|\n");
    for (size_t k = 0; k < fit->pulse_count; k++) {
        const cp_reference_pulse *pulse = &fit->pulses[k];
        const cp_pulse_error *found = &calibration->work.pulse_error[k];
        fputs("| ", file);
        cp_text_print(file, pulse->source, "");
        fprintf(file, " | %.4g | %g | %g | %.0f |", pulse->condition.speed_km_h,
                pulse->condition.offset_mm, pulse->condition.angle_deg, 1e3 * pulse->until_s);
        write_mark(file, found->total, 1.0, 3);
        write_mark(file, found->ax_g, 1.0, 3);
        write_mark(file, pulse->lateral ? found->ay_g : NAN, 1.0, 3);
        write_mark(file, found->vx_m_s, 1.0, 3);
        write_mark(file, pulse->lateral ? found->vy_m_s : NAN, 1.0, 3);
        write_mark(file, pulse->marks.t_v0_s, 1e-3, 1);
        write_mark(file, found->model.t_v0_s, 1e-3, 1);
        write_mark(file, pulse->marks.peak_g, 1.0, 1);
        write_mark(file, found->model.peak_g, 1.0, 1);
        write_mark(file, pulse->marks.crush_m, 1e-3, 0);
        write_mark(file, found->model.crush_m, 1e-3, 0);
        fprintf(file, "\n");
    }
}

// The pulse's marks against what is plausible.
static void write_marks(FILE *file, const cp_fit *fit, const cp_calibration *calibration)
{
    const cp_plausibility *guard = &fit->plausible;
    if (!guard->given)
        return;
    double excess_1[CP_MARK_COUNT];
    cp_plausibility_excess(guard, calibration->mark, excess_1);
    fprintf(file, "\n## Marks of the pulse at %g km/h, %g mm, %g deg\n\n", guard->speed_km_h,
            guard->offset_mm, guard->angle_deg);
    fprintf(file,
            "Bounds: %s\n\n| mark | model | smallest | largest | |\n|---|---:|---:|---:|---|\n",
            guard->source);
    for (int k = 0; k < CP_MARK_COUNT; k++) {
        if (!guard->bounded[k])
            continue;
        double unit = CP_MARK_KIND[k].si_per_unit;
        fprintf(file, "| %s | %.4g | %g | %g | %s |\n", CP_MARK_KIND[k].key,
                calibration->mark[k] / unit, guard->min[k] / unit, guard->max[k] / unit,
                excess_1[k] == 0.0 ? "" : "outside");
    }
}

static void write_objective(FILE *file, const cp_fit *fit, const cp_calibration *calibration)
{
    if (fit->objective == CP_FIT_OLC) {
        fprintf(file, "Objective: mean absolute OLC error against `%s`%s: %.3f g. ",
                fit->reference_path,
                fit->plausible.given
                    ? ", and 1 g for every width a mark of the pulse is outside of "
                      "its bounds"
                    : "",
                calibration->objective);
        return;
    }
    fprintf(file,
            "Objective: weighted mean total error over %zu pulses, MAE a_x + MAE a_y + 10 MAE v_x "
            "+ 10 MAE v_y + MAE of the time of v_x = 0 (g, m/s, s): **%.3f**. ",
            fit->pulse_count, calibration->objective);
}

static void write_report(FILE *file, const cp_fit *fit, const cp_calibration *calibration)
{
    fprintf(file, "# Fit of %s\n\n", fit->name);
    write_objective(file, fit, calibration);
    write_way(file, fit);
    if (fit->slope_evaluations > 0)
        fprintf(file, "\nLeast squares count an error above %g g by its absolute value.\n",
                fit->soft_g);
    if (fit->prior_g > 0.0)
        fprintf(
            file,
            "\nPrior: an unknown that moves through the whole of its bounds, away from its value "
            "in the base, must take %g g off the summed errors.\n",
            fit->prior_g);
    if (fit->objective == CP_FIT_PULSE)
        write_pulses(file, fit, calibration);
    write_summary(file, fit->objective == CP_FIT_PULSE ? "OLC" : "Fitted to all configurations",
                  &calibration->validation);
    write_marks(file, fit, calibration);
    for (size_t c = 0; c < calibration->cross_count; c++) {
        char title[80];
        cp_cross_title(&calibration->cross[c], title);
        write_summary(file, title, &calibration->cross[c].validation);
    }
    write_cumulative(file, fit, calibration);
    write_parameters(file, fit, calibration);
    write_cases(file, fit, calibration);
}

// Write one text file through writer.
static cp_status write_text(const char *path,
                            void (*writer)(FILE *, const cp_fit *, const cp_calibration *),
                            const cp_fit *fit, const cp_calibration *calibration, cp_error *error)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (stream == NULL)
        return cp_fail_memory(error, path);
    writer(stream, fit, calibration);
    cp_status status = CP_OK;
    if (fclose(stream) != 0)
        status = cp_fail_memory(error, path);
    if (status == CP_OK)
        status = cp_file_write(path, text, size, error);
    free(text);
    return status;
}

cp_status cp_calibration_write(const cp_fit *fit, const cp_calibration *calibration,
                               cp_error *error)
{
    char path[4096];
    cp_status status = write_text(fit->output_path, write_vehicle, fit, calibration, error);
    snprintf(path, sizeof path, "%s.fit.md", fit->output_path);
    if (status == CP_OK)
        status = write_text(path, write_report, fit, calibration, error);
    if (status != CP_OK)
        return status;

    // What a killed fit would have gone on from is no longer needed.
    cp_fit_search_forget(fit, fit->output_path);
    for (size_t c = 0; c < calibration->cross_count; c++)
        cp_cross_validation_forget(fit, &calibration->cross[c]);
    return CP_OK;
}
