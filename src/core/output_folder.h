/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_OUTPUT_FOLDER_H
#define CORE_OUTPUT_FOLDER_H

#include "core/error.h"

#include <stdio.h>

/* A folder of results that gets its name when it is whole: written as a neighbour with a random
 * name. Zero-initialise, begin, write files below temporary, then commit or abandon. */
typedef struct cp_output_folder {
    const char *path;     /* borrowed */
    char temporary[4096]; /* "": none */
} cp_output_folder;

/* Errors: CP_BAD_INPUT when anything is there under the path, CP_IO_FAILED. */
CP_MUST_CHECK cp_status cp_output_folder_begin(const char *path, cp_output_folder *folder,
                                               cp_error *error);
/* A new file below temporary; what is there already is not opened. Close tells of any failed write:
 * CP_IO_FAILED. The disk is waited for once, by the commit. */
CP_MUST_CHECK cp_status cp_output_folder_create(const char *path, FILE **file, cp_error *error);
CP_MUST_CHECK cp_status cp_output_folder_close(const char *path, FILE *file, cp_error *error);

/* Errors: CP_IO_FAILED; then all that was written is removed. */
CP_MUST_CHECK cp_status cp_output_folder_commit(cp_output_folder *folder, cp_error *error);
/* Remove all that was written; nothing after a commit or without a beginning. */
void cp_output_folder_abandon(cp_output_folder *folder);

#endif
