/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scenario_outputs.h"

#include "core/array.h"
#include "core/file.h"
#include "core/output_files.h"
#include "study/scenario_walk.h"
#include "study/sumo_list.h"

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char CONNECTS[] = "SUMO would open a connection";
static const char LEAVES[] = "it is outside the folder of the .sumocfg";
static const char NO_FILE[] = "it is there and no regular file";
static const char SCHEMAS[] = "SUMO would fetch schemas from where the files say";
static const char SWARM[] = "this kind of traffic light writes a log where SUMO is started";

// ---- one name ------------------------------------------------------------------------------

// What SUMO takes for its own streams and for nothing at all: they go nowhere.
static bool is_nowhere(const char *name)
{
    static const char *const NAME[] = {"stdout", "STDOUT", "-",   "stderr",
                                       "STDERR", "nul",    "NUL", "/dev/null"};
    for (size_t k = 0; k < sizeof NAME / sizeof *NAME; k++)
        if (strcmp(name, NAME[k]) == 0)
            return true;
    return false;
}

// SUMO takes host:port for a connection.
static bool is_connection(const char *name)
{
    return strchr(name, ':') != NULL;
}

// The folder that a path names a file in, links followed; false: there is none yet.
static bool real_folder(const char *path, char folder[PATH_MAX])
{
    char *place = cp_file_beside(path, ".");
    bool found = place != NULL && realpath(place, folder) != NULL;
    free(place);
    return found;
}

// Why a file must not be written, NULL if it may. A folder that is not there leads nowhere, but by
// "..": SUMO will say so.
static const char *judge_path(const char *path, const char *own_folder)
{
    char folder[PATH_MAX];
    struct stat status;
    if (!real_folder(path, folder))
        return cp_path_has_parent_step(path) ? LEAVES : NULL;
    size_t length = strlen(own_folder);
    bool is_below = strncmp(folder, own_folder, length) == 0 &&
                    (folder[length] == '\0' || folder[length] == '/' || length == 1);
    if (!is_below)
        return LEAVES;
    bool is_there = lstat(path, &status) == 0;
    return is_there && !S_ISREG(status.st_mode) ? NO_FILE : NULL;
}

// ---- the list ------------------------------------------------------------------------------

typedef struct search {
    const cp_sumo_configuration *configuration;
    char folder[PATH_MAX]; /* of the .sumocfg */
    cp_scenario_outputs *found;
} search;

static cp_status add(search *s, const char *place, const char *name, const char *why,
                     cp_error *error)
{
    cp_scenario_outputs *found = s->found;
    cp_scenario_output *output = cp_array_add(found->output, found->count);
    if (output == NULL)
        return cp_fail_memory(error, place);
    *output = (cp_scenario_output){.place = strdup(place), .name = strdup(name), .why = why};
    return output->place != NULL && output->name != NULL ? CP_OK : cp_fail_memory(error, place);
}

// A name as seen from a file (NULL: from the working folder), as it is and without %20 and the
// like, which SUMO undoes in some places.
static cp_status add_name(search *s, const char *place, const char *name, const char *base,
                          cp_error *error)
{
    const char *why = is_connection(name) ? CONNECTS : NULL;
    char *decoded = strdup(name);
    cp_status status = decoded != NULL ? CP_OK : cp_fail_memory(error, place);
    if (status == CP_OK)
        cp_sumo_name_decode(decoded);
    for (int k = 0; status == CP_OK && k < 2 && why == NULL; k++) {
        const char *form = k == 0 ? name : decoded;
        if (is_nowhere(form))
            continue;
        char *path = base != NULL ? cp_file_beside(base, form) : strdup(form);
        if (path == NULL)
            status = cp_fail_memory(error, place);
        else
            why = is_connection(form) ? CONNECTS : judge_path(path, s->folder);
        free(path);
    }
    free(decoded);
    return status == CP_OK ? add(s, place, name, why, error) : status;
}

// Every name of a list, as SUMO splits it.
static cp_status add_names(search *s, const char *place, const char *names, const char *base,
                           cp_error *error)
{
    cp_sumo_list list;
    cp_status status = cp_sumo_list_create(names, place, &list, error);
    for (const char *name = NULL; status == CP_OK && (name = cp_sumo_list_next(&list)) != NULL;)
        status = add_name(s, place, name, base, error);
    cp_sumo_list_destroy(&list);
    return status;
}

// ---- options -------------------------------------------------------------------------------

static bool fetches_schemas(const cp_sumo_setting *setting)
{
    return strncmp(setting->option->name, "xml-validation", strlen("xml-validation")) == 0 &&
           strcmp(setting->value, "never") != 0 && strcmp(setting->value, "local") != 0;
}

static cp_status add_option(search *s, const cp_sumo_setting *setting, cp_error *error)
{
    char place[1024];
    const char *base = setting->line > 0 ? s->configuration->path : NULL;
    cp_sumo_setting_place(s->configuration, setting, place, sizeof place);
    if (fetches_schemas(setting))
        return add(s, place, setting->value, SCHEMAS, error);
    if (setting->option->kind == CP_SUMO_INPUT && strstr(setting->value, "://") != NULL)
        return add(s, place, setting->value, CONNECTS, error);
    if (setting->option->kind != CP_SUMO_OUTPUT)
        return CP_OK;
    // Files of devices are seen from the .sumocfg, whoever names them.
    if (strncmp(setting->option->name, "device.", strlen("device.")) == 0 &&
        strstr(setting->option->name, ".file") != NULL)
        base = s->configuration->path;
    return add_names(s, place, setting->value, base, error);
}

// One of the .sumocfg that the words set anew does not hold.
static bool is_set_anew(const cp_sumo_configuration *configuration, const cp_sumo_setting *setting)
{
    const cp_sumo_setting *first = cp_sumo_configuration_find(configuration, setting->option->name);
    return setting->line > 0 && first->line == 0;
}

// ---- files ---------------------------------------------------------------------------------

static cp_status add_of_file(const cp_input_file *file, const char *name, void *context,
                             cp_error *error)
{
    search *s = context;
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < file->output_count; k++) {
        char place[1024];
        const cp_input_output *output = &file->outputs[k];
        snprintf(place, sizeof place, "%s:%zu: %s", name, output->line, output->what);
        if (output->line == 0)
            snprintf(place, sizeof place, "%s: %s", name, output->what);
        bool is_swarm = strcmp(output->name, "swarm") == 0 && strchr(output->what, '<') != NULL;
        status = is_swarm ? add(s, place, output->name, SWARM, error)
                          : add_name(s, place, output->name, file->path, error);
        // A device's file is seen from the .sumocfg.
        if (status == CP_OK && s->found->output[s->found->count - 1].why == NULL &&
            strncmp(output->what, "device.", strlen("device.")) == 0) {
            s->found->count--;
            free(s->found->output[s->found->count].place);
            free(s->found->output[s->found->count].name);
            status = add_name(s, place, output->name, s->configuration->path, error);
        }
    }
    return status;
}

// ---- public --------------------------------------------------------------------------------

cp_status cp_scenario_outputs_find(const cp_scenario_inputs *inputs, cp_scenario_outputs *outputs,
                                   cp_error *error)
{
    static const cp_input_search OUTPUTS = {.outputs = true};
    cp_sumo_configuration configuration = {0};
    search s = {.configuration = &configuration, .found = outputs};
    *outputs = (cp_scenario_outputs){0};
    cp_status status = cp_sumo_configuration_read(inputs->sumocfg_path, inputs->words,
                                                  inputs->word_count, &configuration, error);
    if (status == CP_OK && !real_folder(inputs->sumocfg_path, s.folder))
        status =
            cp_fail(error, CP_BAD_INPUT, "%s: its folder cannot be found", inputs->sumocfg_path);
    for (size_t k = 0; status == CP_OK && k < configuration.count; k++) {
        const cp_sumo_setting *setting = &configuration.setting[k];
        if (setting->option != NULL && !is_set_anew(&configuration, setting))
            status = add_option(&s, setting, error);
    }
    if (status == CP_OK)
        status = cp_scenario_walk(&configuration, &OUTPUTS, add_of_file, &s, error);
    cp_sumo_configuration_destroy(&configuration);
    return status;
}

void cp_scenario_outputs_destroy(cp_scenario_outputs *outputs)
{
    for (size_t k = 0; k < outputs->count; k++) {
        free(outputs->output[k].place);
        free(outputs->output[k].name);
    }
    free(outputs->output);
    *outputs = (cp_scenario_outputs){0};
}

cp_status cp_scenario_outputs_check(const cp_scenario_inputs *inputs, cp_error *error)
{
    cp_scenario_outputs outputs = {0};
    cp_status status = cp_scenario_outputs_find(inputs, &outputs, error);
    for (size_t k = 0; status == CP_OK && k < outputs.count; k++)
        if (outputs.output[k].why != NULL)
            status =
                cp_fail(error, CP_BAD_INPUT,
                        "%s must be a file in the folder of the .sumocfg or below, found '%s': "
                        "%s; --allow-sumo-outputs lets SUMO do that",
                        outputs.output[k].place, outputs.output[k].name, outputs.output[k].why);
    cp_scenario_outputs_destroy(&outputs);
    return status;
}
