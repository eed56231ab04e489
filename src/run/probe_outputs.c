/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/probe_outputs.h"

#include "run/sumo_words.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

void cp_probe_outputs_delete(const char *scenario)
{
    char beginning[256], path[4096];
    DIR *listing = opendir("/proc/self/fd");
    if (listing == NULL)
        return; // they stay: no harm but litter
    snprintf(beginning, sizeof beginning, "%s_%s_", scenario, CP_SUMO_PROBE_NAME);
    for (const struct dirent *entry = readdir(listing); entry != NULL; entry = readdir(listing)) {
        ssize_t length = readlinkat(dirfd(listing), entry->d_name, path, sizeof path - 1);
        path[length > 0 ? length : 0] = '\0';
        const char *slash = strrchr(path, '/');
        if (slash != NULL && strncmp(slash + 1, beginning, strlen(beginning)) == 0)
            unlink(path);
    }
    closedir(listing);
}
