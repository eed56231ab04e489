/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_WRITTEN_FILE_H
#define EXCHANGE_WRITTEN_FILE_H

#include "core/file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A file of a test in a folder of its own, written anew by every call. */

static char written_folder[64];
static char written_path[128];

static inline int written_begin(void **state)
{
    (void)state;
    snprintf(written_folder, sizeof written_folder, "/tmp/crashpulse-test-XXXXXX");
    return mkdtemp(written_folder) == NULL;
}

static inline int written_end(void **state)
{
    (void)state;
    unlink(written_path);
    return rmdir(written_folder);
}

static inline const char *write_file(const char *text)
{
    cp_error error = {0};
    snprintf(written_path, sizeof written_path, "%s/file", written_folder);
    if (cp_file_write(written_path, text, strlen(text), &error) != CP_OK)
        fail_msg("%s", error.text);
    return written_path;
}

/* Text with the first occurrence of old replaced; the caller frees. */
static inline char *with(const char *text, const char *old, const char *replacement)
{
    const char *at = strstr(text, old);
    if (at == NULL)
        fail_msg("'%s' is not there", old);
    size_t size = strlen(text) + strlen(replacement) + 1;
    char *result = malloc(size);
    assert_non_null(result);
    snprintf(result, size, "%.*s%s%s", (int)(at - text), text, replacement, at + strlen(old));
    return result;
}

#endif
