/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_ERROR_H
#define CORE_ERROR_H

#include "core/status.h"

/* What went wrong, in words for the user: place (file:line), field, what was found, what is
 * allowed. The caller owns it (on the stack, zero-initialised); functions fill it on failure
 * only. No allocation, so it works when memory is gone. */
typedef struct cp_error {
    cp_status status;
    char text[4096];
} cp_error;

#ifdef __cplusplus
extern "C" {
#endif

/* Fill error (may be NULL) with a message and return status, so that a function can say
 * `return cp_fail(error, CP_BAD_INPUT, "%s:%d: speed_kmh must be > 0, found %s", ...);` */
cp_status cp_fail(cp_error *error, cp_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Put context in front of an existing message ("study.yaml: " + ...). Returns error->status. */
cp_status cp_error_prefix(cp_error *error, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* "out of memory" with what was asked for. Returns CP_NO_MEMORY. */
cp_status cp_fail_memory(cp_error *error, const char *what);

#ifdef __cplusplus
}
#endif

#endif
