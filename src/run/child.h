/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_CHILD_H
#define RUN_CHILD_H

#include "core/error.h"
#include "run/said.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

/* One worker process as the runner sees it. Its stderr goes to a nameless file, its error text
 * through a pipe, its stdout (SUMO's chatter) nowhere. It is in a process group of its own, so that
 * Ctrl-C reaches the runner alone. */
typedef struct cp_child {
    pid_t pid;        /* 0: none */
    int report;       /* read end of the pipe */
    FILE *messages;   /* what it wrote to stderr */
    double started_s; /* monotonic clock */
    cp_said *said;    /* borrowed, for the caller to set: lines in it are not passed on again */
} cp_child;

#define CP_CHILD_REASON_SIZE 4096

/* How a child ended. */
typedef struct cp_child_end {
    int exit_code; /* 0: CP_WORKER_EXIT_DONE; 1: any failure, an exit with 0 before the work was
                      done too; -1 when a signal ended it */
    double wall_time_s;
    char reason[CP_CHILD_REASON_SIZE]; /* "" after success: its error text, or how it died, and the
                                          last lines of its stderr */
} cp_child_end;

/* Path of the worker: the one given, else the crashpulse-worker that belongs to the running
 * executable (core/installation.h). Errors: CP_IO_FAILED when it is not there. */
CP_MUST_CHECK cp_status cp_child_find_worker(const char *given, char *path, size_t size,
                                             cp_error *error);

/* Start program with arguments (arguments[0] is the name, NULL ends the list). */
CP_MUST_CHECK cp_status cp_child_start(const char *program, const char *const *arguments,
                                       cp_child *child, cp_error *error);

/* After a child ended with wait status wait_status: what it said, resources freed, child zeroed.
 * Its log lines ("crashpulse: ...") are passed on to our stderr, those that child->said has not. */
void cp_child_collect(cp_child *child, int wait_status, cp_child_end *end);

/* Wait for its end and collect it; one that takes longer than limit_s since its start (INFINITY:
 * no limit) is killed, and says so. */
void cp_child_wait(cp_child *child, double limit_s, cp_child_end *end);

/* Kill it and wait for its end; why (may be NULL) goes in front of its last words: "no end after 10
 * s". */
void cp_child_kill(cp_child *child, const char *why, cp_child_end *end);

#endif
