/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_RUNNER_H
#define RUN_RUNNER_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>

/* A whole study: plan the replications, have worker processes run the missing ones, keep the
 * database true whatever happens to them. */
typedef struct cp_runner_options {
    const char *study_path;
    const char *db_path;
    size_t jobs;             /* worker processes at a time, >= 1 */
    const char *worker_path; /* NULL: that of the running executable */
    double time_limit_s; /* a replication that takes longer has failed; 0: ten times the simulated
                            duration, at least 600 s */
    size_t shard;        /* 1 ... shards: which share of the replications to run; */
    size_t shards;       /* 0: all of them */
    bool free_outputs;   /* SUMO may write and connect where the scenarios say */
    bool allow_plugins;  /* load the libraries that the study names; else it is refused */
    bool unchecked;      /* do not read the whole database for damage first */
    bool progress;       /* show progress on stderr */
} cp_runner_options;

typedef struct cp_runner_summary {
    size_t replications; /* planned by the study file, of this shard */
    size_t done_before;  /* finished by earlier runs */
    size_t done_now;
    size_t failed;           /* tried in this run without success */
    size_t elsewhere;        /* claimed by another run that is still going on */
    size_t crashes;          /* in the database, all finished replications together */
    size_t backgrounds_done; /* of networks, now (run/background.h) */
    size_t backgrounds_failed;
    double wall_time_s;
} cp_runner_summary;

/* Run what is missing of the study: the backgrounds of its networks first, then replications. Bad
 * input (study, vehicles, SUMO configuration) is found before
 * the database is created. A replication whose worker fails is marked failed, with SUMO's last
 * words in attempt.message, and the others go on; the next run tries it again, and so with a
 * background, whose failure only this run tells. SIGINT and SIGTERM
 * end the workers and return CP_INTERRUPTED; the next run completes the study.
 *
 * The summary is filled as far as it is known. Errors: CP_BAD_INPUT, also for a database with
 * finished replications of another configuration (the difference is named); CP_RUN_FAILED when
 * replications or backgrounds failed; CP_INTERRUPTED; CP_STORE_FAILED, CP_BUSY, CP_IO_FAILED,
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_runner_run(const cp_runner_options *options, cp_runner_summary *summary,
                                      cp_error *error);

#endif
