/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_INPUT_FILE_H
#define STUDY_INPUT_FILE_H

#include "core/error.h"
#include "core/hash.h"

#include <stdbool.h>
#include <stddef.h>

/* A file that SUMO reads: its hash, and what other files it makes SUMO read. Compressed files
 * (gzip) are looked into as well. */
typedef struct cp_input_file {
    const char *path;             /* borrowed */
    char hash[CP_HASH_TEXT_SIZE]; /* SHA-256; of XML text without its comments */
    char **includes;              /* names of files it includes, as written */
    size_t include_count;
    char **values; /* of the parameters with the key looked for */
    size_t value_count;
    char **types; /* ids of its vehicle types and distributions of them, where they are asked for */
    size_t type_count;
    bool has_lights;   /* traffic lights */
    bool has_opposite; /* lanes beside which the oncoming one may be used for overtaking */
} cp_input_file;

/* What to look for. */
typedef struct cp_input_wanted {
    const char *key; /* values of <param key="..." value="..."/>; NULL: none */
    bool types;
} cp_input_wanted;

/* Read one. What is no XML includes nothing. Zero-initialise; the caller destroys, after a failure
 * too. Errors: CP_BAD_INPUT for a file that cannot be read; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_input_file_read(const char *path, const cp_input_wanted *wanted,
                                           cp_input_file *file, cp_error *error);
void cp_input_file_destroy(cp_input_file *file);

#endif
