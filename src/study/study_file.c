/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/study_file.h"

#include "core/file.h"
#include "study/control_section.h"
#include "study/fleet_section.h"
#include "study/library_section.h"
#include "study/study_schema.h"
#include "study/sumo_configuration.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define NAME_CHARACTERS_MAX 64
#define KEY_PATH_SIZE 512

// ---- checks --------------------------------------------------------------------------------

// Names become row ids, file names and words on a command line: no blanks, no '|'.
static cp_status take_name(const cp_yaml_file *file, const char *key_path, const char *text,
                           char **name, cp_error *error)
{
    size_t length = strlen(text);
    bool good = length > 0 && length <= NAME_CHARACTERS_MAX;
    for (const char *c = text; good && *c != '\0'; c++)
        good = isalnum((unsigned char)*c) || strchr("_-.", *c) != NULL;
    if (!good)
        return cp_yaml_fail(file, error, key_path,
                            "must be 1 to %d letters, digits, '_', '-' or '.', found '%s'",
                            NAME_CHARACTERS_MAX, text);
    *name = strdup(text);
    return *name != NULL ? CP_OK : cp_fail_memory(error, key_path);
}

// A file named in the study must be readable; its path is seen from the study file.
static cp_status take_path(const cp_yaml_file *file, const char *key_path, const char *text,
                           char **path, cp_error *error)
{
    *path = cp_file_beside(file->path, text);
    if (*path == NULL)
        return cp_fail_memory(error, key_path);
    if (access(*path, R_OK) != 0)
        return cp_yaml_fail(file, error, key_path, "must be a readable file, found '%s' (%s)", text,
                            *path);
    return CP_OK;
}

static cp_status take_whole(const cp_yaml_file *file, const char *key_path, const char *text,
                            double smallest, double largest, uint64_t *value, cp_error *error)
{
    double number = 0.0;
    cp_status status = cp_yaml_number(file, key_path, text, smallest, largest, &number, error);
    if (status == CP_OK && number != floor(number))
        return cp_yaml_fail(file, error, key_path, "must be a whole number, found %s", text);
    *value = (uint64_t)number;
    return status;
}

static cp_status take_design(const cp_yaml_file *file, const char *text, cp_study_design *design,
                             cp_error *error)
{
    if (cp_study_design_find(text, design))
        return CP_OK;
    return cp_yaml_fail(file, error, "design",
                        "must be paired_seeds, independent or counterfactual, found '%s'", text);
}

static cp_status take_head(const cp_yaml_file *file, const cp_raw_study *raw, cp_study *study,
                           cp_error *error)
{
    uint64_t replications = 0;
    study->step_length_s = 0.05;
    cp_status status = take_name(file, "study", raw->study, &study->name, error);
    if (status == CP_OK && raw->question != NULL) {
        study->question = strdup(raw->question);
        if (study->question == NULL)
            status = cp_fail_memory(error, "question");
    }
    if (status == CP_OK)
        status = take_design(file, raw->design, &study->design, error);
    if (status == CP_OK)
        status = take_whole(file, "seed", raw->seed, 0, 9007199254740992.0, &study->seed, error);
    if (status == CP_OK)
        status = take_whole(file, "replications", raw->replications, 1, 1e6, &replications, error);
    if (status == CP_OK)
        status =
            cp_yaml_number(file, "duration_s", raw->duration_s, 0, 1e6, &study->duration_s, error);
    if (status == CP_OK && study->duration_s <= 0)
        status = cp_yaml_fail(file, error, "duration_s", "must be > 0, found %s", raw->duration_s);
    if (status == CP_OK)
        status = cp_yaml_number(file, "warmup_s", raw->warmup_s, 0, 1e6, &study->warmup_s, error);
    if (status == CP_OK && study->warmup_s >= study->duration_s)
        status = cp_yaml_fail(file, error, "warmup_s", "must be less than duration_s, found %s",
                              raw->warmup_s);
    if (status == CP_OK)
        status = cp_yaml_number(file, "step_length_s", raw->step_length_s, 0.001, 1,
                                &study->step_length_s, error);
    if (status == CP_OK &&
        fabs(1e3 * study->step_length_s - round(1e3 * study->step_length_s)) > 1e-6)
        status = cp_yaml_fail(file, error, "step_length_s",
                              "must be whole milliseconds, as SUMO counts them, found %s",
                              raw->step_length_s);
    if (status == CP_OK)
        status = cp_yaml_number(file, "history_s", raw->history_s, 0, 60, &study->history_s, error);
    if (status == CP_OK && raw->after_crash != NULL)
        status = cp_yaml_number(file, "after_crash.stay_s", raw->after_crash->stay_s, 0, 86400,
                                &study->stay_s, error);
    study->replications = (size_t)replications;
    return status;
}

// As long as a replication unless told otherwise; a run that ends within its warm-up tells nothing.
static cp_status take_background(const cp_yaml_file *file, const cp_raw_background *raw,
                                 cp_study *study, cp_error *error)
{
    uint64_t seeds = study->replications < 3 ? study->replications : 3;
    study->background_s = study->duration_s;
    study->background_seeds = (size_t)seeds;
    if (raw == NULL)
        return CP_OK;
    if (raw->duration_s == NULL && raw->seeds == NULL)
        return cp_yaml_fail(file, error, "background",
                            "must have duration_s or seeds, found neither");
    cp_status status = CP_OK;
    if (raw->duration_s != NULL)
        status = cp_yaml_number(file, "background.duration_s", raw->duration_s, 0, 1e6,
                                &study->background_s, error);
    if (status == CP_OK && raw->duration_s != NULL && study->background_s > 0 &&
        study->background_s <= study->warmup_s)
        status = cp_yaml_fail(file, error, "background.duration_s",
                              "must be 0 (none) or more than warmup_s, found %s", raw->duration_s);
    if (status == CP_OK && raw->seeds != NULL)
        status = take_whole(file, "background.seeds", raw->seeds, 1, 1000, &seeds, error);
    study->background_seeds = (size_t)seeds;
    return status;
}

static cp_status take_counterfactual(const cp_yaml_file *file, const cp_raw_counterfactual *raw,
                                     cp_study *study, cp_error *error)
{
    cp_study_counterfactual *section = &study->counterfactual;
    uint64_t checkpoints = 20;
    *section = (cp_study_counterfactual){
        .checkpoint_interval_s = 2.0, .checkpoints = 20, .horizon_s = CP_STUDY_HORIZON_S};
    if (raw == NULL)
        return CP_OK;
    if (study->design != CP_DESIGN_COUNTERFACTUAL)
        return cp_yaml_fail(file, error, "counterfactual",
                            "belongs to the design counterfactual, found the design %s",
                            cp_study_design_text(study->design));
    cp_status status =
        cp_yaml_number(file, "counterfactual.checkpoint_interval_s", raw->checkpoint_interval_s,
                       0.5, 60, &section->checkpoint_interval_s, error);
    if (status == CP_OK && raw->checkpoints != NULL)
        status = take_whole(file, "counterfactual.checkpoints", raw->checkpoints, 1, 200,
                            &checkpoints, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "counterfactual.time_series_s", raw->time_series_s, 0, 60,
                                &section->time_series_s, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "counterfactual.horizon_s", raw->horizon_s, 1, 120,
                                &section->horizon_s, error);
    section->checkpoints = (size_t)checkpoints;
    return status;
}

// ---- scenarios and variants ----------------------------------------------------------------

// Penetration of a function by SUMO vehicle type.
static cp_status take_equipment(const cp_yaml_file *file, const char *entry_path,
                                const cp_raw_control *raw, cp_control_settings *settings,
                                cp_error *error)
{
    if (raw->equipment_count == 0)
        return CP_OK;
    settings->shares = calloc(raw->equipment_count, sizeof *settings->shares);
    if (settings->shares == NULL)
        return cp_fail_memory(error, entry_path);
    for (size_t k = 0; k < raw->equipment_count; k++) {
        char path[2 * KEY_PATH_SIZE];
        cp_equipment_share *share = &settings->shares[k];
        share->type = strdup(raw->equipment[k].type);
        if (share->type == NULL)
            return cp_fail_memory(error, entry_path);
        settings->share_count++;
        snprintf(path, sizeof path, "%s.equipment[%zu].type", entry_path, k);
        for (size_t other = 0; other < k; other++)
            if (strcmp(settings->shares[other].type, share->type) == 0)
                return cp_yaml_fail(file, error, path, "repeats '%s'", share->type);
        snprintf(path, sizeof path, "%s.equipment[%zu].penetration_1", entry_path, k);
        cp_status status = cp_yaml_number(file, path, raw->equipment[k].penetration_1, 0, 1,
                                          &share->penetration_1, error);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

static cp_status take_controls(const cp_yaml_file *file, cp_control_kind kind,
                               const char *list_path, const char *name_key,
                               const cp_raw_control *raw, size_t count,
                               cp_control_settings **settings, size_t *settings_count,
                               cp_error *error)
{
    if (count == 0)
        return CP_OK;
    *settings = calloc(count, sizeof **settings);
    if (*settings == NULL)
        return cp_fail_memory(error, list_path);
    for (size_t k = 0; k < count; k++) {
        char path[KEY_PATH_SIZE];
        snprintf(path, sizeof path, "%s[%zu]", list_path, k);
        cp_status status = cp_control_section_read(file, kind, path, name_key, raw[k].name,
                                                   &(*settings)[k], error);
        (*settings_count)++;
        if (status == CP_OK)
            status = cp_library_section_read(file, path, raw[k].name, raw[k].library, raw[k].as,
                                             raw[k].data, &(*settings)[k], error);
        if (status == CP_OK)
            status = take_equipment(file, path, &raw[k], &(*settings)[k], error);
        if (status != CP_OK)
            return status;
        // Draws depend on the control's name: the same twice would act in lockstep.
        for (size_t other = 0; other < k; other++)
            if (strcmp(cp_control_name(&(*settings)[other]), cp_control_name(&(*settings)[k])) == 0)
                return cp_yaml_fail(file, error, path, "repeats '%s'",
                                    cp_control_name(&(*settings)[k]));
    }
    return CP_OK;
}

static cp_status take_words(const cp_raw_scenario *raw, cp_study_scenario *scenario,
                            cp_error *error)
{
    if (raw->sumo_options_count == 0)
        return CP_OK;
    scenario->sumo_options = calloc(raw->sumo_options_count, sizeof *scenario->sumo_options);
    if (scenario->sumo_options == NULL)
        return cp_fail_memory(error, "sumo_options");
    for (size_t k = 0; k < raw->sumo_options_count; k++) {
        scenario->sumo_options[k] = strdup(raw->sumo_options[k]);
        if (scenario->sumo_options[k] == NULL)
            return cp_fail_memory(error, "sumo_options");
        scenario->sumo_option_count++;
    }
    return CP_OK;
}

// What SUMO is told must leave a run that can be simulated; of the words the study's line is named.
static cp_status check_options(const cp_yaml_file *file, const char *path,
                               const cp_study_scenario *scenario, double duration_s,
                               cp_error *error)
{
    static const char WORDS[] = "sumo_options: ";
    cp_sumo_configuration configuration = {0};
    cp_error reason = {0};
    cp_status status =
        cp_sumo_configuration_read(scenario->sumocfg_path, scenario->sumo_options,
                                   scenario->sumo_option_count, &configuration, &reason);
    bool is_read = status == CP_OK;
    if (is_read)
        status = cp_sumo_configuration_check(&configuration, duration_s, &reason);
    cp_sumo_configuration_destroy(&configuration);
    if (status == CP_OK)
        return CP_OK;
    bool is_of_words = strncmp(reason.text, WORDS, sizeof WORDS - 1) == 0;
    if (is_of_words)
        return cp_yaml_fail(file, error, path, "%s", reason.text + sizeof WORDS - 1);
    *error = reason;
    return status;
}

static cp_status take_scenario(const cp_yaml_file *file, const cp_raw_scenario *raw,
                               cp_study *study, size_t index, cp_error *error)
{
    char path[KEY_PATH_SIZE];
    cp_study_scenario *scenario = &study->scenarios[index];
    snprintf(path, sizeof path, "scenarios[%zu].name", index);
    cp_status status = take_name(file, path, raw->name, &scenario->name, error);
    for (size_t k = 0; status == CP_OK && k < index; k++)
        if (strcmp(study->scenarios[k].name, raw->name) == 0)
            status =
                cp_yaml_fail(file, error, path, "'%s' is taken by another scenario", raw->name);
    if (status == CP_OK) {
        scenario->base = strdup(scenario->name);
        if (scenario->base == NULL)
            status = cp_fail_memory(error, path);
    }
    snprintf(path, sizeof path, "scenarios[%zu].sumocfg", index);
    if (status == CP_OK)
        status = take_path(file, path, raw->sumocfg, &scenario->sumocfg_path, error);
    if (status == CP_OK) {
        scenario->sumocfg = strdup(raw->sumocfg);
        if (scenario->sumocfg == NULL)
            status = cp_fail_memory(error, path);
    }
    if (status == CP_OK)
        status = take_words(raw, scenario, error);
    snprintf(path, sizeof path, "scenarios[%zu].sumo_options", index);
    if (status == CP_OK)
        status = check_options(file, path, scenario, study->duration_s, error);
    snprintf(path, sizeof path, "scenarios[%zu].driver_errors", index);
    if (status == CP_OK)
        status = take_controls(file, CP_CONTROL_DRIVER_ERROR, path, "model", raw->driver_errors,
                               raw->driver_errors_count, &scenario->driver_errors,
                               &scenario->driver_error_count, error);
    return status;
}

static cp_status take_scenarios(const cp_yaml_file *file, const cp_raw_study *raw, cp_study *study,
                                cp_error *error)
{
    study->scenarios = calloc(raw->scenarios_count, sizeof *study->scenarios);
    if (study->scenarios == NULL)
        return cp_fail_memory(error, "scenarios");
    study->scenario_count = raw->scenarios_count;
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < raw->scenarios_count; k++)
        status = take_scenario(file, &raw->scenarios[k], study, k, error);
    return status;
}

static cp_status take_variant(const cp_yaml_file *file, const cp_raw_variant *raw, cp_study *study,
                              size_t index, cp_error *error)
{
    char path[KEY_PATH_SIZE];
    cp_study_variant *variant = &study->variants[index];
    snprintf(path, sizeof path, "variants[%zu].name", index);
    cp_status status = take_name(file, path, raw->name, &variant->name, error);
    for (size_t k = 0; status == CP_OK && k < index; k++)
        if (strcmp(study->variants[k].name, raw->name) == 0)
            status = cp_yaml_fail(file, error, path, "'%s' is taken by another variant", raw->name);
    if (status == CP_OK) {
        variant->base = strdup(variant->name);
        if (variant->base == NULL)
            status = cp_fail_memory(error, path);
    }
    snprintf(path, sizeof path, "variants[%zu].functions", index);
    if (status == CP_OK)
        status = take_controls(file, CP_CONTROL_FUNCTION, path, "function", raw->functions,
                               raw->functions_count, &variant->functions, &variant->function_count,
                               error);
    return status;
}

static cp_status take_variants(const cp_yaml_file *file, const cp_raw_study *raw, cp_study *study,
                               cp_error *error)
{
    study->variants = calloc(raw->variants_count, sizeof *study->variants);
    if (study->variants == NULL)
        return cp_fail_memory(error, "variants");
    study->variant_count = raw->variants_count;
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < raw->variants_count; k++)
        status = take_variant(file, &raw->variants[k], study, k, error);
    if (status != CP_OK)
        return status;

    // The baseline is the one named, else the first.
    for (size_t k = 0; k < study->variant_count; k++) {
        cp_study_variant *variant = &study->variants[k];
        variant->is_baseline =
            raw->baseline != NULL ? strcmp(variant->name, raw->baseline) == 0 : k == 0;
        if (variant->is_baseline)
            return CP_OK;
    }
    return cp_yaml_fail(file, error, "baseline", "must be the name of a variant, found '%s'",
                        raw->baseline);
}

// What only the design counterfactual asks of the variants.
static cp_status check_treatments(const cp_yaml_file *file, const cp_study *study, cp_error *error)
{
    if (study->design != CP_DESIGN_COUNTERFACTUAL)
        return CP_OK;
    if (study->variant_count < 2)
        return cp_yaml_fail(file, error, "variants",
                            "must hold a treatment besides the baseline in a counterfactual study");
    for (size_t k = 0; k < study->variant_count; k++) {
        char path[KEY_PATH_SIZE];
        const cp_study_variant *variant = &study->variants[k];
        snprintf(path, sizeof path, "variants[%zu].functions", k);
        if (variant->is_baseline && variant->function_count > 0)
            return cp_yaml_fail(file, error, path,
                                "must be empty: the baseline of a counterfactual study drives "
                                "without functions, found %zu",
                                variant->function_count);
        for (size_t f = 0; f < variant->function_count; f++) {
            snprintf(path, sizeof path, "variants[%zu].functions[%zu].function", k, f);
            if (variant->functions[f].type->acts_long_before)
                return cp_yaml_fail(file, error, path,
                                    "%s acts long before a crash and cannot be judged from a "
                                    "checkpoint; use the design paired_seeds or independent",
                                    variant->functions[f].type->name);
        }
    }
    return CP_OK;
}

// The name of a shipped vehicle stays a name; everything else is a file.
static cp_status take_model(const cp_yaml_file *file, const char *key_path, const char *text,
                            cp_study_vehicle *vehicle, cp_error *error)
{
    vehicle->line = cp_yaml_line_of(file, key_path);
    if (strchr(text, '/') != NULL || strchr(text, '.') != NULL)
        return take_path(file, key_path, text, &vehicle->model_path, error);
    vehicle->model_name = strdup(text);
    return vehicle->model_name != NULL ? CP_OK : cp_fail_memory(error, key_path);
}

static cp_status take_vehicles(const cp_yaml_file *file, const cp_raw_vehicles *given,
                               cp_study *study, cp_error *error)
{
    const cp_raw_vehicles nothing = {0};
    const cp_raw_vehicles *raw = given != NULL ? given : &nothing;
    study->vehicles = calloc((size_t)raw->types_count + 1, sizeof *study->vehicles);
    if (study->vehicles == NULL)
        return cp_fail_memory(error, "vehicles");
    study->vehicle_count = (size_t)raw->types_count + 1;
    if (raw->standard != NULL && raw->fleet != NULL)
        return cp_yaml_fail(file, error, "vehicles.fleet",
                            "does not go with vehicles.default: the cars of a fleet are drawn");
    cp_status status =
        cp_fleet_section_take(file, raw->fleet, raw->market, raw->market_count, study, error);
    if (status == CP_OK && raw->standard != NULL)
        status = take_model(file, "vehicles.default", raw->standard, &study->vehicles[0], error);
    for (size_t k = 0; status == CP_OK && k < raw->types_count; k++) {
        char path[KEY_PATH_SIZE];
        snprintf(path, sizeof path, "vehicles.types[%zu].model", k);
        status = take_model(file, path, raw->types[k].model, &study->vehicles[k + 1], error);
        snprintf(path, sizeof path, "vehicles.types[%zu].type", k);
        for (size_t other = 0; status == CP_OK && other < k; other++)
            if (strcmp(raw->types[other].type, raw->types[k].type) == 0)
                status = cp_yaml_fail(file, error, path, "repeats '%s'", raw->types[k].type);
        study->vehicles[k + 1].type = strdup(raw->types[k].type);
        if (status == CP_OK && study->vehicles[k + 1].type == NULL)
            status = cp_fail_memory(error, path);
    }
    return status;
}

// ---- the whole -----------------------------------------------------------------------------

cp_status cp_study_load(const char *path, cp_study *study, cp_error *error)
{
    cp_yaml_file file = {0};
    size_t size = 0;
    *study = (cp_study){.path = strdup(path)};
    cp_status status = study->path != NULL ? CP_OK : cp_fail_memory(error, path);
    if (status == CP_OK)
        status = cp_file_read(path, &study->content, &size, error);
    if (status == CP_OK)
        status = cp_yaml_parse(path, study->content, size, &CP_RAW_STUDY, &file, error);
    if (status != CP_OK)
        goto done;
    const cp_raw_study *raw = (const cp_raw_study *)file.data;
    status = take_head(&file, raw, study, error);
    if (status == CP_OK)
        status = take_background(&file, raw->background, study, error);
    if (status == CP_OK)
        status = cp_assessment_take(&file, raw->assessment, study->said, error);
    if (status == CP_OK)
        status = take_scenarios(&file, raw, study, error);
    if (status == CP_OK)
        status = take_variants(&file, raw, study, error);
    if (status == CP_OK)
        status = take_counterfactual(&file, raw->counterfactual, study, error);
    if (status == CP_OK)
        status = check_treatments(&file, study, error);
    if (status == CP_OK)
        status = take_vehicles(&file, raw->vehicles, study, error);
    // Last: messages about scenarios and variants count them as the file does.
    if (status == CP_OK)
        status = cp_sweep_expand(&file, raw->sweep, raw->sweep_count, study, error);
    cp_yaml_close(&file);
done:
    if (status != CP_OK)
        cp_study_destroy(study);
    return status;
}
