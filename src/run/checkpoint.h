/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_CHECKPOINT_H
#define RUN_CHECKPOINT_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>

/* Frozen copies of this process, from which what it does can be gone through again, differently.
 *
 *   worker ── fork at some checkpoints ──► copy (waits)
 *                └── fork on request ──► guide: goes on to the checkpoint asked for
 *                                          └── fork ──► branch: goes on from there
 *
 * A copy is a forked child that waits for a request; a guide is its child, which goes on as the
 * original did to the checkpoint asked for and forks one branch after another there. They run from
 * the state of the checkpoint, answer through a pipe and end. (At its own checkpoint a copy forks
 * the branches itself.) A copy costs the worker as much as some seconds of light traffic, most of
 * it for pages that both write to, so it is cheaper to go some way twice when a crash has happened
 * than to keep a copy of every checkpoint; the caller says when it is time for one. The last `kept`
 * checkpoints can be branched from; copies that none of them needs end. Whoever loses its parent
 * dies (branch_process.h); a branch that aborts, crashes or runs out of time has an answer that
 * says so, nothing more.
 *
 * Between create and destroy neither this process nor the checkpoints allocate memory on the heap
 * for any of this, so that a branch that changes nothing repeats the original bit by bit. */
typedef struct cp_checkpoints cp_checkpoints;

typedef struct cp_checkpoint_options {
    size_t kept;        /* checkpoints at a time, >= 1 */
    size_t every;       /* checkpoints for one copy at most, >= 1; more than 1 needs advance */
    unsigned cpu_s;     /* processor time of a guide or branch, at most */
    unsigned wall_s;    /* wall time of a guide's way or a branch, at most */
    size_t request_max; /* bytes of the largest request */
    /* Runs in a branch's process: number of the branch, the request, and where to send the answer
     * (cp_branch_write). Only the answer matters and, when it fails, its error. */
    cp_status (*branch)(void *context, size_t number, const void *request, size_t size, int answer,
                        cp_error *error);
    /* Runs in a guide's process: go on, changing nothing, to the checkpoint of time_s. */
    cp_status (*advance)(void *context, double time_s, cp_error *error);
    void *context;
} cp_checkpoint_options;

/* kept 20, every 1, cpu_s 120, wall_s 1200, request_max 64 KiB. */
cp_checkpoint_options cp_checkpoint_options_default(void);

#define CP_BRANCH_FAILURE_SIZE 256

/* What a branch came to. */
typedef struct cp_branch_end {
    bool answered;      /* it ended by itself with success */
    const void *answer; /* owned by the checkpoints until destroy */
    size_t answer_size;
    char failure[CP_BRANCH_FAILURE_SIZE]; /* "" when answered, else how it ended: "ended by signal 6
                                             (Aborted)", "failed: ..." with its error */
} cp_branch_end;

CP_MUST_CHECK cp_status cp_checkpoints_create(const cp_checkpoint_options *options,
                                              cp_checkpoints **checkpoints, cp_error *error);
/* Ends all checkpoints and waits for them; NULL is fine. */
void cp_checkpoints_destroy(cp_checkpoints *checkpoints);

/* The present state is that of time_s; times rise. Freezes it when wanted, and unasked when it is
 * the first or `every` checkpoints after the last copy; is_copied (may be NULL): whether it did.
 * Errors: CP_RUN_FAILED when the system gives no process or descriptor more. */
CP_MUST_CHECK cp_status cp_checkpoints_take(cp_checkpoints *checkpoints, double time_s,
                                            bool is_wanted, bool *is_copied, cp_error *error);

/* The youngest checkpoint not younger than latest_s: its time; false when there is none, or no copy
 * as old as that. */
bool cp_checkpoints_find(const cp_checkpoints *checkpoints, double latest_s, double *time_s);

/* Run branches 0 ... count-1 from the checkpoint of exactly time_s, one after another; ends: count
 * of them, filled. False when its copy has ended (nothing is filled then). */
bool cp_checkpoints_branch(cp_checkpoints *checkpoints, double time_s, const void *request,
                           size_t size, size_t count, cp_branch_end *ends);

#endif
