/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_BRANCH_RUN_H
#define RUN_BRANCH_RUN_H

#include "run/branch_answer.h"
#include "run/treatment.h"

/* What a branch does in its process: a crash of the baseline gone through again from the checkpoint
 * that the process is a copy of, with or without a treatment on its two vehicles. */

/* Where it happens; all borrowed. */
typedef struct cp_branch_world {
    const cp_treatments *treatments;
    cp_simulation *simulation;
    cp_sample_row *samples; /* room for those of one branch */
    size_t sample_room;
} cp_branch_world;

/* The functions below fit cp_checkpoint_options; world is a cp_branch_world. */

/* Branch number 0 changes nothing and ends with its crash; number k has treatment k - 1 and ends at
 * the horizon, for the sake of crashes between others. request: a cp_branch_request of size bytes.
 * CP_OK when the answer has been sent. Errors: those of the simulation; CP_RUN_FAILED. */
CP_MUST_CHECK cp_status cp_branch_run(void *world, size_t number, const void *request, size_t size,
                                      int answer, cp_error *error);

/* On to the step that ends at time_s, changing nothing. Errors: those of the simulation. */
CP_MUST_CHECK cp_status cp_branch_advance(void *world, double time_s, cp_error *error);

/* Whether two pairs of ids are the same, in whichever order. */
bool cp_branch_is_same_pair(const char *const one[2], const char *const other[2]);

#endif
