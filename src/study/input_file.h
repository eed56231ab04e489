/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_INPUT_FILE_H
#define STUDY_INPUT_FILE_H

#include "core/error.h"
#include "core/hash.h"

#include <stdbool.h>
#include <stddef.h>

/* A place in a file where SUMO is given the name of a file to write: an attribute file, output or
 * dest (detectors, edge data, timed events, calibrators), a parameter whose key ends in the word
 * file or output (devices, traffic lights), or a document type or entity, which is read, from
 * elsewhere. */
typedef struct cp_input_output {
    size_t line; /* 0: not known */
    char *what;  /* "<edgeData file>", "device.ssm.file" */
    char *name;  /* as written */
} cp_input_output;

/* A file that SUMO reads: its hash, and what other files it makes SUMO read. Compressed files
 * (gzip) are looked into as well. */
typedef struct cp_input_file {
    const char *path;             /* borrowed */
    char hash[CP_HASH_TEXT_SIZE]; /* SHA-256; of XML text without its comments; if looked for */
    char **includes;              /* names of files it includes, as written */
    size_t include_count;
    char **values; /* of the parameters with the key looked for */
    size_t value_count;
    char **types; /* ids of its vehicle types and distributions of them, if looked for */
    size_t type_count;
    cp_input_output *outputs; /* if looked for */
    size_t output_count;
    bool has_lights;   /* traffic lights */
    bool has_opposite; /* lanes beside which the oncoming one may be used for overtaking */
} cp_input_file;

/* What is looked for besides. */
typedef struct cp_input_search {
    const char *key; /* values of <param key="..." value="..."/> with this key; NULL: none */
    bool hash;       /* of the whole file */
    bool types;      /* vehicle types, and distributions of them */
    bool outputs;    /* what would make SUMO write or connect */
} cp_input_search;

/* Read one. What is no XML includes nothing. Zero-initialise; the caller destroys, after a failure
 * too. Errors: CP_BAD_INPUT for a file that cannot be read; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_input_file_read(const char *path, const cp_input_search *search,
                                           cp_input_file *file, cp_error *error);
void cp_input_file_destroy(cp_input_file *file);

#endif
