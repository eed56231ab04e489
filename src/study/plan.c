/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/plan.h"

#include "core/rng.h"
#include "study/scenario_files.h"

#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Numbers as people wrote them: 15 digits give 0.1 back as 0.1.
#define JSON_FLAGS (JSON_COMPACT | JSON_REAL_PRECISION(15))

uint64_t cp_plan_seed(const cp_study *study, size_t scenario, size_t variant, size_t number)
{
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(study->seed), "replication seeds");
    bool independent = study->design == CP_DESIGN_INDEPENDENT;
    const cp_study_scenario *of = &study->scenarios[scenario];
    key = cp_rng_key_text(key, independent ? of->name : of->base);
    if (independent)
        key = cp_rng_key_text(key, study->variants[variant].name);

    // Steps by an odd number visit every 31-bit value once: no seed comes twice.
    uint64_t start = cp_rng_bits(key, 0);
    return (start + (uint64_t)number * UINT64_C(0x9e3779b1)) & UINT64_C(0x7fffffff);
}

// ---- the study in JSON ---------------------------------------------------------------------

// {SUMO vehicle type: penetration}
static json_t *equipment_json(const cp_control_settings *settings)
{
    json_t *shares = json_object();
    for (size_t k = 0; k < settings->share_count; k++)
        json_object_set_new(shares, settings->shares[k].type,
                            json_real(settings->shares[k].penetration_1));
    return shares;
}

// What a library is asked for with; numbers as numbers.
static void add_library(json_t *entry, json_t *parameters, const cp_library *library)
{
    for (size_t k = 0; k < library->given_count; k++) {
        const cp_library_parameter *given = &library->given[k];
        json_object_set_new(parameters, given->name,
                            isnan(given->number) ? json_string(given->text)
                                                 : json_real(given->number));
    }
    json_object_set_new(entry, "library", json_string(library->written));
    json_object_set_new(entry, "library_hash", json_string(library->hash));
    if (library->data != NULL) {
        json_object_set_new(entry, "data", json_string(library->data));
        json_object_set_new(entry, "data_hash", json_string(library->data_hash));
    }
}

// [{"model": name, "parameters": {...}}], defaults included.
static json_t *controls_json(const cp_control_settings *settings, size_t count,
                             const char *name_key)
{
    json_t *list = json_array();
    for (size_t k = 0; k < count; k++) {
        const cp_control_type *type = settings[k].type;
        json_t *parameters = json_object();
        for (size_t p = 0; p < type->parameter_count; p++)
            json_object_set_new(parameters, type->parameters[p].name,
                                json_real(settings[k].parameter[p]));
        json_t *entry = json_pack("{s:s, s:o}", name_key, cp_control_name(&settings[k]),
                                  "parameters", parameters);
        if (settings[k].library != NULL)
            add_library(entry, parameters, settings[k].library);
        if (settings[k].share_count > 0)
            json_object_set_new(entry, "equipment", equipment_json(&settings[k]));
        json_array_append_new(list, entry);
    }
    return list;
}

// Text of a JSON value, which is given up; NULL when memory is gone.
static char *take_text(json_t *value)
{
    char *text = value != NULL ? json_dumps(value, JSON_FLAGS) : NULL;
    json_decref(value);
    return text;
}

static char *words_text(char *const *words, size_t count)
{
    json_t *list = json_array();
    for (size_t k = 0; k < count; k++)
        json_array_append_new(list, json_string(words[k]));
    return take_text(list);
}

static json_t *market_json(const cp_study *study)
{
    json_t *market = json_array();
    for (size_t k = 0; k < study->market_count; k++)
        json_array_append_new(market, json_pack("{s:s, s:s, s:f}", "type", study->market[k].type,
                                                "class", study->market[k].vehicle_class, "share_1",
                                                study->market[k].share_1));
    return market;
}

static char *vehicles_text(const cp_study *study, const cp_vehicle_model_row *models)
{
    json_t *types = json_object();
    for (size_t k = 1; k < study->vehicle_count; k++)
        json_object_set_new(types, study->vehicles[k].type, json_string(models[k].name));
    json_t *vehicles = json_pack("{s:s?, s:o}", "default", models[0].name, "types", types);
    // Only where there is one: what was run without stays done.
    if (study->has_fleet) {
        json_object_set_new(vehicles, "fleet", json_string("default"));
        json_object_set_new(vehicles, "market", market_json(study));
    }
    return take_text(vehicles);
}

// ---- rows ----------------------------------------------------------------------------------

static cp_status fill_study(const cp_study *study, const cp_vehicle_model_row *models,
                            cp_study_row *row, cp_error *error)
{
    *row = (cp_study_row){.name = strdup(study->name),
                          .question = study->question != NULL ? strdup(study->question) : NULL,
                          .design = cp_study_design_text(study->design),
                          .seed = study->seed,
                          .replications = study->replications,
                          .duration_s = study->duration_s,
                          .warmup_s = study->warmup_s,
                          .step_length_s = study->step_length_s,
                          .stay_s = study->stay_s,
                          .history_s = study->history_s,
                          .vehicles = vehicles_text(study, models),
                          .yaml = strdup(study->content)};
    cp_hash_bytes(study->content, strlen(study->content), row->hash);
    bool complete = row->name != NULL && row->vehicles != NULL && row->yaml != NULL &&
                    (study->question == NULL || row->question != NULL);
    return complete ? CP_OK : cp_fail_memory(error, "study");
}

// Hashes of a scenario's files; of the values of a sweep once.
static cp_status fill_files(const cp_study *study, size_t k, cp_plan_rows *rows, cp_error *error)
{
    const cp_study_scenario *scenario = &study->scenarios[k];
    const cp_scenario_inputs inputs = cp_study_scenario_inputs(scenario);
    if (k == 0 || !cp_study_scenarios_start_alike(&study->scenarios[k - 1], scenario))
        return cp_scenario_files_json(&inputs, &rows->scenario[k].files, error);
    rows->scenario[k].files = strdup(rows->scenario[k - 1].files);
    return rows->scenario[k].files != NULL ? CP_OK : cp_fail_memory(error, scenario->name);
}

static cp_status fill_scenarios(const cp_study *study, cp_plan_rows *rows, cp_error *error)
{
    rows->scenario = calloc(study->scenario_count, sizeof *rows->scenario);
    if (rows->scenario == NULL)
        return cp_fail_memory(error, "scenarios");
    rows->scenario_count = study->scenario_count;
    for (size_t k = 0; k < study->scenario_count; k++) {
        const cp_study_scenario *scenario = &study->scenarios[k];
        cp_scenario_row *row = &rows->scenario[k];
        *row = (cp_scenario_row){
            .name = strdup(scenario->name),
            .sumocfg = strdup(scenario->sumocfg),
            .sumo_options = words_text(scenario->sumo_options, scenario->sumo_option_count),
            .driver_errors = take_text(
                controls_json(scenario->driver_errors, scenario->driver_error_count, "model"))};
        if (row->name == NULL || row->sumocfg == NULL || row->sumo_options == NULL ||
            row->driver_errors == NULL)
            return cp_fail_memory(error, scenario->name);
        cp_status status = fill_files(study, k, rows, error);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

// ---- sweeps --------------------------------------------------------------------------------

static cp_status add_sweeps(bool of_scenario, size_t owner, const char *base,
                            const cp_study_swept *swept, size_t count, cp_plan_rows *rows,
                            cp_error *error)
{
    for (size_t k = 0; k < count; k++) {
        cp_sweep_row *row = &rows->sweep[rows->sweep_count++];
        *row = (cp_sweep_row){of_scenario, owner, strdup(base), strdup(swept[k].parameter),
                              swept[k].value};
        if (row->base == NULL || row->parameter == NULL)
            return cp_fail_memory(error, "sweep");
    }
    return CP_OK;
}

static cp_status fill_sweeps(const cp_study *study, cp_plan_rows *rows, cp_error *error)
{
    size_t total = 1;
    for (size_t k = 0; k < study->scenario_count; k++)
        total += study->scenarios[k].swept_count;
    for (size_t k = 0; k < study->variant_count; k++)
        total += study->variants[k].swept_count;
    rows->sweep = calloc(total, sizeof *rows->sweep);
    cp_status status = rows->sweep != NULL ? CP_OK : cp_fail_memory(error, "sweep");
    for (size_t k = 0; status == CP_OK && k < study->scenario_count; k++) {
        const cp_study_scenario *of = &study->scenarios[k];
        status = add_sweeps(true, k, of->base, of->swept, of->swept_count, rows, error);
    }
    for (size_t k = 0; status == CP_OK && k < study->variant_count; k++) {
        const cp_study_variant *of = &study->variants[k];
        status = add_sweeps(false, k, of->base, of->swept, of->swept_count, rows, error);
    }
    return status;
}

// ---- variants, vehicles --------------------------------------------------------------------

static cp_status fill_variants(const cp_study *study, cp_plan_rows *rows, cp_error *error)
{
    rows->variant = calloc(study->variant_count, sizeof *rows->variant);
    if (rows->variant == NULL)
        return cp_fail_memory(error, "variants");
    rows->variant_count = study->variant_count;
    for (size_t k = 0; k < study->variant_count; k++) {
        const cp_study_variant *variant = &study->variants[k];
        cp_variant_row *row = &rows->variant[k];
        *row = (cp_variant_row){.name = strdup(variant->name),
                                .is_baseline = variant->is_baseline,
                                .functions = take_text(controls_json(
                                    variant->functions, variant->function_count, "function"))};
        if (row->name == NULL || row->functions == NULL)
            return cp_fail_memory(error, variant->name);
    }
    return CP_OK;
}

// Each model once; the same name for two different cars would mix them up in the database.
static cp_status fill_vehicle_models(const cp_study *study, const cp_vehicle_model_row *models,
                                     size_t model_count, cp_plan_rows *rows, cp_error *error)
{
    rows->vehicle_model = calloc(model_count, sizeof *rows->vehicle_model);
    if (rows->vehicle_model == NULL)
        return cp_fail_memory(error, "vehicles");
    for (size_t k = 0; k < model_count; k++) {
        if (models[k].name == NULL)
            continue;
        size_t known = 0;
        while (known < rows->vehicle_model_count &&
               strcmp(rows->vehicle_model[known].name, models[k].name) != 0)
            known++;
        cp_vehicle_model_row *row = &rows->vehicle_model[known];
        if (known < rows->vehicle_model_count) {
            if (strcmp(row->hash, models[k].hash) != 0)
                return cp_fail(error, CP_BAD_INPUT,
                               "%s: the name '%s' belongs to another vehicle file of the study too",
                               k < study->vehicle_count && study->vehicles[k].model_path != NULL
                                   ? study->vehicles[k].model_path
                                   : study->path,
                               models[k].name);
            continue;
        }
        *row = models[k];
        row->name = strdup(models[k].name);
        row->yaml = strdup(models[k].yaml);
        rows->vehicle_model_count++;
        if (row->name == NULL || row->yaml == NULL)
            return cp_fail_memory(error, models[k].name);
    }
    return CP_OK;
}

// Whether a variant has replications of its own: the treatments of a counterfactual study have
// none.
static bool is_run(const cp_study *study, size_t variant)
{
    return study->design != CP_DESIGN_COUNTERFACTUAL || study->variants[variant].is_baseline;
}

// What a counterfactual replication does besides: its treatments by name, and its section.
static json_t *counterfactual_json(const cp_study *study, const cp_plan_rows *rows)
{
    json_t *treatments = json_object();
    for (size_t k = 0; k < study->variant_count; k++)
        if (!is_run(study, k))
            json_object_set_new(treatments, rows->variant[k].name,
                                json_string(rows->variant[k].functions));
    json_t *section =
        json_pack("{s:o, s:f, s:I, s:f}", "treatments", treatments, "checkpoint_interval_s",
                  study->counterfactual.checkpoint_interval_s, "checkpoints",
                  (json_int_t)study->counterfactual.checkpoints, "time_series_s",
                  study->counterfactual.time_series_s);
    // Only another one than ever before: what was run with that stays done.
    if (study->counterfactual.horizon_s != CP_STUDY_HORIZON_S)
        json_object_set_new(section, "horizon_s", json_real(study->counterfactual.horizon_s));
    return section;
}

// All that the outcome of a replication depends on, as JSON; NULL when memory is gone.
static char *configuration_text(const cp_study *study, const cp_plan_rows *rows,
                                const cp_replication_row *replication)
{
    const cp_scenario_row *scenario = &rows->scenario[replication->scenario];
    json_t *hashes = json_array();
    for (size_t k = 0; k < rows->vehicle_model_count; k++)
        json_array_append_new(hashes, json_string(rows->vehicle_model[k].hash));
    json_t *configuration = json_pack(
        "{s:I, s:I, s:f, s:f, s:f, s:s, s:s, s:s, s:s, s:s, s:o}", "study_seed",
        (json_int_t)study->seed, "seed", (json_int_t)replication->seed, "duration_s",
        study->duration_s, "warmup_s", study->warmup_s, "step_length_s", study->step_length_s,
        "sumo_options", scenario->sumo_options, "files", scenario->files, "driver_errors",
        scenario->driver_errors, "functions", rows->variant[replication->variant].functions,
        "vehicles", rows->study.vehicles, "vehicle_files", hashes);
    if (study->design == CP_DESIGN_COUNTERFACTUAL)
        json_object_set_new(configuration, "counterfactual", counterfactual_json(study, rows));
    if (study->stay_s > 0.0)
        json_object_set_new(configuration, "stay_s", json_real(study->stay_s));
    if (study->history_s > 0.0)
        json_object_set_new(configuration, "history_s", json_real(study->history_s));
    return take_text(configuration);
}

/* The same for every replication of a scenario and variant: they differ by their seed only, so that
 * the text is made once and a seed put in for each. */
typedef struct configuration_form {
    char *text;           /* with the seed 0; NULL: not made yet */
    size_t before, after; /* length of what stands in front of the seed; place of what follows */
    char *filled;         /* room for it with the longest seed */
} configuration_form;

static cp_status make_form(const cp_study *study, const cp_plan_rows *rows,
                           const cp_replication_row *replication, configuration_form *form,
                           cp_error *error)
{
    static const char SEED[] = ",\"seed\":";
    cp_replication_row any = *replication;
    any.seed = 0;
    form->text = configuration_text(study, rows, &any);
    form->filled = form->text != NULL ? malloc(strlen(form->text) + 24) : NULL;
    if (form->filled == NULL)
        return cp_fail_memory(error, "configuration");
    // It is the second key, behind a number: the first place that looks like it.
    form->before = (size_t)(strstr(form->text, SEED) - form->text) + strlen(SEED);
    form->after = form->before + 1;
    memcpy(form->filled, form->text, form->before);
    return CP_OK;
}

static cp_status hash_configuration(const cp_study *study, const cp_plan_rows *rows,
                                    configuration_form *form, cp_replication_row *replication,
                                    cp_error *error)
{
    if (form->text == NULL) {
        cp_status status = make_form(study, rows, replication, form, error);
        if (status != CP_OK)
            return status;
    }
    int digits = sprintf(form->filled + form->before, "%" PRIu64, replication->seed);
    strcpy(form->filled + form->before + digits, form->text + form->after);
    cp_hash_bytes(form->filled, strlen(form->filled), replication->configuration_hash);
    return CP_OK;
}

// Which replications are hashed, which is most of the work.
typedef struct hashed {
    bool all;
    const int64_t *only; /* unless all: this one; NULL: none */
} hashed;

static cp_status fill_rows(const cp_study *study, hashed which, configuration_form *forms,
                           cp_plan_rows *rows, cp_error *error)
{
    size_t total = study->scenario_count * study->variant_count * study->replications;
    rows->replication = calloc(total, sizeof *rows->replication);
    if (rows->replication == NULL)
        return cp_fail_memory(error, "replications");
    for (size_t k = 0; k < total; k++) {
        if (!is_run(study, k % study->variant_count))
            continue;
        cp_replication_row *row = &rows->replication[rows->replication_count];
        row->variant = k % study->variant_count;
        row->scenario = k / study->variant_count % study->scenario_count;
        row->number = k / study->variant_count / study->scenario_count;
        row->seed = cp_plan_seed(study, row->scenario, row->variant, row->number);
        row->id = cp_replication_row_id(study->scenarios[row->scenario].name,
                                        study->variants[row->variant].name, "", row->seed);
        cp_status status = CP_OK;
        if (which.all || (which.only != NULL && *which.only == row->id))
            status = hash_configuration(study, rows,
                                        &forms[row->scenario * study->variant_count + row->variant],
                                        row, error);
        if (status != CP_OK)
            return status;
        rows->replication_count++;
    }
    return CP_OK;
}

static cp_status fill_replications(const cp_study *study, hashed which, cp_plan_rows *rows,
                                   cp_error *error)
{
    size_t count = study->scenario_count * study->variant_count;
    configuration_form *forms = calloc(count, sizeof *forms);
    if (forms == NULL)
        return cp_fail_memory(error, "replications");
    cp_status status = fill_rows(study, which, forms, rows, error);
    for (size_t k = 0; k < count; k++) {
        free(forms[k].text);
        free(forms[k].filled);
    }
    free(forms);
    return status;
}

// ---- backgrounds ---------------------------------------------------------------------------

static bool starts_alike(const cp_scenario_row *one, const cp_scenario_row *other)
{
    return strcmp(one->sumocfg, other->sumocfg) == 0 &&
           strcmp(one->sumo_options, other->sumo_options) == 0 &&
           strcmp(one->files, other->files) == 0;
}

// of: its options and files.
static cp_status fill_background(const cp_study *study, size_t scenario, size_t number,
                                 const cp_scenario_row *of, cp_background_plan_row *row,
                                 cp_error *error)
{
    // The traffic of one of the baseline's replications, but for the errors.
    *row = (cp_background_plan_row){
        .scenario = scenario,
        .seed = cp_plan_seed(study, scenario, cp_study_baseline(study), number),
        .duration_s = study->background_s > 0.0 ? study->background_s : study->duration_s};
    char *text = take_text(json_pack(
        "{s:I, s:f, s:f, s:f, s:f, s:s, s:s}", "seed", (json_int_t)row->seed, "duration_s",
        row->duration_s, "warmup_s", study->warmup_s, "step_length_s", study->step_length_s,
        "stay_s", study->stay_s, "sumo_options", of->sumo_options, "files", of->files));
    if (text == NULL)
        return cp_fail_memory(error, "configuration");
    cp_hash_bytes(text, strlen(text), row->configuration_hash);
    free(text);
    return CP_OK;
}

static cp_status fill_backgrounds(const cp_study *study, cp_plan_rows *rows, cp_error *error)
{
    rows->background =
        calloc(study->scenario_count * study->background_seeds + 1, sizeof *rows->background);
    if (rows->background == NULL)
        return cp_fail_memory(error, "backgrounds");
    for (size_t k = 0; study->background_s > 0.0 && k < study->scenario_count; k++) {
        size_t first = 0;
        while (!starts_alike(&rows->scenario[first], &rows->scenario[k]))
            first++;
        if (first < k)
            continue;
        for (size_t number = 0; number < study->background_seeds; number++) {
            cp_status status = fill_background(study, k, number, &rows->scenario[k],
                                               &rows->background[rows->background_count], error);
            if (status != CP_OK)
                return status;
            rows->background_count++;
        }
    }
    return CP_OK;
}

// ---- public --------------------------------------------------------------------------------

cp_status cp_plan_background(const cp_study *study, size_t scenario, size_t number,
                             cp_background_plan_row *row, cp_error *error)
{
    const cp_study_scenario *given = &study->scenarios[scenario];
    const cp_scenario_inputs inputs = cp_study_scenario_inputs(given);
    cp_scenario_row of = {.sumo_options =
                              words_text(given->sumo_options, given->sumo_option_count)};
    cp_status status = of.sumo_options != NULL ? cp_scenario_files_json(&inputs, &of.files, error)
                                               : cp_fail_memory(error, "backgrounds");
    if (status == CP_OK)
        status = fill_background(study, scenario, number, &of, row, error);
    free(of.sumo_options);
    free(of.files);
    return status;
}

static cp_status create(const cp_study *study, const cp_vehicle_model_row *models,
                        size_t model_count, hashed which, cp_plan_rows *rows, cp_error *error)
{
    *rows = (cp_plan_rows){0};
    cp_status status = fill_study(study, models, &rows->study, error);
    if (status == CP_OK)
        status = fill_scenarios(study, rows, error);
    if (status == CP_OK)
        status = fill_variants(study, rows, error);
    if (status == CP_OK)
        status = fill_sweeps(study, rows, error);
    if (status == CP_OK)
        status = fill_vehicle_models(study, models, model_count, rows, error);
    if (status == CP_OK)
        status = fill_replications(study, which, rows, error);
    if (status == CP_OK)
        status = fill_backgrounds(study, rows, error);
    if (status != CP_OK)
        cp_plan_destroy(rows);
    return status;
}

cp_status cp_plan_create(const cp_study *study, const cp_vehicle_model_row *models,
                         size_t model_count, cp_plan_rows *rows, cp_error *error)
{
    return create(study, models, model_count, (hashed){.all = true}, rows, error);
}

cp_status cp_plan_create_for(const cp_study *study, const cp_vehicle_model_row *models,
                             size_t model_count, int64_t replication_id, cp_plan_rows *rows,
                             cp_error *error)
{
    return create(study, models, model_count, (hashed){.only = &replication_id}, rows, error);
}

cp_status cp_plan_create_unhashed(const cp_study *study, const cp_vehicle_model_row *models,
                                  size_t model_count, cp_plan_rows *rows, cp_error *error)
{
    return create(study, models, model_count, (hashed){0}, rows, error);
}

void cp_plan_destroy(cp_plan_rows *rows)
{
    for (size_t k = 0; k < rows->scenario_count; k++) {
        free(rows->scenario[k].name);
        free(rows->scenario[k].sumocfg);
        free(rows->scenario[k].sumo_options);
        free(rows->scenario[k].files);
        free(rows->scenario[k].driver_errors);
    }
    for (size_t k = 0; k < rows->variant_count; k++) {
        free(rows->variant[k].name);
        free(rows->variant[k].functions);
    }
    for (size_t k = 0; k < rows->sweep_count; k++) {
        free(rows->sweep[k].base);
        free(rows->sweep[k].parameter);
    }
    for (size_t k = 0; k < rows->vehicle_model_count; k++) {
        free(rows->vehicle_model[k].name);
        free(rows->vehicle_model[k].yaml);
    }
    free(rows->scenario);
    free(rows->variant);
    free(rows->sweep);
    free(rows->vehicle_model);
    free(rows->replication);
    free(rows->background);
    free(rows->study.name);
    free(rows->study.question);
    free(rows->study.vehicles);
    free(rows->study.yaml);
    *rows = (cp_plan_rows){0};
}

const cp_replication_row *cp_plan_find(const cp_plan_rows *rows, int64_t replication_id)
{
    for (size_t k = 0; k < rows->replication_count; k++)
        if (rows->replication[k].id == replication_id)
            return &rows->replication[k];
    return NULL;
}
