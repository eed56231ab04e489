/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/csv_row.h"

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
    for (char *field = line; field != NULL && count < room; count++) {
        fields[count] = field;
        field = strchr(field, ',');
        if (field != NULL)
            *field++ = '\0';
    }
    return count;
}
