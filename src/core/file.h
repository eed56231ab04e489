/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_FILE_H
#define CORE_FILE_H

#include "core/error.h"

#include <stddef.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Open a file for reading: a regular one, or a pipe that the command line hands over (/dev/stdin,
 * /dev/fd/N); anything else may have no end. The caller closes. CP_BAD_INPUT with the path and the
 * reason. */
CP_MUST_CHECK cp_status cp_file_open(const char *path, FILE **file, cp_error *error);

/* Whole file into memory, at most 2 GiB, zero-terminated. *content is the caller's to free. A
 * missing or unreadable file is CP_BAD_INPUT with the path and the system's reason. */
CP_MUST_CHECK cp_status cp_file_read(const char *path, char **content, size_t *size,
                                     cp_error *error);

/* The same for text that is read up to its end: a byte order mark of UTF-8 is left out, zero bytes
 * and UTF-16 are refused as by cp_file_check_text. */
CP_MUST_CHECK cp_status cp_file_read_text(const char *path, char **content, size_t *size,
                                          cp_error *error);

/* CP_BAD_INPUT "name:line: ..." for content with a zero byte, behind which nothing would be read.
 */
CP_MUST_CHECK cp_status cp_file_check_text(const char *name, const char *content, size_t size,
                                           cp_error *error);

/* Write a whole file by way of a temporary neighbour with a random name, on the disk before it gets
 * the name, so that readers see the old or the new content, never half of it. What is there and no
 * regular file is not replaced: CP_BAD_INPUT. */
CP_MUST_CHECK cp_status cp_file_write(const char *path, const void *content, size_t size,
                                      cp_error *error);

/* A new, empty file beside path that nobody can have put there, for writing; its random name goes
 * to temporary. Returns its descriptor, or -1 with an error: CP_IO_FAILED, CP_BAD_INPUT for a path
 * that is too long. */
int cp_file_create_neighbour(const char *path, char temporary[4096], cp_error *error);

/* Whether cp_file_write may put a file there: nothing is, or a regular file. CP_BAD_INPUT for a
 * folder, a symbolic link, a device, a pipe. */
CP_MUST_CHECK cp_status cp_file_check_target(const char *path, cp_error *error);

/* path as seen from the folder of the file base ("a/study.yaml", "../b.cfg" -> "a/../b.cfg");
 * absolute paths stay. The caller frees. NULL when memory is gone. */
char *cp_file_beside(const char *base, const char *path);

#ifdef __cplusplus
}
#endif

#endif
