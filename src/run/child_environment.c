/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/child_environment.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define TUNABLES "GLIBC_TUNABLES="
#define HUGE_PAGES "glibc.malloc.hugetlb"

// The first text is the one we own.
static char *tunables_with(const char *others)
{
    const char *separator = others[0] != '\0' ? ":" : "", *ours = HUGE_PAGES "=1";
    size_t size = strlen(TUNABLES) + strlen(others) + strlen(separator) + strlen(ours) + 1;
    char *text = malloc(size);
    if (text == NULL)
        return NULL;
    text[0] = '\0';
    strcat(strcat(strcat(strcat(text, TUNABLES), others), separator), ours);
    return text;
}

char **cp_child_environment(char *const *environment)
{
    size_t count = 0;
    const char *others = "";
    for (; environment[count] != NULL; count++)
        if (strncmp(environment[count], TUNABLES, strlen(TUNABLES)) == 0)
            others = environment[count] + strlen(TUNABLES);
    char **made = malloc((count + 2) * sizeof *made);
    char *tunables = strstr(others, HUGE_PAGES) != NULL ? strdup(others - strlen(TUNABLES))
                                                        : tunables_with(others);
    if (made == NULL || tunables == NULL) {
        free(made);
        free(tunables);
        return NULL;
    }

    // Ours, then all the rest.
    size_t used = 0;
    made[used++] = tunables;
    for (size_t k = 0; k < count; k++)
        if (strncmp(environment[k], TUNABLES, strlen(TUNABLES)) != 0)
            made[used++] = environment[k];
    made[used] = NULL;
    return made;
}

void cp_child_environment_free(char **environment)
{
    if (environment == NULL)
        return;
    free(environment[0]);
    free(environment);
}
