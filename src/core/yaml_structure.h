/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_YAML_STRUCTURE_H
#define CORE_YAML_STRUCTURE_H

#include "core/yaml_place.h"

/* Whether the values of a file are of the kinds its schema has, before libcyaml reads it:
 * libcyaml's own words for that ("Expecting MAPPING, got event: SCALAR") do not help who wrote the
 * file. */

/* Errors: CP_BAD_INPUT with file, line and key path for an unknown key (with the nearest of those
 * allowed, or all of them), a text where a list or a mapping belongs (with an example), the other
 * way round, and a list for a mapping. What else is wrong is left to libcyaml. */
CP_MUST_CHECK cp_status cp_yaml_structure_check(const cp_yaml_file *file, cp_error *error);

#endif
