/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_YAML_STRUCTURE_H
#define CORE_YAML_STRUCTURE_H

#include "core/yaml_lines.h"

#include <cyaml/cyaml.h>

/* Whether the values of a file are of the kinds its schema has, before libcyaml reads it:
 * libcyaml's own words for that ("Expecting MAPPING, got event: SCALAR") do not help who wrote the
 * file. */

/* lines: of the file called name (core/yaml_lines.h). Errors: CP_BAD_INPUT with file, line and key
 * path for an unknown key (with the nearest of those allowed, or all of them), a text where a list
 * or a mapping belongs (with an example), the other way round, and a list for a mapping. What else
 * is wrong is left to libcyaml. */
CP_MUST_CHECK cp_status cp_yaml_structure_check(const char *name, const cp_yaml_line *lines,
                                                size_t count, const cyaml_schema_value_t *schema,
                                                cp_error *error);

#endif
