/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_LIBRARY_H
#define CONTROL_LIBRARY_H

#include "api/crashpulse/function.h"
#include "core/error.h"
#include "core/hash.h"

/* A function that a study brings along as a shared library: what the study says of it, and how it
 * is loaded. Only a worker process loads one (run/worker.c); everybody else reads its file for the
 * hash alone. */

/* A parameter as the study gives it. */
typedef struct cp_library_parameter {
    char *name;
    char *text;
    double number; /* NAN: the text is none */
} cp_library_parameter;

typedef struct cp_library {
    char *name;                   /* of the function, in tables and counters */
    char *written;                /* the library as the study names it, */
    char *path;                   /* as seen from here, */
    char hash[CP_HASH_TEXT_SIZE]; /* and what its file holds */
    char *data;                   /* a file for the function; NULL: none. As written, */
    char *data_path;
    char data_hash[CP_HASH_TEXT_SIZE];
    cp_library_parameter *given; /* the study's order */
    size_t given_count;
} cp_library;

/* A copy of all of it; NULL when memory is gone. destroy: NULL is fine. */
cp_library *cp_library_copy(const cp_library *library);
void cp_library_destroy(cp_library *library);

/* Load it into this process and ask it for its function, which stays until the process ends.
 * Errors: CP_RUN_FAILED for a file that cannot be loaded, one without an entry, another ABI, or a
 * function that contradicts itself. */
CP_MUST_CHECK cp_status cp_library_load(const cp_library *library,
                                        const crashpulse_function **function, cp_error *error);

#endif
