/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/calibration.h"
#include "calibrate/fit_vehicle.h"
#include "core/file.h"
#include "core/memory_stream.h"
#include "core/safe_text.h"
#include "core/units.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void cp_fit_write_way(FILE *file, const cp_fit *fit)
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

// Every corridor the fit was asked to keep.
static void write_targets(FILE *file, const cp_fit *fit, const cp_calibration *calibration)
{
    if (fit->target_count == 0)
        return;
    fprintf(file, "\n## Corridors of other crashes\n\n");
    for (size_t t = 0; t < fit->target_count; t++) {
        const cp_target *target = &fit->target[t];
        fputs("* ", file);
        cp_text_print(file, target->name, "");
        fprintf(file, " (weight %g), ", target->weight);
        if (target->against_itself)
            fprintf(file, "against a car like itself, %g km/h each", target->speed_km_h);
        else if (target->has_barrier)
            fprintf(file, "against a wall %g m wide with edges of %g m radius, %g km/h",
                    target->barrier.width_m, target->barrier.corner_radius_m, target->speed_km_h);
        else
            fprintf(file, "against the barrier of the reference, %g km/h", target->speed_km_h);
        fprintf(file, ", offset %g mm, angle %g deg: ", target->offset_mm, target->angle_deg);
        cp_text_print(file, target->source, "");
        fputc('\n', file);
    }
    fprintf(file, "\n| crash | quantity | at ms | model | smallest | aim | largest | |\n"
                  "|---|---|---:|---:|---:|---:|---:|---|\n");
    for (size_t t = 0; t < fit->target_count; t++) {
        for (size_t b = 0; b < fit->target[t].bound_count; b++) {
            const cp_target_bounds *bounds = &fit->target[t].bound[b];
            const cp_target_kind *kind = cp_target_kind_of(bounds->quantity);
            double value = calibration->target[t * CP_TARGET_BOUNDS_MAX + b];
            fputs("| ", file);
            cp_text_print(file, fit->target[t].name, "");
            fprintf(file, " | %s |", kind->key);
            if (cp_suite_quantity_is_timed(kind->quantity))
                fprintf(file, " %.0f |", 1e3 * bounds->at_s);
            else
                fprintf(file, " |");
            fprintf(file, " %.4g | %.4g | %.4g | %.4g | %s |\n", value / kind->si_per_unit,
                    bounds->min / kind->si_per_unit, bounds->aim / kind->si_per_unit,
                    bounds->max / kind->si_per_unit,
                    cp_target_excess(bounds, value) == 0.0 ? "" : "outside");
        }
    }
}

// Where the energy of full-width wall tests goes.
static void write_energy(FILE *file, const cp_calibration *calibration)
{
    static const struct {
        const char *name;
        size_t offset;
    } PART[] = {{"longitudinal members", offsetof(cp_car_absorbed, longitudinal_j)},
                {"bumper and crash boxes", offsetof(cp_car_absorbed, crash_box_j)},
                {"bending of members", offsetof(cp_car_absorbed, bending_j)},
                {"engine, cradle, firewall", offsetof(cp_car_absorbed, engine_j)},
                {"outboard corners", offsetof(cp_car_absorbed, corner_j)},
                {"upper load path", offsetof(cp_car_absorbed, upper_j)},
                {"strain rate, in all of them", offsetof(cp_car_absorbed, rate_j)}};
    fprintf(file, "\n## Where the energy goes at a wall 0.5 m wider than the car\n\n| part |");
    for (size_t k = 0; k < calibration->energy_count; k++)
        fprintf(file, " %g km/h |", calibration->energy_speed_km_h[k]);
    fprintf(file, "\n|---|");
    for (size_t k = 0; k < calibration->energy_count; k++)
        fprintf(file, "---:|");
    fprintf(file, "\n| absorbed, kJ |");
    for (size_t k = 0; k < calibration->energy_count; k++)
        fprintf(file, " %.1f |", 1e-3 * calibration->energy[k].absorbed_j);
    fprintf(file, "\n");
    for (size_t row = 0; row < sizeof PART / sizeof *PART; row++) {
        fprintf(file, "| %s |", PART[row].name);
        for (size_t k = 0; k < calibration->energy_count; k++) {
            double energy_j = 0.0;
            memcpy(&energy_j, (const char *)&calibration->energy[k].part + PART[row].offset,
                   sizeof energy_j);
            fprintf(file, " %.1f %% |", 100.0 * energy_j / calibration->energy[k].absorbed_j);
        }
        fprintf(file, "\n");
    }
}

static void write_ensemble_cost(FILE *file, const cp_fit *fit, const cp_calibration *calibration)
{
    const cp_ensemble *ensemble = &calibration->ensemble;
    if (fit->ensemble == 0)
        return;
    fprintf(file,
            "\n## Ensemble\n\n%zu of %zu parameter sets tried were kept: every unknown of the "
            "fitted vehicle moved by up to a quarter of its bounds, brought down again by least "
            "squares (%zu evaluations), and the robust cost of all residuals at most %g above that "
            "of the vehicle, %.4f g. Their costs:",
            calibration->model.member_count, ensemble->tried, fit->slope_evaluations / 2,
            fit->ensemble_within_1, ensemble->best_cost);
    for (size_t m = 0; m < calibration->model.member_count; m++)
        fprintf(file, "%s %.4f", m > 0 ? "," : "", ensemble->cost[m]);
    fprintf(file, " g.\n");
}

static void write_objective(FILE *file, const cp_fit *fit, const cp_calibration *calibration)
{
    if (fit->objective == CP_FIT_OLC && fit->reference.count == 0) {
        fprintf(
            file,
            "Objective: the corridors of other crashes alone, by their weights the mean excess in "
            "widths: %.4f. ",
            calibration->objective);
        return;
    }
    if (fit->objective == CP_FIT_OLC) {
        fprintf(file, "Objective: mean absolute OLC error against `%s`%s: %.3f g. ",
                fit->reference_path,
                fit->plausible.given || fit->target_count > 0
                    ? ", and 1 g for every width a mark of the pulse, or by its weight the mean "
                      "quantity of a corridor, is outside of its bounds"
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
    cp_fit_write_way(file, fit);
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
    bool has_cases = fit->reference.count > 0;
    if (has_cases)
        write_summary(file, fit->objective == CP_FIT_PULSE ? "OLC" : "Fitted to all configurations",
                      &calibration->validation);
    write_marks(file, fit, calibration);
    write_targets(file, fit, calibration);
    write_energy(file, calibration);
    write_ensemble_cost(file, fit, calibration);
    for (size_t c = 0; c < calibration->cross_count; c++) {
        char title[80];
        cp_cross_title(&calibration->cross[c], title);
        write_summary(file, title, &calibration->cross[c].validation);
    }
    if (has_cases)
        write_cumulative(file, fit, calibration);
    write_parameters(file, fit, calibration);
    if (has_cases)
        write_cases(file, fit, calibration);
}

// Write one text file through writer.
static cp_status write_text(const char *path,
                            void (*writer)(FILE *, const cp_fit *, const cp_calibration *),
                            const cp_fit *fit, const cp_calibration *calibration, cp_error *error)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = cp_memory_stream(&text, &size);
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
    cp_status status = write_text(fit->output_path, cp_fit_write_vehicle, fit, calibration, error);
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
