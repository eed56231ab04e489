/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BUILDERS_SMALL_STUDY_H
#define BUILDERS_SMALL_STUDY_H

#include "store/store.h"

#include <stdio.h>
#include <stdlib.h>

/* Open a study that the tests of sql/ build, by its file. Include after cmocka.h. */
static inline cp_store *open_study(const char *file)
{
    const char *folder = getenv("CRASHPULSE_BUILD");
    char path[4096];
    cp_store *store = NULL;
    cp_error error = {0};
    snprintf(path, sizeof path, "%s/%s", folder ? folder : ".", file);
    if (cp_store_open(path, CP_STORE_READ, &store, &error) != CP_OK)
        fail_msg("%s", error.text);
    return store;
}

/* The invented study that the test sql.small_study builds. */
static inline cp_store *open_small_study(void)
{
    return open_study("small_study.db");
}

#endif
