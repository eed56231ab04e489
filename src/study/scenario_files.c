/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scenario_files.h"

#include "core/file.h"
#include "core/hash.h"

#include <ctype.h>
#include <jansson.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// The elements of a .sumocfg that name input files (SUMO's option names with their synonyms).
static const char *const INPUT_ELEMENT[] = {
    "net-file",         "net",        "n", "route-files",  "route", "r",
    "additional-files", "additional", "a", "weight-files", "w"};
#define INPUT_ELEMENT_COUNT (sizeof INPUT_ELEMENT / sizeof INPUT_ELEMENT[0])

// Cut XML comments out of text in place.
static void remove_comments(char *text)
{
    char *to = text;
    const char *from = text;
    while (*from != '\0') {
        if (strncmp(from, "<!--", 4) == 0) {
            const char *end = strstr(from + 4, "-->");
            from = end != NULL ? end + 3 : from + strlen(from);
        } else {
            *to++ = *from++;
        }
    }
    *to = '\0';
}

/* What is done with every input file: path to open, name as it was given. */
typedef cp_status visit_file(const char *path, const char *name, void *context, cp_error *error);

// Hash of one file into the object under the name it was given.
static cp_status add_file(const char *path, const char *name, void *context, cp_error *error)
{
    json_t *files = context;
    char *content = NULL;
    size_t size = 0;
    char hex[CP_HASH_TEXT_SIZE];
    cp_status status = cp_file_read(path, &content, &size, error);
    if (status != CP_OK)
        return status;
    // A file with zero bytes inside (compressed) is no XML text: all of it counts.
    if (strlen(content) == size) {
        remove_comments(content);
        size = strlen(content);
    }
    cp_hash_bytes(content, size, hex);
    free(content);
    return json_object_set_new(files, name, json_string(hex)) == 0 ? CP_OK
                                                                   : cp_fail_memory(error, name);
}

// The files of a comma-separated list, as seen from the .sumocfg.
static cp_status visit_list(visit_file *visit, void *context, const char *sumocfg_path,
                            const char *list, size_t length, cp_error *error)
{
    char *names = strndup(list, length);
    if (names == NULL)
        return cp_fail_memory(error, sumocfg_path);
    cp_status status = CP_OK;
    char *rest = NULL;
    for (char *name = strtok_r(names, ", \t\r\n", &rest); name != NULL && status == CP_OK;
         name = strtok_r(NULL, ", \t\r\n", &rest)) {
        char *path = cp_file_beside(sumocfg_path, name);
        if (path == NULL)
            status = cp_fail_memory(error, name);
        else if (access(path, R_OK) == 0)
            status = visit(path, name, context, error);
        free(path);
    }
    free(names);
    return status;
}

static bool is_input(const char *element, size_t length)
{
    for (size_t k = 0; k < INPUT_ELEMENT_COUNT; k++)
        if (strlen(INPUT_ELEMENT[k]) == length && strncmp(element, INPUT_ELEMENT[k], length) == 0)
            return true;
    return false;
}

// Value of an attribute within one tag, by its name or a synonym; NULL when it has none.
static const char *find_attribute(const char *tag, const char *tag_end, const char *attribute,
                                  const char *synonym, size_t *length)
{
    size_t long_name = strlen(attribute), short_name = strlen(synonym);
    for (const char *c = tag; c < tag_end; c++) {
        if (!isspace((unsigned char)*c))
            continue;
        while (c < tag_end && isspace((unsigned char)*c))
            c++;
        size_t name = strncmp(c, attribute, long_name) == 0  ? long_name
                      : strncmp(c, synonym, short_name) == 0 ? short_name
                                                             : 0;
        const char *quote = c + name + 1;
        if (name == 0 || c[name] != '=' || (*quote != '"' && *quote != '\''))
            continue;
        const char *end = strchr(quote + 1, *quote);
        if (end == NULL || end > tag_end)
            return NULL;
        *length = (size_t)(end - quote - 1);
        return quote + 1;
    }
    return NULL;
}

// All inputs that the text of a .sumocfg names.
static cp_status visit_inputs(visit_file *visit, void *context, const char *sumocfg_path,
                              const char *content, cp_error *error)
{
    cp_status status = CP_OK;
    for (const char *tag = strchr(content, '<'); tag != NULL && status == CP_OK;
         tag = strchr(tag + 1, '<')) {
        const char *name = tag + 1;
        size_t name_length = strcspn(name, " \t\r\n/>");
        const char *end = strchr(tag, '>');
        size_t length = 0;
        if (end == NULL || !is_input(name, name_length))
            continue;
        const char *list = find_attribute(name + name_length, end, "value", "v", &length);
        if (list != NULL)
            status = visit_list(visit, context, sumocfg_path, list, length, error);
    }
    return status;
}

static cp_status visit_scenario(visit_file *visit, void *context, const char *sumocfg_path,
                                cp_error *error)
{
    char *content = NULL;
    size_t size = 0;
    cp_status status = cp_file_read(sumocfg_path, &content, &size, error);
    if (status != CP_OK)
        return status;
    remove_comments(content);
    status = visit_inputs(visit, context, sumocfg_path, content, error);
    free(content);
    return status;
}

cp_status cp_scenario_files_json(const char *sumocfg_path, char **json, cp_error *error)
{
    json_t *files = json_object();
    const char *slash = strrchr(sumocfg_path, '/');
    cp_status status = files != NULL ? CP_OK : cp_fail_memory(error, sumocfg_path);
    if (status == CP_OK)
        status = add_file(sumocfg_path, slash != NULL ? slash + 1 : sumocfg_path, files, error);
    if (status == CP_OK)
        status = visit_scenario(add_file, files, sumocfg_path, error);
    if (status == CP_OK) {
        *json = json_dumps(files, JSON_SORT_KEYS | JSON_COMPACT);
        if (*json == NULL)
            status = cp_fail_memory(error, sumocfg_path);
    }
    json_decref(files);
    return status;
}

// ---- saved states --------------------------------------------------------------------------

const char CP_SCENARIO_NO_STATE[] =
    "must not begin with a saved state (load-state): SUMO does not put the traffic back as it was, "
    "cars collide that otherwise do not; let it build up within warmup_s";

cp_status cp_scenario_loads_no_state(const char *sumocfg_path, cp_error *error)
{
    static const char ELEMENT[] = "<load-state";
    char *content = NULL;
    size_t size = 0, length = 0;
    cp_status status = cp_file_read(sumocfg_path, &content, &size, error);
    if (status != CP_OK)
        return status;
    remove_comments(content);
    for (const char *tag = strstr(content, ELEMENT); tag != NULL && status == CP_OK;
         tag = strstr(tag + 1, ELEMENT)) {
        const char *attributes = tag + sizeof ELEMENT - 1;
        const char *end = strchr(tag, '>');
        bool is_whole_name = isspace((unsigned char)*attributes); // not load-state.offset
        if (end != NULL && is_whole_name &&
            find_attribute(attributes, end, "value", "v", &length) != NULL && length > 0)
            status = cp_fail(error, CP_BAD_INPUT, "%s: %s", sumocfg_path, CP_SCENARIO_NO_STATE);
    }
    free(content);
    return status;
}

// ---- vehicle models named by types ---------------------------------------------------------

typedef struct model_search {
    const char *sumocfg_path;
    cp_scenario_model_visit *visit;
    void *context;
} model_search;

// One <param ...> tag: the model it names, if that is what it does.
static cp_status visit_param(const model_search *search, const char *tag, const char *end,
                             cp_error *error)
{
    static const char KEY[] = "crashpulse.model";
    size_t key_length = 0, length = 0;
    const char *key = find_attribute(tag, end, "key", "key", &key_length);
    const char *value = find_attribute(tag, end, "value", "value", &length);
    if (key == NULL || value == NULL || key_length != sizeof KEY - 1 ||
        strncmp(key, KEY, key_length) != 0)
        return CP_OK;
    char *name = strndup(value, length);
    if (name == NULL)
        return cp_fail_memory(error, "vehicle types");
    cp_status status = search->visit(name, search->sumocfg_path, search->context, error);
    free(name);
    return status;
}

static cp_status visit_params(const char *path, const char *name, void *context, cp_error *error)
{
    static const char PARAM[] = "<param";
    const model_search *search = context;
    char *content = NULL;
    size_t size = 0;
    (void)name;
    cp_status status = cp_file_read(path, &content, &size, error);
    if (status != CP_OK)
        return status;
    remove_comments(content);
    for (const char *tag = strstr(content, PARAM); tag != NULL && status == CP_OK;
         tag = strstr(tag + 1, PARAM)) {
        const char *end = strchr(tag, '>');
        if (end != NULL)
            status = visit_param(search, tag + sizeof PARAM - 1, end, error);
    }
    free(content);
    return status;
}

cp_status cp_scenario_models(const char *sumocfg_path, cp_scenario_model_visit *visit,
                             void *context, cp_error *error)
{
    model_search search = {.sumocfg_path = sumocfg_path, .visit = visit, .context = context};
    return visit_scenario(visit_params, &search, sumocfg_path, error);
}
