/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_YAML_LINES_H
#define CORE_YAML_LINES_H

#include "core/error.h"

#include <stddef.h>

/* The lines of a YAML file: key path, text and line of every value, in the order of the file.
 *
 * An alias (*name) stands for a copy of what its anchor (&name) marks: its values are listed under
 * the alias's own key path, each with the line where it is written, so that whoever reads values by
 * key path meets them like any other. */

/* Line of one value: path as in "variants[1].functions[0].parameters.ttc_s". */
typedef struct cp_yaml_line {
    char *path;
    char *scalar; /* text of a scalar value, NULL for a mapping or a sequence */
    size_t line;
} cp_yaml_line;

/* Lists the values of content; name names it in messages. The caller destroys what *lines then
 * holds, also after an error. Errors: CP_BAD_INPUT with name and line for an alias without an
 * anchor before it, one inside what it stands for, one in place of a key, a merge key (<<), a
 * second document, more than 64 levels, and more than 100,000 values (aliases of aliases multiply).
 * A syntax error is none: libcyaml, which reads the same, words it; lines end there. CP_NO_MEMORY.
 */
CP_MUST_CHECK cp_status cp_yaml_lines_read(const char *name, const char *content, size_t size,
                                           cp_yaml_line **lines, size_t *count, cp_error *error);
void cp_yaml_lines_destroy(cp_yaml_line *lines, size_t count);

#endif
