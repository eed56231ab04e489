/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scenario_walk.h"

#include "core/file.h"
#include "study/sumo_list.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// ---- the walk ------------------------------------------------------------------------------

typedef struct walk {
    cp_scenario_visit *visit;
    void *context;
    const cp_input_search *search;
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
    cp_status status = cp_input_file_read(path, w->search, &file, error);
    if (status == CP_OK)
        status = w->visit(&file, name, w->context, error);
    if (status == CP_OK)
        status = walk_included(w, &file, name, error);
    cp_input_file_destroy(&file);
    return status;
}

// One name of a list.
static cp_status walk_name(walk *w, const cp_sumo_configuration *configuration,
                           const cp_sumo_setting *setting, char *name, cp_error *error)
{
    static const char OPTIONS[] = "sumo_options: ";
    bool is_of_file = setting->line > 0;
    if (is_of_file)
        cp_sumo_name_decode(name);
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
    cp_sumo_list list;
    cp_status status = cp_sumo_list_create(setting->value, setting->name, &list, error);
    for (char *name = NULL; status == CP_OK && (name = cp_sumo_list_next(&list)) != NULL;)
        status = walk_name(w, configuration, setting, name, error);
    cp_sumo_list_destroy(&list);
    return status;
}

// An option of the .sumocfg that one of the words sets anew names no file that is opened.
static bool holds(const cp_sumo_configuration *configuration, const cp_sumo_setting *setting)
{
    return setting->option != NULL && setting->option->kind == CP_SUMO_INPUT &&
           cp_sumo_configuration_find(configuration, setting->option->name) == setting;
}

cp_status cp_scenario_walk(const cp_sumo_configuration *configuration,
                           const cp_input_search *search, cp_scenario_visit *visit, void *context,
                           cp_error *error)
{
    walk w = {.visit = visit, .context = context, .search = search, .seen = json_object()};
    cp_status status = w.seen != NULL ? CP_OK : cp_fail_memory(error, configuration->path);
    for (size_t k = 0; status == CP_OK && k < configuration->count; k++)
        if (holds(configuration, &configuration->setting[k]))
            status = walk_list(&w, configuration, &configuration->setting[k], error);
    json_decref(w.seen);
    return status;
}
