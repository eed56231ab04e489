/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scenario_files.h"

#include "core/hash.h"
#include "study/scenario_walk.h"

#include <jansson.h>
#include <string.h>

static cp_status walk_inputs(const cp_scenario_inputs *inputs, const cp_input_search *search,
                             cp_scenario_visit *visit, void *context, cp_error *error)
{
    cp_sumo_configuration configuration = {0};
    cp_status status = cp_sumo_configuration_read(inputs->sumocfg_path, inputs->words,
                                                  inputs->word_count, &configuration, error);
    if (status == CP_OK)
        status = cp_scenario_walk(&configuration, search, visit, context, error);
    cp_sumo_configuration_destroy(&configuration);
    return status;
}

// ---- hashes --------------------------------------------------------------------------------

static cp_status add_hash(const cp_input_file *file, const char *name, void *context,
                          cp_error *error)
{
    json_t *files = context;
    return json_object_set_new(files, name, json_string(file->hash)) == 0
               ? CP_OK
               : cp_fail_memory(error, name);
}

cp_status cp_scenario_files_json(const cp_scenario_inputs *inputs, char **json, cp_error *error)
{
    const char *path = inputs->sumocfg_path;
    json_t *files = json_object();
    const cp_input_search hashes = {.hash = true};
    cp_input_file own = {0};
    const char *slash = strrchr(path, '/');
    cp_status status = files != NULL ? CP_OK : cp_fail_memory(error, path);
    if (status == CP_OK)
        status = cp_input_file_read(path, &hashes, &own, error);
    if (status == CP_OK)
        status = add_hash(&own, slash != NULL ? slash + 1 : path, files, error);
    if (status == CP_OK)
        status = walk_inputs(inputs, &hashes, add_hash, files, error);
    if (status == CP_OK) {
        *json = json_dumps(files, JSON_SORT_KEYS | JSON_COMPACT);
        if (*json == NULL)
            status = cp_fail_memory(error, path);
    }
    cp_input_file_destroy(&own);
    json_decref(files);
    return status;
}

// ---- vehicle models named by types ---------------------------------------------------------

typedef struct model_search {
    const char *sumocfg_path;
    cp_scenario_model_visit *visit;
    void *context;
} model_search;

static cp_status visit_models(const cp_input_file *file, const char *name, void *context,
                              cp_error *error)
{
    const model_search *search = context;
    cp_status status = CP_OK;
    (void)name;
    for (size_t k = 0; status == CP_OK && k < file->value_count; k++)
        status = search->visit(file->values[k], search->sumocfg_path, search->context, error);
    return status;
}

cp_status cp_scenario_models(const cp_scenario_inputs *inputs, cp_scenario_model_visit *visit,
                             void *context, cp_error *error)
{
    model_search search = {
        .sumocfg_path = inputs->sumocfg_path, .visit = visit, .context = context};
    const cp_input_search models = {.key = "crashpulse.model"};
    return walk_inputs(inputs, &models, visit_models, &search, error);
}

// ---- vehicle types -------------------------------------------------------------------------

static cp_status add_types(const cp_input_file *file, const char *name, void *context,
                           cp_error *error)
{
    json_t *types = context;
    (void)name;
    for (size_t k = 0; k < file->type_count; k++)
        if (json_object_set_new(types, file->types[k], json_true()) != 0)
            return cp_fail_memory(error, "vehicle types");
    return CP_OK;
}

cp_status cp_scenario_types_add(const cp_scenario_inputs *inputs, json_t *types, cp_error *error)
{
    const cp_input_search search = {.types = true};
    return walk_inputs(inputs, &search, add_types, types, error);
}

// ---- occasions -----------------------------------------------------------------------------

static cp_status note_occasions(const cp_input_file *file, const char *name, void *context,
                                cp_error *error)
{
    cp_scenario_occasions *occasions = context;
    (void)name;
    (void)error;
    occasions->has_lights |= file->has_lights;
    occasions->has_opposite |= file->has_opposite;
    return CP_OK;
}

cp_status cp_scenario_occasions_find(const cp_scenario_inputs *inputs,
                                     cp_scenario_occasions *occasions, cp_error *error)
{
    *occasions = (cp_scenario_occasions){0};
    const cp_input_search nothing = {0};
    return walk_inputs(inputs, &nothing, note_occasions, occasions, error);
}
