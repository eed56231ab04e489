/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/yaml_place.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

size_t cp_yaml_line_of(const cp_yaml_file *file, const char *key_path)
{
    // The entry whose path is the longest beginning of key_path that ends at a path boundary.
    size_t best_length = 0, best_line = 1;
    for (size_t k = 0; k < file->line_count; k++) {
        size_t length = strlen(file->lines[k].path);
        bool begins = strncmp(file->lines[k].path, key_path, length) == 0;
        char next = key_path[begins ? length : 0];
        if (begins && length > best_length && (next == '\0' || next == '.' || next == '[')) {
            best_length = length;
            best_line = file->lines[k].line;
        }
    }
    return best_line;
}

cp_status cp_yaml_fail(const cp_yaml_file *file, cp_error *error, const char *key_path,
                       const char *format, ...)
{
    char message[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return cp_fail(error, CP_BAD_INPUT, "%s:%zu: %s %s", file->path,
                   cp_yaml_line_of(file, key_path), key_path, message);
}
