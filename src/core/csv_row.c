/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/csv_row.h"

#include <stdbool.h>
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

char cp_csv_separator(const char *header)
{
    return strchr(header, ';') != NULL && strchr(header, ',') == NULL ? ';' : ',';
}

// A field without the blanks and the pair of quotes around it.
static char *trim(char *field)
{
    field += strspn(field, " \t");
    size_t length = strlen(field);
    while (length > 0 && strchr(" \t\r", field[length - 1]) != NULL)
        field[--length] = '\0';
    bool quoted = length >= 2 && field[0] == '"' && field[length - 1] == '"' &&
                  memchr(field + 1, '"', length - 2) == NULL;
    if (quoted)
        field[length - 1] = '\0';
    return quoted ? field + 1 : field;
}

size_t cp_csv_split(char *line, char separator, char **fields, size_t room)
{
    size_t count = 0;
    for (char *field = line; field != NULL; count++) {
        char *next = strchr(field, separator);
        if (next != NULL)
            *next++ = '\0';
        if (count < room)
            fields[count] = trim(field);
        field = next;
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
