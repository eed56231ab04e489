/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_SUITE_TEXT_H
#define CALIBRATE_SUITE_TEXT_H

#include "calibrate/suite_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Files of a test that live as long as one call. */

/* Write text to a new file; path receives its name ("/tmp/suite_XXXXXX" filled in). */
static inline void suite_text_write(const char *text, char path[32])
{
    snprintf(path, 32, "/tmp/suite_XXXXXX");
    int descriptor = mkstemp(path);
    if (descriptor < 0 || write(descriptor, text, strlen(text)) != (ssize_t)strlen(text))
        abort();
    close(descriptor);
}

/* Load a suite from text. The caller destroys it. */
static inline cp_status suite_text_load(const char *text, cp_suite *suite, cp_error *error)
{
    char path[32];
    suite_text_write(text, path);
    cp_status status = cp_suite_load(path, suite, error);
    unlink(path);
    return status;
}

#endif
