/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/control_section.h"

#include "control/control_types.h"
#include "core/array.h"
#include "core/nearest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define KEY_PATH_SIZE 512
#define NAMES_SIZE 1024
#define NAMES_MAX 64

// "a, b, c" of the names that would have been right.
static void append_name(char names[NAMES_SIZE], const char *name)
{
    size_t used = strlen(names);
    snprintf(names + used, NAMES_SIZE - used, "%s%s", used > 0 ? ", " : "", name);
}

static cp_status fail_unknown_control(const cp_yaml_file *file, cp_control_kind kind,
                                      const char *key_path, const char *name, cp_error *error)
{
    char names[NAMES_SIZE] = "", meant[CP_NEAREST_TEXT_SIZE];
    const char *list[NAMES_MAX];
    size_t count = 0;
    for (size_t k = 0; k < CP_CONTROL_TYPE_COUNT; k++) {
        if (CP_CONTROL_TYPE[k]->kind != kind)
            continue;
        append_name(names, CP_CONTROL_TYPE[k]->name);
        if (count < NAMES_MAX)
            list[count++] = CP_CONTROL_TYPE[k]->name;
    }
    return cp_yaml_fail(file, error, key_path, "must be one of %s; found '%s'%s", names, name,
                        cp_nearest_text(name, list, count, meant));
}

static cp_status fail_unknown_parameter(const cp_yaml_file *file, const cp_control_type *type,
                                        const char *key_path, cp_error *error)
{
    char names[NAMES_SIZE] = "", meant[CP_NEAREST_TEXT_SIZE];
    const char *list[CP_CONTROL_PARAMETERS_MAX];
    for (size_t k = 0; k < type->parameter_count; k++) {
        append_name(names, type->parameters[k].name);
        list[k] = type->parameters[k].name;
    }
    const char *dot = strrchr(key_path, '.');
    cp_nearest_text(dot != NULL ? dot + 1 : key_path, list, type->parameter_count, meant);
    return cp_yaml_fail(file, error, key_path, "is not a parameter of %s; it has %s%s", type->name,
                        names[0] != '\0' ? names : "none", meant);
}

// A parameter of a library: nothing is known of it but that it is given once.
static cp_status keep_parameter(const cp_yaml_file *file, const cp_yaml_line *line,
                                const char *name, cp_library *library, cp_error *error)
{
    for (size_t k = 0; k < library->given_count; k++)
        if (strcmp(library->given[k].name, name) == 0)
            return cp_yaml_fail(file, error, line->path, "is given twice");
    if (line->scalar == NULL)
        return cp_yaml_fail(file, error, line->path,
                            "must be a number or text, found a list or mapping");
    cp_library_parameter *given = cp_array_add(library->given, library->given_count);
    if (given == NULL)
        return cp_fail_memory(error, name);
    char *end = NULL;
    *given = (cp_library_parameter){.name = strdup(name), .text = strdup(line->scalar)};
    given->number = strtod(line->scalar, &end);
    if (end == line->scalar || *end != '\0' || !isfinite(given->number))
        given->number = NAN;
    return given->name != NULL && given->text != NULL ? CP_OK : cp_fail_memory(error, name);
}

static cp_status read_parameter(const cp_yaml_file *file, const cp_yaml_line *line,
                                const char *name, cp_control_settings *settings,
                                bool seen[CP_CONTROL_PARAMETERS_MAX], cp_error *error)
{
    const cp_control_type *type = settings->type;
    size_t index = 0;
    while (index < type->parameter_count && strcmp(type->parameters[index].name, name) != 0)
        index++;
    if (index == type->parameter_count && settings->library != NULL)
        return keep_parameter(file, line, name, settings->library, error);
    if (index == type->parameter_count)
        return fail_unknown_parameter(file, type, line->path, error);
    if (seen[index])
        return cp_yaml_fail(file, error, line->path, "is given twice");
    if (line->scalar == NULL)
        return cp_yaml_fail(file, error, line->path, "must be a number, found a list or mapping");
    seen[index] = true;
    return cp_yaml_number(file, line->path, line->scalar, type->parameters[index].smallest,
                          type->parameters[index].largest, &settings->parameter[index], error);
}

cp_status cp_control_section_read(const cp_yaml_file *file, cp_control_kind kind,
                                  const char *entry_path, const char *name_key, const char *name,
                                  cp_control_settings *settings, cp_error *error)
{
    char path[KEY_PATH_SIZE];
    bool seen[CP_CONTROL_PARAMETERS_MAX] = {false};
    snprintf(path, sizeof path, "%s.%s", entry_path, name_key);
    const cp_control_type *type = cp_control_type_find(kind, name);
    if (type == NULL)
        return fail_unknown_control(file, kind, path, name, error);
    *settings = cp_control_settings_default(type);
    if (type == &CP_CONTROL_PLUGIN &&
        (settings->library = calloc(1, sizeof *settings->library)) == NULL)
        return cp_fail_memory(error, path);

    // Every line below <entry>.parameters is one parameter; that key itself may be empty.
    snprintf(path, sizeof path, "%s.parameters", entry_path);
    size_t length = strlen(path);
    for (size_t k = 0; k < file->line_count; k++) {
        const cp_yaml_line *line = &file->lines[k];
        if (strncmp(line->path, path, length) != 0)
            continue;
        const char *rest = line->path + length;
        bool is_list = rest[0] == '[';
        bool is_text = rest[0] == '\0' && line->scalar != NULL && line->scalar[0] != '\0';
        if (is_list || is_text)
            return cp_yaml_fail(file, error, path, "must be a mapping of parameters to numbers");
        if (rest[0] != '.')
            continue;
        cp_status status = read_parameter(file, line, rest + 1, settings, seen, error);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}
