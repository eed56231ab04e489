/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_SUMO_WORDS_H
#define RUN_SUMO_WORDS_H

#include "core/error.h"

#include <stddef.h>
#include <stdint.h>

/* The further SUMO options of one replication: those of its scenario that are left to it
 * (traffic/sumo_options.h), and an output prefix of its own. Whatever files the .sumocfg or an
 * option writes (tripinfo.xml), parallel replications write each their own:
 * left_turn_aeb_421632325_tripinfo.xml. A prefix that the
 * scenario's options or its .sumocfg give follows ours, without its folder: SUMO puts that behind
 * the folder of every output, so that out/TIME_ and out/trips.xml need a folder out/out.
 *
 * Where crashed cars stay (stay_s > 0), SUMO must neither teleport them nor set the cars that wait
 * behind them down in front: --time-to-teleport is stay_s + 300 s, unless the scenario's options
 * say otherwise. */

#define CP_SUMO_PREFIX_SIZE 1024
/* Stands for a variant's name in the prefix of a probe, whose files are not kept. */
#define CP_SUMO_PROBE_NAME "@probe"

/* What SUMO is started with for one replication; all borrowed. */
typedef struct cp_sumo_start {
    const char *sumocfg_path;
    char *const *options; /* further SUMO words of the scenario */
    size_t option_count;
    const char *scenario; /* begins the names of files that SUMO writes; NULL: nothing does */
    const char *variant;  /* goes on; NULL: CP_SUMO_PROBE_NAME */
} cp_sumo_start;

typedef struct cp_sumo_words {
    char **word;
    size_t count;
} cp_sumo_words;

/* The caller destroys. Errors: CP_BAD_INPUT for a .sumocfg that cannot be read; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_sumo_words_create(const cp_sumo_start *start, uint64_t seed,
                                             double stay_s, cp_sumo_words *words, cp_error *error);
void cp_sumo_words_destroy(cp_sumo_words *words);

#endif
