/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_SCRATCH_H
#define CORE_SCRATCH_H

#include "core/error.h"

#include <stddef.h>
#include <stdio.h>

/* A folder of a few files that another program works on, with a random name in $TMPDIR (or /tmp)
 * that nobody else may enter. Names of files within it are ours: no '/', nothing from outside. */
typedef struct cp_scratch {
    char path[4096]; /* "": none */
} cp_scratch;

/* Errors: CP_IO_FAILED with the folder and the system's reason. The caller closes. */
CP_MUST_CHECK cp_status cp_scratch_open(cp_scratch *scratch, cp_error *error);
/* Remove the folder with the files in it. */
void cp_scratch_close(cp_scratch *scratch);

/* A file of part_count zero-terminated texts, one after the other. */
CP_MUST_CHECK cp_status cp_scratch_write(const cp_scratch *scratch, const char *name,
                                         const char *const part[], size_t part_count,
                                         cp_error *error);
/* A file whole, as cp_file_read. A missing one is CP_RUN_FAILED: the program did not write it. */
CP_MUST_CHECK cp_status cp_scratch_read(const cp_scratch *scratch, const char *name, char **content,
                                        size_t *size, cp_error *error);

/* Run a program, found in PATH, within the folder and wait for it; no shell is between. word: its
 * name and arguments, NULL behind the last. Its stdin and stdout are empty, its stderr is ours.
 * *code: its exit code, or 128 + the signal that ended it. Errors: CP_BAD_INPUT when there is no
 * such program, CP_RUN_FAILED when it cannot be started. */
CP_MUST_CHECK cp_status cp_scratch_run(const cp_scratch *scratch, const char *const word[],
                                       int *code, cp_error *error);

/* Where temporary files go: $TMPDIR, or /tmp. */
const char *cp_scratch_folder(void);

/* A file without a name in $TMPDIR (or /tmp), for reading and writing; it is gone when closed. NULL
 * with errno when there can be none. */
FILE *cp_scratch_file(void);

#endif
