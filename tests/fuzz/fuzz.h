/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef FUZZ_FUZZ_H
#define FUZZ_FUZZ_H

#include "core/error.h"

#include <stddef.h>
#include <stdint.h>

/* Targets of fuzzing: each takes any bytes as what a stranger may hand over, and ends the process
 * by a signal when something happens that must not: a failure without words, a result that breaks
 * its own promises, or what a sanitizer sees. */

typedef void fuzz_function(const uint8_t *data, size_t size);

typedef struct fuzz_target {
    const char *name; /* also of the folder of its seeds */
    fuzz_function *run;
    size_t size_max; /* of inputs that are worth the time */
} fuzz_target;

extern const fuzz_target FUZZ_TARGET[];
extern const size_t FUZZ_TARGET_COUNT;

/* By name; ends the process with exit code 2 for one there is not. */
const fuzz_target *fuzz_find(const char *name);

/* Begin a target: a folder of its own, removed at exit, becomes the working directory; it holds the
 * files that readers look for beside an input: car.yaml, reference.csv, pulse.csv, net.sumocfg with
 * its files, collisions.xml. */
void fuzz_begin(void);

/* One input. */
void fuzz_run(const fuzz_target *target, const uint8_t *data, size_t size);

/* What the targets call. */
void fuzz_write(const char *name, const void *data, size_t size);
/* A failure must be bad input, or want of memory, told in words. */
void fuzz_judge(cp_status status, const cp_error *error);
/* How many times there was none. */
extern size_t fuzz_read_well;
/* Ends the process by a signal unless it holds; what: told before. */
void fuzz_must(int holds, const char *what);
/* Part number of an input whose parts stand between lines "=====". */
const uint8_t *fuzz_part(const uint8_t *data, size_t size, int number, size_t *part_size);

/* Readers of files (fuzz_files.c, fuzz_pulses.c), blobs (fuzz_codec.c), functions of SQL
 * (fuzz_sql.c), rows of a database (fuzz_rows.c). */
fuzz_function fuzz_vehicle, fuzz_study, fuzz_fit, fuzz_suite, fuzz_reference, fuzz_configurations,
    fuzz_pulse_csv, fuzz_table, fuzz_ev5, fuzz_collisions, fuzz_fcd, fuzz_types, fuzz_sumocfg,
    fuzz_codec, fuzz_sql, fuzz_rows, fuzz_iso_mme, fuzz_lsdyna, fuzz_pulse_file, fuzz_location;

#endif
