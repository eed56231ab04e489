/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_OUTPUT_FILES_H
#define CORE_OUTPUT_FILES_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The files a command is about to write, looked at before its work begins.
 *
 * outputs, inputs: paths; NULL entries count for nothing. CP_BAD_INPUT with the path when an output
 * is an input of the same command, a file that SQLite keeps beside one (-wal, -shm, -journal), or
 * another output, by whatever name; when it is there and no regular file (a folder, a symbolic
 * link, a device, a pipe); CP_IO_FAILED when its folder is missing or cannot be written. */
CP_MUST_CHECK cp_status cp_output_files_check(const char *const outputs[], size_t output_count,
                                              const char *const inputs[], size_t input_count,
                                              cp_error *error);

/* Whether path, as a configuration file names it, stays in that file's folder or below: relative,
 * no "..", and no symbolic link on the way out of it. */
CP_MUST_CHECK cp_status cp_output_file_check_below(const char *base, const char *path,
                                                   cp_error *error);

/* Whether one of a path's parts is "..". */
bool cp_path_has_parent_step(const char *path);

#ifdef __cplusplus
}
#endif

#endif
