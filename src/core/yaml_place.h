/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_YAML_PLACE_H
#define CORE_YAML_PLACE_H

#include "core/yaml_lines.h"

#include <cyaml/cyaml.h>

/* A YAML file once its lines are known (yaml_file.h loads it), and messages that name a place in
 * it. */

/* A loaded file; zero-initialise, load, close. */
typedef struct cp_yaml_file {
    char *path;
    cyaml_data_t *data;
    const cyaml_schema_value_t *schema;
    cp_yaml_line *lines;
    size_t line_count;
} cp_yaml_file;

/* Line of a key path, or of its nearest parent that exists; 1 at worst. */
size_t cp_yaml_line_of(const cp_yaml_file *file, const char *key_path);

/* "path:line: key_path message" as CP_BAD_INPUT. */
cp_status cp_yaml_fail(const cp_yaml_file *file, cp_error *error, const char *key_path,
                       const char *format, ...) __attribute__((format(printf, 4, 5)));

#endif
