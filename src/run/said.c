/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/said.h"

#include <search.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static int compare_lines(const void *one, const void *other)
{
    return strcmp(one, other);
}

bool cp_said_is_new(cp_said *said, const char *line)
{
    char *own = strdup(line);
    char **place = own != NULL ? tsearch(own, &said->lines, compare_lines) : NULL;
    bool is_known = place != NULL && *place != own;
    if (place == NULL || is_known)
        free(own);
    return !is_known;
}

void cp_said_destroy(cp_said *said)
{
    while (said->lines != NULL) {
        char *line = *(char **)said->lines;
        tdelete(line, &said->lines, compare_lines);
        free(line);
    }
}
