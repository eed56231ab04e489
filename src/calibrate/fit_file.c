/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/fit_file.h"

#include "calibrate/fit_schema.h"
#include "core/array.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/output_files.h"
#include "core/safe_text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A whole number with a default.
static cp_status read_count(const cp_yaml_file *file, const char *key, const char *text,
                            double smallest, double largest, size_t standard, size_t *count,
                            cp_error *error)
{
    double value = (double)standard;
    cp_status status = cp_yaml_number(file, key, text, smallest, largest, &value, error);
    if (status == CP_OK && value != (double)(size_t)value)
        status = cp_yaml_fail(file, error, key, "must be a whole number, found %s", text);
    *count = (size_t)value;
    return status;
}

static cp_status read_numbers(const cp_yaml_file *file, const cp_yaml_fit *yaml, cp_fit *fit,
                              cp_error *error)
{
    size_t seed = 0, threads = 1;
    fit->global_time_step_s = 0.0005;
    fit->local_time_step_s = 0.0005;
    fit->soft_g = 0.3;
    fit->ensemble_within_1 = 0.15;
    cp_status status = read_count(file, "seed", yaml->seed, 0, UINT32_MAX, 0, &seed, error);
    if (status == CP_OK)
        status =
            read_count(file, "population", yaml->population, 8, 10000, 40, &fit->population, error);
    if (status == CP_OK)
        status = read_count(file, "generations", yaml->generations, 0, 1e6, 150, &fit->generations,
                            error);
    if (status == CP_OK)
        status = read_count(file, "local_evaluations", yaml->local_evaluations, 0, 1e7, 1000,
                            &fit->local_evaluations, error);
    if (status == CP_OK)
        status = read_count(file, "starts", yaml->starts, 1, 100, 1, &fit->starts, error);
    if (status == CP_OK)
        status =
            read_count(file, "offspring", yaml->offspring, 0, 10000, 0, &fit->offspring, error);
    if (status == CP_OK)
        status = read_count(file, "slope_evaluations", yaml->slope_evaluations, 0, 1e7, 0,
                            &fit->slope_evaluations, error);
    if (status == CP_OK)
        status = read_count(file, "folds", yaml->folds, 0, CP_FOLDS_MAX, 0, &fit->folds, error);
    if (status == CP_OK)
        status = read_count(file, "neighbour_folds", yaml->neighbour_folds, 0, CP_FOLDS_MAX, 0,
                            &fit->neighbour_folds, error);
    if (status == CP_OK)
        status = read_count(file, "threads", yaml->threads, 1, 64, 1, &threads, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "global_time_step_s", yaml->global_time_step_s, 1e-5, 0.002,
                                &fit->global_time_step_s, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "local_time_step_s", yaml->local_time_step_s, 1e-5, 0.002,
                                &fit->local_time_step_s, error);
    if (status == CP_OK)
        status = read_count(file, "ensemble", yaml->ensemble, 0, CP_ENSEMBLE_MAX, 0, &fit->ensemble,
                            error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "ensemble_within_1", yaml->ensemble_within_1, 0.001, 1,
                                &fit->ensemble_within_1, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "soft_g", yaml->soft_g, 0.01, 100, &fit->soft_g, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "prior_g", yaml->prior_g, 0, 1000, &fit->prior_g, error);
    fit->seed = (uint32_t)seed;
    fit->threads = (int)threads;
    return status;
}

// An eighth of the evaluations must find the slopes once and take a step; children have two
// parents.
static cp_status check_drawn_starts(const cp_yaml_file *file, const cp_fit *fit, cp_error *error)
{
    if (fit->offspring > 0 && !cp_fit_draws_starts(fit))
        return cp_yaml_fail(file, error, "offspring",
                            "goes with generations: 0 and at least 2 starts, found %zu generations "
                            "and %zu start%s",
                            fit->generations, fit->starts, fit->starts == 1 ? "" : "s");
    size_t least = 8 * (fit->unknown_count + 2);
    if (!cp_fit_draws_starts(fit) || fit->slope_evaluations >= least)
        return CP_OK;
    return cp_yaml_fail(file, error, "slope_evaluations",
                        "must be at least %zu for %zu starts without generations, found %zu", least,
                        fit->starts, fit->slope_evaluations);
}

// Variables of which one level at a time is left out.
static cp_status read_leave_out(const cp_yaml_file *file, const cp_yaml_fit *yaml, cp_fit *fit,
                                cp_error *error)
{
    static const char *const WORD[4] = {NULL, "speed", "offset", "angle"};
    for (unsigned row = 0; row < yaml->leave_out_count; row++) {
        int kind = 1;
        while (kind < 4 && strcmp(yaml->leave_out[row], WORD[kind]) != 0)
            kind++;
        char key[32];
        snprintf(key, sizeof key, "leave_out[%u]", row);
        if (kind == 4)
            return cp_yaml_fail(file, error, key, "must be speed, offset or angle, found '%s'",
                                yaml->leave_out[row]);
        if (fit->leave_out[kind])
            return cp_yaml_fail(file, error, key, "'%s' is given twice", yaml->leave_out[row]);
        fit->leave_out[kind] = true;
    }
    return CP_OK;
}

// Bounds of one mark of the pulse.
static cp_status read_mark(const cp_yaml_file *file, int mark, const cp_yaml_bounds *yaml,
                           cp_plausibility *guard, cp_error *error)
{
    if (yaml == NULL)
        return CP_OK;
    const cp_mark_kind *kind = &CP_MARK_KIND[mark];
    char key[64];
    snprintf(key, sizeof key, "plausible.%s.min", kind->key);
    cp_status status = cp_yaml_number(file, key, yaml->min, 0, 1e4, &guard->min[mark], error);
    snprintf(key, sizeof key, "plausible.%s.max", kind->key);
    if (status == CP_OK)
        status = cp_yaml_number(file, key, yaml->max, 0, 1e4, &guard->max[mark], error);
    if (status == CP_OK && guard->max[mark] <= guard->min[mark])
        status = cp_yaml_fail(file, error, key, "must be above min = %g, found %s",
                              guard->min[mark], yaml->max);
    guard->min[mark] *= kind->si_per_unit;
    guard->max[mark] *= kind->si_per_unit;
    guard->bounded[mark] = true;
    return status;
}

static cp_status read_plausible(const cp_yaml_file *file, const cp_yaml_plausible *yaml,
                                cp_fit *fit, cp_error *error)
{
    if (yaml == NULL)
        return CP_OK;
    if (fit->objective != CP_FIT_OLC)
        return cp_yaml_fail(file, error, "plausible", "goes with objective olc");
    cp_plausibility *guard = &fit->plausible;
    guard->given = true;
    cp_status status = cp_yaml_number(file, "plausible.speed_km_h", yaml->speed_km_h, 1, 300,
                                      &guard->speed_km_h, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "plausible.offset_mm", yaml->offset_mm, -3000, 3000,
                                &guard->offset_mm, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "plausible.angle_deg", yaml->angle_deg, -90, 90,
                                &guard->angle_deg, error);
    const cp_yaml_bounds *bounds[CP_MARK_COUNT] = {[CP_MARK_T_V0] = yaml->t_v0_ms,
                                                   [CP_MARK_CRUSH] = yaml->crush_mm,
                                                   [CP_MARK_PEAK] = yaml->peak_g,
                                                   [CP_MARK_REBOUND] = yaml->rebound_m_s};
    for (int mark = 0; status == CP_OK && mark < CP_MARK_COUNT; mark++)
        status = read_mark(file, mark, bounds[mark], guard, error);
    if (status == CP_OK &&
        (yaml->source[0] == '\0' || strlen(yaml->source) >= sizeof guard->source ||
         !cp_text_is_plain(yaml->source)))
        status = cp_yaml_fail(file, error, "plausible.source",
                              "must be a line of 1 to %zu characters", sizeof guard->source - 1);
    snprintf(guard->source, sizeof guard->source, "%s", yaml->source);
    return status;
}

static cp_status read_unknown(const cp_yaml_file *file, const cp_yaml_unknown *yaml, size_t row,
                              cp_fit *fit, cp_error *error)
{
    char key[64];
    snprintf(key, sizeof key, "unknowns[%zu].name", row);
    if (!cp_unknown_exists(yaml->name))
        return cp_yaml_fail(file, error, key, "'%s' is no vehicle parameter and no barrier field",
                            yaml->name);
    for (size_t k = 0; k < row; k++)
        if (strcmp(fit->unknown[k].name, yaml->name) == 0)
            return cp_yaml_fail(file, error, key, "'%s' is given twice", yaml->name);
    cp_unknown *unknown = &fit->unknown[row];
    snprintf(unknown->name, sizeof unknown->name, "%s", yaml->name);

    // Bounds within the parameter's own range.
    double smallest = -3.0, largest = 20.0;
    size_t index = cp_vehicle_parameter_index(yaml->name);
    if (index < CP_VEHICLE_PARAMETER_COUNT) {
        smallest = CP_VEHICLE_PARAMETER[index].smallest;
        largest = CP_VEHICLE_PARAMETER[index].largest;
    }
    snprintf(key, sizeof key, "unknowns[%zu].min", row);
    cp_status status =
        cp_yaml_number(file, key, yaml->min, smallest, largest, &unknown->min, error);
    snprintf(key, sizeof key, "unknowns[%zu].max", row);
    if (status == CP_OK)
        status = cp_yaml_number(file, key, yaml->max, smallest, largest, &unknown->max, error);
    if (status == CP_OK && unknown->max <= unknown->min)
        status = cp_yaml_fail(file, error, key, "must be above min = %g, found %s", unknown->min,
                              yaml->max);
    return status;
}

static cp_status read_texts(const cp_yaml_file *file, const cp_yaml_fit *yaml, cp_fit *fit,
                            cp_error *error)
{
    if (yaml->fit[0] == '\0' || strlen(yaml->fit) >= sizeof fit->name)
        return cp_yaml_fail(file, error, "fit", "must have 1 to %zu characters",
                            sizeof fit->name - 1);
    const char *const LINE[][2] = {{"fit", yaml->fit},
                                   {"base", yaml->base},
                                   {"reference", yaml->reference},
                                   {"output", yaml->output}};
    for (size_t k = 0; k < sizeof LINE / sizeof *LINE; k++)
        if (LINE[k][1] != NULL && !cp_text_is_plain(LINE[k][1]))
            return cp_yaml_fail(file, error, LINE[k][0], "must be a single line of plain text");
    snprintf(fit->name, sizeof fit->name, "%s", yaml->fit);
    if (yaml->description != NULL)
        snprintf(fit->description, sizeof fit->description, "%s", yaml->description);
    const char *algorithm = yaml->algorithm != NULL ? yaml->algorithm : "de";
    if (strcmp(algorithm, "de") != 0 && strcmp(algorithm, "sade") != 0 &&
        strcmp(algorithm, "cmaes") != 0)
        return cp_yaml_fail(file, error, "algorithm", "must be de, sade or cmaes, found '%s'",
                            algorithm);
    snprintf(fit->algorithm, sizeof fit->algorithm, "%s", algorithm);
    return CP_OK;
}

// What is made small, and that the file names what that needs and nothing it does not.
static cp_status read_objective(const cp_yaml_file *file, const cp_yaml_fit *yaml, cp_fit *fit,
                                cp_error *error)
{
    const char *objective = yaml->objective != NULL ? yaml->objective : "olc";
    bool by_pulse = strcmp(objective, "pulse") == 0;
    if (!by_pulse && strcmp(objective, "olc") != 0)
        return cp_yaml_fail(file, error, "objective", "must be olc or pulse, found '%s'",
                            objective);
    if (by_pulse != (yaml->pulses_count > 0))
        return cp_yaml_fail(file, error, "pulses", "%s",
                            by_pulse ? "is missing: objective pulse needs the pulses to fit"
                                     : "goes with objective pulse");
    bool by_targets = !by_pulse && yaml->reference == NULL && yaml->targets_count > 0;
    if (by_pulse == (yaml->reference != NULL) && !by_targets)
        return cp_yaml_fail(file, error, "reference", "%s",
                            by_pulse ? "goes with objective olc"
                                     : "is missing: objective olc needs the OLC values to fit, or "
                                       "targets alone");
    if (by_targets && yaml->calibrated == NULL)
        return cp_yaml_fail(file, error, "calibrated",
                            "is missing: targets alone say of no range that the vehicle is "
                            "calibrated in it");
    fit->objective = by_pulse ? CP_FIT_PULSE : CP_FIT_OLC;
    if (by_pulse && yaml->prior_g != NULL)
        return cp_yaml_fail(file, error, "prior_g", "goes with objective olc");
    return CP_OK;
}

static cp_status read_range(const cp_yaml_file *file, const cp_yaml_range *yaml, cp_fit *fit,
                            cp_error *error)
{
    if (yaml == NULL)
        return CP_OK;
    cp_fit_range *range = &fit->range;
    range->given = true;
    cp_status status = cp_yaml_number(file, "calibrated.speed_min_km_h", yaml->speed_min_km_h, 1,
                                      300, &range->speed_min_km_h, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "calibrated.speed_max_km_h", yaml->speed_max_km_h,
                                range->speed_min_km_h, 300, &range->speed_max_km_h, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "calibrated.offset_max_mm", yaml->offset_max_mm, 0, 3000,
                                &range->offset_max_mm, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "calibrated.angle_max_deg", yaml->angle_max_deg, 0, 90,
                                &range->angle_max_deg, error);
    if (status == CP_OK &&
        (yaml->reason[0] == '\0' || strlen(yaml->reason) >= sizeof range->reason ||
         !cp_text_is_plain(yaml->reason)))
        status = cp_yaml_fail(file, error, "calibrated.reason",
                              "must be a line of 1 to %zu characters", sizeof range->reason - 1);
    snprintf(range->reason, sizeof range->reason, "%s", yaml->reason);
    return status;
}

// The table of OLC values, as seen from the fit file's folder.
static cp_status load_reference(const cp_yaml_file *file, const cp_yaml_fit *yaml, cp_fit *fit,
                                cp_error *error)
{
    if (yaml->reference == NULL)
        return CP_OK;
    char *path = cp_file_beside(file->path, yaml->reference);
    fit->reference_path = strdup(yaml->reference);
    cp_status status = path != NULL && fit->reference_path != NULL
                           ? cp_reference_load(path, &fit->reference, error)
                           : cp_fail_memory(error, file->path);
    free(path);
    return status;
}

// A part of a cross-validation holds something out, and leaves something to be fitted to.
static cp_status check_folds(const cp_yaml_file *file, const char *key, size_t folds,
                             const cp_fit *fit, cp_error *error)
{
    if (folds == 0 || (folds > 1 && folds <= fit->reference.count))
        return CP_OK;
    return cp_yaml_fail(file, error, key,
                        "must be 0, or from 2 to the %zu configurations of the reference, found "
                        "%zu",
                        fit->reference.count, folds);
}

// Remember a file that is read; name: as the fit file has it.
static cp_status add_input(const cp_yaml_file *file, const char *name, cp_fit *fit, cp_error *error)
{
    char **path = cp_array_add(fit->input_path, fit->input_count);
    if (path == NULL)
        return cp_fail_memory(error, file->path);
    *path = cp_file_beside(file->path, name);
    return *path != NULL ? CP_OK : cp_fail_memory(error, file->path);
}

static cp_status list_inputs(const cp_yaml_file *file, const cp_yaml_fit *yaml, cp_fit *fit,
                             cp_error *error)
{
    // cp_file_beside takes an absolute path as it is; the fit file's own is seen from here.
    const char *slash = strrchr(file->path, '/');
    cp_status status = add_input(file, slash != NULL ? slash + 1 : file->path, fit, error);
    if (status == CP_OK)
        status = add_input(file, yaml->base, fit, error);
    if (status == CP_OK && yaml->reference != NULL)
        status = add_input(file, yaml->reference, fit, error);
    for (unsigned k = 0; status == CP_OK && k < yaml->pulses_count; k++) {
        const cp_yaml_pulse *pulse = &yaml->pulses[k];
        const char *name = pulse->ev5 != NULL ? pulse->ev5 : pulse->file;
        if (name != NULL)
            status = add_input(file, name, fit, error);
    }
    return status;
}

// Where the file's own output: leads, or the output_path that was given instead.
static cp_status read_output(const cp_yaml_file *file, const cp_yaml_fit *yaml,
                             const char *output_path, cp_fit *fit, cp_error *error)
{
    cp_error own = {0};
    const char *ending = strrchr(output_path != NULL ? output_path : yaml->output, '.');
    bool is_yaml = ending != NULL && (strcmp(ending, ".yaml") == 0 || strcmp(ending, ".yml") == 0);
    if (!is_yaml && output_path != NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s: the fitted vehicle file must end in .yaml",
                       output_path);
    if (!is_yaml)
        return cp_yaml_fail(file, error, "output", "must end in .yaml, found '%s'", yaml->output);
    if (output_path == NULL && cp_output_file_check_below(file->path, yaml->output, &own) != CP_OK)
        return own.status == CP_NO_MEMORY
                   ? cp_fail_memory(error, file->path)
                   : cp_yaml_fail(file, error, "output",
                                  "%s; 'calibrate --output FILE' writes to another place",
                                  own.text);
    fit->output_path =
        output_path != NULL ? strdup(output_path) : cp_file_beside(file->path, yaml->output);
    return fit->output_path != NULL ? CP_OK : cp_fail_memory(error, file->path);
}

static cp_status check_outputs(const cp_fit *fit, cp_error *error)
{
    static const char *const ENDING[] = {"", ".fit.md", ".fit.state"};
    enum { COUNT = sizeof ENDING / sizeof *ENDING };
    char path[COUNT][4096];
    const char *outputs[COUNT];
    for (int k = 0; k < COUNT; k++) {
        snprintf(path[k], sizeof path[k], "%s%s", fit->output_path, ENDING[k]);
        outputs[k] = path[k];
    }
    return cp_output_files_check(outputs, COUNT, (const char *const *)fit->input_path,
                                 fit->input_count, error);
}

// The files a fit file names, as seen from its folder.
static cp_status load_named_files(const cp_yaml_file *file, const cp_yaml_fit *yaml,
                                  const char *output_path, cp_fit *fit, cp_error *error)
{
    cp_status status = list_inputs(file, yaml, fit, error);
    if (status == CP_OK)
        status = read_output(file, yaml, output_path, fit, error);
    if (status == CP_OK)
        status = check_outputs(fit, error);
    if (status == CP_OK) // the second of the inputs
        status = cp_vehicle_model_load(fit->input_path[1], &fit->base, error);
    if (status != CP_OK)
        return status;
    return fit->objective == CP_FIT_PULSE
               ? cp_fit_pulses_load(file, yaml->pulses, yaml->pulses_count, fit, error)
               : load_reference(file, yaml, fit, error);
}

cp_status cp_fit_load(const char *path, const char *output_path, cp_fit *fit, cp_error *error)
{
    *fit = (cp_fit){0};
    cp_yaml_file file = {0};
    cp_status status = cp_yaml_load(path, &CP_YAML_FIT_VALUE, &file, error);
    if (status != CP_OK)
        return status;
    const cp_yaml_fit *yaml = (const cp_yaml_fit *)file.data;
    status = read_texts(&file, yaml, fit, error);
    if (status == CP_OK)
        status = read_objective(&file, yaml, fit, error);
    if (status == CP_OK)
        status = read_range(&file, yaml->calibrated, fit, error);
    if (status == CP_OK)
        status = read_numbers(&file, yaml, fit, error);
    if (status == CP_OK)
        status = read_leave_out(&file, yaml, fit, error);
    if (status == CP_OK)
        status = read_plausible(&file, yaml->plausible, fit, error);
    if (status == CP_OK)
        status = cp_fit_targets_read(&file, yaml->targets, yaml->targets_count, fit, error);
    for (size_t row = 0; status == CP_OK && row < yaml->unknowns_count; row++)
        status = read_unknown(&file, &yaml->unknowns[row], row, fit, error);
    fit->unknown_count = yaml->unknowns_count;
    if (status == CP_OK)
        status = check_drawn_starts(&file, fit, error);
    if (status == CP_OK)
        status = load_named_files(&file, yaml, output_path, fit, error);
    if (status == CP_OK)
        status = check_folds(&file, "folds", fit->folds, fit, error);
    if (status == CP_OK)
        status = check_folds(&file, "neighbour_folds", fit->neighbour_folds, fit, error);
    cp_yaml_close(&file);
    if (status == CP_OK)
        status = cp_hash_file(path, fit->hash, error);
    if (status != CP_OK)
        cp_fit_destroy(fit);
    return status;
}
