/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/yaml_structure.h"

#include "core/nearest.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define KEYS_MAX 128
#define TEXT_SIZE 1024

static bool is_list(const cyaml_schema_value_t *value)
{
    return value->type == CYAML_SEQUENCE || value->type == CYAML_SEQUENCE_FIXED;
}

static bool is_scalar(const cyaml_schema_value_t *value)
{
    return value->type != CYAML_MAPPING && value->type != CYAML_IGNORE && !is_list(value);
}

// ---- words ---------------------------------------------------------------------------------

static size_t list_keys(const cyaml_schema_value_t *mapping, const char *keys[KEYS_MAX],
                        char text[TEXT_SIZE])
{
    size_t count = 0, used = 0;
    text[0] = '\0';
    for (const cyaml_schema_field_t *f = mapping->mapping.fields; f->key != NULL; f++) {
        if (count < KEYS_MAX)
            keys[count++] = f->key;
        if (used + strlen(f->key) + 3 < TEXT_SIZE)
            used += (size_t)snprintf(text + used, TEXT_SIZE - used, "%s%s", used > 0 ? ", " : "",
                                     f->key);
    }
    return count;
}

// "{function: aeb}": the value as it was probably meant, with its text as the first required key.
static void write_example(const cyaml_schema_value_t *value, const char *scalar, char *text,
                          size_t size)
{
    char inner[TEXT_SIZE] = "";
    if (is_list(value)) {
        write_example(value->sequence.entry, scalar, inner, sizeof inner);
        snprintf(text, size, "[%s]", inner);
    } else if (value->type == CYAML_MAPPING) {
        const cyaml_schema_field_t *first = value->mapping.fields;
        write_example(&first->value, scalar, inner, sizeof inner);
        snprintf(text, size, "{%s: %s}", first->key, inner);
    } else {
        snprintf(text, size, "%.60s", scalar);
    }
}

static cp_status fail_kind(const cp_yaml_file *file, const cp_yaml_line *line,
                           const cyaml_schema_value_t *value, cp_error *error)
{
    char example[TEXT_SIZE], keys[TEXT_SIZE];
    const char *names[KEYS_MAX];
    write_example(value, line->scalar, example, sizeof example);
    if (is_list(value))
        return cp_yaml_fail(file, error, line->path,
                            "must be a list, found the text '%.60s'; for example %s", line->scalar,
                            example);
    list_keys(value, names, keys);
    return cp_yaml_fail(file, error, line->path,
                        "must be a mapping with the keys %s; found the text '%.60s'; for example "
                        "%s",
                        keys, line->scalar, example);
}

static cp_status fail_key(const cp_yaml_file *file, const cp_yaml_line *line,
                          const cyaml_schema_value_t *mapping, const char *key, cp_error *error)
{
    char keys[TEXT_SIZE], meant[CP_NEAREST_TEXT_SIZE];
    const char *names[KEYS_MAX];
    size_t count = list_keys(mapping, names, keys);
    cp_nearest_text(key, names, count, meant);
    if (meant[0] != '\0')
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: Unexpected key: %s%s", file->path, line->line,
                       key, meant);
    return cp_fail(error, CP_BAD_INPUT, "%s:%zu: Unexpected key: %s; allowed are %s", file->path,
                   line->line, key, keys);
}

// ---- the walk ------------------------------------------------------------------------------

static const cyaml_schema_value_t *field_of(const cyaml_schema_value_t *mapping, const char *key,
                                            size_t length)
{
    for (const cyaml_schema_field_t *f = mapping->mapping.fields; f->key != NULL; f++)
        if (strlen(f->key) == length && strncmp(f->key, key, length) == 0)
            return &f->value;
    return NULL;
}

// What the schema has at a key path. NULL: nothing to be said of it, or an unknown key, which is
// then *unknown, of the mapping *within.
static const cyaml_schema_value_t *value_at(const cyaml_schema_value_t *value, const char *path,
                                            char unknown[256], const cyaml_schema_value_t **within)
{
    unknown[0] = '\0';
    while (*path != '\0' && value->type != CYAML_IGNORE) {
        if (*path == '[' && is_list(value)) {
            const char *end = strchr(path, ']');
            if (end == NULL) // of a key with a bracket in it
                return NULL;
            value = value->sequence.entry;
            path = end + 1;
        } else if (*path != '[' && value->type == CYAML_MAPPING) {
            path += *path == '.';
            size_t length = strcspn(path, ".[");
            *within = value;
            value = field_of(value, path, length);
            if (value == NULL) {
                snprintf(unknown, 256, "%.*s", (int)length, path);
                return NULL;
            }
            path += length;
        } else {
            return NULL; // told at its parent
        }
    }
    return value->type == CYAML_IGNORE ? NULL : value;
}

cp_status cp_yaml_structure_check(const cp_yaml_file *file, cp_error *error)
{
    for (size_t k = 0; k < file->line_count; k++) {
        const cp_yaml_line *line = &file->lines[k];
        const cyaml_schema_value_t *within = file->schema;
        char unknown[256];
        const cyaml_schema_value_t *value = value_at(file->schema, line->path, unknown, &within);
        if (value == NULL && unknown[0] != '\0')
            return fail_key(file, line, within, unknown, error);
        if (value == NULL)
            continue;
        // The values of a collection follow it.
        size_t length = strlen(line->path);
        bool has_child = line->scalar == NULL && k + 1 < file->line_count &&
                         strncmp(file->lines[k + 1].path, line->path, length) == 0;
        char next = '\0';
        if (has_child)
            next = file->lines[k + 1].path[length];
        if (next != '.' && next != '[')
            next = '\0';
        if (line->scalar != NULL && line->scalar[0] != '\0' && !is_scalar(value) && length > 0)
            return fail_kind(file, line, value, error);
        if (line->scalar == NULL && is_scalar(value))
            return cp_yaml_fail(file, error, line->path,
                                "must be a text or a number, found a list or a mapping");
        if (value->type == CYAML_MAPPING && next == '[' && length > 0)
            return cp_yaml_fail(file, error, line->path, "must be a mapping, found a list");
        if (is_list(value) && line->scalar == NULL && next == '\0' && value->sequence.min > 0)
            return cp_yaml_fail(file, error, line->path, "must be a list of at least one entry");
        if (is_list(value) && next == '.' && length > 0)
            return cp_yaml_fail(file, error, line->path,
                                "must be a list ('- ' in front of each of its entries), found a "
                                "mapping");
    }
    return CP_OK;
}
