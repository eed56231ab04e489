/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_PAIR_H
#define RUN_PAIR_H

#include "run/checkpoint.h"
#include "run/fleet.h"
#include "run/simulation.h"
#include "run/treatment.h"
#include "store/counterfactual_rows.h"

/* A crash of the baseline and what its branches came to: whether the null treatment repeats it to
 * the bit, and the outcome of each treatment. */

#define CP_COUNTERFACTUAL_SPEED_M_S 0.5 /* mitigated or aggravated by more than this */
#define CP_COUNTERFACTUAL_OLC_G 0.5

/* All borrowed. */
typedef struct cp_pair {
    const cp_treatments *treatments;
    const cp_simulation *simulation; /* of the baseline */
    const cp_fleet *fleet;
    size_t number;             /* of the crash among those that count */
    size_t found;              /* index of its contact in the simulation */
    const cp_crash_row *crash; /* as stored */
    const char *ids[2];        /* of its two vehicles, by role */
    cp_null_status status;     /* CP_NULL_REPRODUCED: there are branches; else why there are none */
    double lead_s;             /* the checkpoint had to be this long before contact */
    double checkpoint_s;       /* NAN: none */
    const cp_branch_end *ends; /* of the null treatment, then of the treatments */
} cp_pair;

/* Add its rows, the surrogate run on every treated crash. Errors: CP_RUN_FAILED for a damaged
 * answer, CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_pair_conclude(const cp_pair *pair, cp_counterfactual_rows *rows,
                                         cp_error *error);

#endif
