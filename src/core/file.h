/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_FILE_H
#define CORE_FILE_H

#include "core/error.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Whole file into memory, zero-terminated. *content is the caller's to free. A missing or
 * unreadable file is CP_BAD_INPUT with the path and the system's reason. */
CP_MUST_CHECK cp_status cp_file_read(const char *path, char **content, size_t *size,
                                     cp_error *error);

/* Write a whole file by way of a temporary neighbour and rename, so that readers see the old or
 * the new content, never half of it. */
CP_MUST_CHECK cp_status cp_file_write(const char *path, const void *content, size_t size,
                                      cp_error *error);

/* path as seen from the folder of the file base ("a/study.yaml", "../b.cfg" -> "a/../b.cfg");
 * absolute paths stay. The caller frees. NULL when memory is gone. */
char *cp_file_beside(const char *base, const char *path);

#ifdef __cplusplus
}
#endif

#endif
