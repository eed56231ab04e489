/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/sumo_list.h"

#include "core/memory_stream.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char BLANKS[] = " \t\r\n\v\f";

// Value of the digits behind a '%', or -1.
static int hex_of(const char *two)
{
    if (!isxdigit((unsigned char)two[0]) || !isxdigit((unsigned char)two[1]))
        return -1;
    const char digits[] = {two[0], two[1], '\0'};
    return (int)strtol(digits, NULL, 16);
}

void cp_sumo_name_decode(char *name)
{
    char *to = name;
    for (const char *from = name; *from != '\0'; to++) {
        int code = *from == '%' ? hex_of(from + 1) : -1;
        *to = *from;
        if (code >= 0)
            *to = (char)code;
        from += code >= 0 ? 3 : 1;
    }
    *to = '\0';
}

// Text with every ${NAME} that the environment has put in; NULL when memory is gone.
static char *with_environment(const char *text)
{
    char *whole = NULL;
    size_t size = 0;
    FILE *out = cp_memory_stream(&whole, &size);
    if (out == NULL)
        return NULL;
    bool lost = false;
    while (*text != '\0') {
        size_t length = strncmp(text, "${", 2) == 0 ? strcspn(text, "}") : 0;
        bool is_name = length > 2 && text[length] == '}';
        char *name = is_name ? strndup(text + 2, length - 2) : NULL;
        lost |= is_name && name == NULL;
        const char *value = name != NULL ? getenv(name) : NULL;
        if (value != NULL)
            fputs(value, out);
        else
            fputc(*text, out);
        text += value != NULL ? length + 1 : 1;
        free(name);
    }
    lost |= fclose(out) != 0;
    if (!lost)
        return whole;
    free(whole);
    return NULL;
}

cp_status cp_sumo_list_create(const char *text, const char *what, cp_sumo_list *list,
                              cp_error *error)
{
    char *whole = with_environment(text);
    *list = (cp_sumo_list){.text = whole, .rest = whole};
    return whole != NULL ? CP_OK : cp_fail_memory(error, what);
}

void cp_sumo_list_destroy(cp_sumo_list *list)
{
    free(list->text);
    *list = (cp_sumo_list){0};
}

char *cp_sumo_list_next(cp_sumo_list *list)
{
    while (list->rest != NULL) {
        char *name = strsep(&list->rest, ",");
        name += strspn(name, BLANKS);
        size_t length = strlen(name);
        while (length > 0 && strchr(BLANKS, name[length - 1]) != NULL)
            name[--length] = '\0';
        if (*name != '\0')
            return name;
    }
    return NULL;
}
