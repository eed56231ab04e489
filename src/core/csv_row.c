/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/csv_row.h"

#include <string.h>

char *cp_csv_next_line(char **rest)
{
    char *line = *rest, *next = strchr(line, '\n');
    if (next != NULL)
        *next++ = '\0';
    *rest = next;
    line[strcspn(line, "\r")] = '\0';
    return line;
}

size_t cp_csv_split(char *line, char **fields, size_t room)
{
    size_t count = 0;
    for (char *field = line; field != NULL; count++) {
        if (count < room)
            fields[count] = field;
        field = strchr(field, ',');
        if (field != NULL)
            *field++ = '\0';
    }
    return count;
}

cp_status cp_csv_check_fields(const char *path, size_t line_number, size_t count, size_t header,
                              cp_error *error)
{
    if (header > CP_CSV_FIELDS_MAX)
        return cp_fail(error, CP_BAD_INPUT, "%s:1: must have at most %d columns, found %zu", path,
                       CP_CSV_FIELDS_MAX, header);
    if (count == header)
        return CP_OK;
    return cp_fail(
        error, CP_BAD_INPUT,
        "%s:%zu: must have a field for each of the %zu columns, found %zu (is the decimal "
        "sign a comma?)",
        path, line_number, header, count);
}
