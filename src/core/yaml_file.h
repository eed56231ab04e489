/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_YAML_FILE_H
#define CORE_YAML_FILE_H

#include "core/yaml_place.h"

#include <stdbool.h>

/* Loading a YAML file with libcyaml, with every message naming file and line.
 *
 * libcyaml checks structure (unknown, duplicate, missing keys, syntax); numbers are declared as
 * strings in its schemas and converted here (whole text, finite, in range), because libcyaml
 * itself takes nan and 1.5garbage. A second pass with libyaml remembers the line of every key
 * path, so that range messages can name it. */

/* Load path by schema (kept by reference). An empty file is an error too. Errors: CP_BAD_INPUT
 * "file:line: what". On failure the file is closed already. */
CP_MUST_CHECK cp_status cp_yaml_load(const char *path, const cyaml_schema_value_t *schema,
                                     cp_yaml_file *file, cp_error *error);
/* The same from memory; name stands for the path in messages. */
CP_MUST_CHECK cp_status cp_yaml_parse(const char *name, const char *content, size_t size,
                                      const cyaml_schema_value_t *schema, cp_yaml_file *file,
                                      cp_error *error);
void cp_yaml_close(cp_yaml_file *file);

/* Convert text (may be NULL when optional: *value keeps its default) to a finite number within
 * [smallest, largest]; message with key path and line otherwise. */
CP_MUST_CHECK cp_status cp_yaml_number(const cp_yaml_file *file, const char *key_path,
                                       const char *text, double smallest, double largest,
                                       double *value, cp_error *error);

/* Whole text as a finite number; false when it is not one. */
bool cp_parse_number(const char *text, double *value);

#endif
