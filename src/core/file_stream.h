/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_FILE_STREAM_H
#define CORE_FILE_STREAM_H

#include "core/error.h"

#include <stdio.h>

/* A file that is written piece by piece, of any size, and gets its name when it is whole: the same
 * as cp_file_write otherwise. Zero-initialise, begin, write to file, then commit or abandon. */
typedef struct cp_file_stream {
    FILE *file;       /* NULL: none */
    const char *path; /* borrowed */
    char temporary[4096];
} cp_file_stream;

/* Errors: CP_IO_FAILED; CP_BAD_INPUT for what is there and no regular file. */
CP_MUST_CHECK cp_status cp_file_stream_begin(const char *path, cp_file_stream *stream,
                                             cp_error *error);
/* On the disk, then under its name. An error of any write before is told here: CP_IO_FAILED, and
 * nothing is left. */
CP_MUST_CHECK cp_status cp_file_stream_commit(cp_file_stream *stream, cp_error *error);
/* Remove what was written; nothing after a commit or without a beginning. */
void cp_file_stream_abandon(cp_file_stream *stream);

#endif
