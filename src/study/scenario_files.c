/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scenario_files.h"

#include "core/file.h"
#include "core/hash.h"
#include "study/input_file.h"
#include "study/sumo_configuration.h"

#include <ctype.h>
#include <jansson.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// ---- names ---------------------------------------------------------------------------------

// Value of the digits behind a '%', or -1.
static int hex_of(const char *two)
{
    if (!isxdigit((unsigned char)two[0]) || !isxdigit((unsigned char)two[1]))
        return -1;
    const char digits[] = {two[0], two[1], '\0'};
    return (int)strtol(digits, NULL, 16);
}

// %20 and the like in place, as SUMO takes them in names of a .sumocfg.
static void decode(char *name)
{
    char *to = name;
    for (const char *from = name; *from != '\0'; to++) {
        int code = *from == '%' ? hex_of(from + 1) : -1;
        *to = code >= 0 ? (char)code : *from;
        from += code >= 0 ? 3 : 1;
    }
    *to = '\0';
}

// Text with every ${NAME} that the environment has put in; NULL when memory is gone.
static char *with_environment(const char *text)
{
    char *whole = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&whole, &size);
    if (out == NULL)
        return NULL;
    while (*text != '\0') {
        size_t length = strncmp(text, "${", 2) == 0 ? strcspn(text, "}") : 0;
        char *name = length > 2 && text[length] == '}' ? strndup(text + 2, length - 2) : NULL;
        const char *value = name != NULL ? getenv(name) : NULL;
        if (value != NULL)
            fputs(value, out);
        else
            fputc(*text, out);
        text += value != NULL ? length + 1 : 1;
        free(name);
    }
    return fclose(out) == 0 ? whole : NULL;
}

// ---- the walk ------------------------------------------------------------------------------

// What is done with every file, once: path to open, name for people, what was found in it.
typedef cp_status visit_file(const cp_input_file *file, const char *name, void *context,
                             cp_error *error);

typedef struct walk {
    visit_file *visit;
    void *context;
    cp_input_wanted wanted;
    json_t *seen; /* {name: true} */
} walk;

static cp_status walk_file(walk *w, const char *path, const char *name, cp_error *error);

static cp_status walk_included(walk *w, const cp_input_file *file, const char *name,
                               cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < file->include_count; k++) {
        char *path = cp_file_beside(file->path, file->includes[k]);
        char *full_name = cp_file_beside(name, file->includes[k]);
        status = path != NULL && full_name != NULL ? walk_file(w, path, full_name, error)
                                                   : cp_fail_memory(error, name);
        free(full_name);
        free(path);
    }
    return status;
}

static cp_status walk_file(walk *w, const char *path, const char *name, cp_error *error)
{
    cp_input_file file = {0};
    if (json_object_get(w->seen, name) != NULL || access(path, R_OK) != 0)
        return CP_OK;
    if (json_object_set_new(w->seen, name, json_true()) != 0)
        return cp_fail_memory(error, name);
    cp_status status = cp_input_file_read(path, &w->wanted, &file, error);
    if (status == CP_OK)
        status = w->visit(&file, name, w->context, error);
    if (status == CP_OK)
        status = walk_included(w, &file, name, error);
    cp_input_file_destroy(&file);
    return status;
}

// One name of a list, blanks around it cut off.
static cp_status walk_name(walk *w, const cp_sumo_configuration *configuration,
                           const cp_sumo_setting *setting, char *name, cp_error *error)
{
    static const char OPTIONS[] = "sumo_options: ";
    bool is_of_file = setting->line > 0;
    if (is_of_file)
        decode(name);
    char *path = is_of_file ? cp_file_beside(configuration->path, name) : strdup(name);
    char *full_name = malloc(sizeof OPTIONS + strlen(name));
    cp_status status = CP_OK;
    if (path == NULL || full_name == NULL) {
        status = cp_fail_memory(error, name);
    } else {
        strcpy(full_name, is_of_file ? "" : OPTIONS);
        strcat(full_name, name);
        status = walk_file(w, path, full_name, error);
    }
    free(full_name);
    free(path);
    return status;
}

static cp_status walk_list(walk *w, const cp_sumo_configuration *configuration,
                           const cp_sumo_setting *setting, cp_error *error)
{
    char *list = with_environment(setting->value), *rest = NULL;
    cp_status status = list != NULL ? CP_OK : cp_fail_memory(error, setting->name);
    for (char *name = list != NULL ? strtok_r(list, ",", &rest) : NULL;
         name != NULL && status == CP_OK; name = strtok_r(NULL, ",", &rest)) {
        size_t length = strlen(name);
        while (length > 0 && isspace((unsigned char)name[length - 1]))
            name[--length] = '\0';
        name += strspn(name, " \t\r\n");
        if (*name != '\0')
            status = walk_name(w, configuration, setting, name, error);
    }
    free(list);
    return status;
}

// An option of the .sumocfg that one of the words sets anew names no file that is opened.
static bool holds(const cp_sumo_configuration *configuration, const cp_sumo_setting *setting)
{
    return setting->option != NULL && setting->option->kind == CP_SUMO_INPUT &&
           cp_sumo_configuration_find(configuration, setting->option->name) == setting;
}

static cp_status walk_inputs(walk *w, const cp_scenario_inputs *inputs, cp_error *error)
{
    cp_sumo_configuration configuration = {0};
    w->seen = json_object();
    cp_status status = w->seen != NULL ? CP_OK : cp_fail_memory(error, inputs->sumocfg_path);
    if (status == CP_OK)
        status = cp_sumo_configuration_read(inputs->sumocfg_path, inputs->words, inputs->word_count,
                                            &configuration, error);
    for (size_t k = 0; status == CP_OK && k < configuration.count; k++)
        if (holds(&configuration, &configuration.setting[k]))
            status = walk_list(w, &configuration, &configuration.setting[k], error);
    cp_sumo_configuration_destroy(&configuration);
    json_decref(w->seen);
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
    walk w = {.visit = add_hash, .context = files};
    cp_input_file own = {0};
    const char *slash = strrchr(path, '/');
    cp_status status = files != NULL ? CP_OK : cp_fail_memory(error, path);
    if (status == CP_OK)
        status = cp_input_file_read(path, &w.wanted, &own, error);
    if (status == CP_OK)
        status = add_hash(&own, slash != NULL ? slash + 1 : path, files, error);
    if (status == CP_OK)
        status = walk_inputs(&w, inputs, error);
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
    walk w = {.visit = visit_models, .context = &search, .wanted.key = "crashpulse.model"};
    return walk_inputs(&w, inputs, error);
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
    walk w = {.visit = add_types, .context = types, .wanted.types = true};
    return walk_inputs(&w, inputs, error);
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
    walk w = {.visit = note_occasions, .context = occasions};
    return walk_inputs(&w, inputs, error);
}
