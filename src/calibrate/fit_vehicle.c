/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/fit_vehicle.h"

#include "core/safe_text.h"
#include "core/units.h"

#include <math.h>
#include <string.h>

// So many pulses are listed in the head of the vehicle file.
enum { MISFITS_MAX = 4 };

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
    if (fit->reference.count == 0) {
        fprintf(file, "# targets alone: mean excess over their corridors %.4f widths\n",
                calibration->objective);
        return;
    }
    fprintf(file, "# mean absolute OLC error %.3f g, largest %.2f g, over %zu configurations\n",
            calibration->validation.mean_abs_error_g, calibration->validation.max_abs_error_g,
            fit->reference.count);
}

// The parameter sets that fit about as well, one row an unknown of the vehicle.
static void write_ensemble(FILE *file, const cp_fit *fit, const cp_calibration *calibration)
{
    const cp_vehicle_model *model = &calibration->model;
    if (model->member_count == 0)
        return;
    fprintf(file,
            "# %zu parameter sets whose robust cost is at most %g above that of the vehicle\n"
            "ensemble:\n",
            model->member_count, fit->ensemble_within_1);
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++) {
        bool differs = false;
        for (size_t m = 0; m < model->member_count; m++)
            differs = differs || model->member[m][k] != cp_vehicle_model_get(model, k);
        if (!differs)
            continue;
        fprintf(file, "  - {name: %s, values: [", CP_VEHICLE_PARAMETER[k].name);
        for (size_t m = 0; m < model->member_count; m++)
            fprintf(file, "%s%.9g", m > 0 ? ", " : "", model->member[m][k]);
        fprintf(file, "]}\n");
    }
}

static void write_source(FILE *file, const char *name)
{
    fprintf(file, "source: ");
    cp_text_write_yaml(file, name);
    fprintf(file, "}\n");
}

void cp_fit_write_vehicle(FILE *file, const cp_fit *fit, const cp_calibration *calibration)
{
    const cp_vehicle_model *model = &calibration->model;
    fprintf(file,
            "# Made by crashpulse calibrate; the report of the fit stands beside this file.\n");
    fprintf(file, "# fit file sha256 %s\n", fit->hash);
    if (fit->reference.count > 0)
        fprintf(file, "# reference sha256 %s\n", fit->reference.hash);
    fprintf(file, "# ");
    cp_fit_write_way(file, fit);
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
        if (model->scatter_1[k] > 0.0)
            fprintf(file, "min: %.9g, max: %.9g, scatter: %.9g, ", model->smallest[k],
                    model->largest[k], model->scatter_1[k]);
        if (unknown != NULL)
            fprintf(file, "source: fitted within %g to %g}\n", unknown->min, unknown->max);
        else
            write_source(file, fit->base.name);
    }
    write_ensemble(file, fit, calibration);
}
