/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_TREATMENT_H
#define RUN_TREATMENT_H

#include "control/control.h"
#include "study/study_file.h"

/* What a counterfactual study asks of each crash of its baseline; all borrowed. */

/* Functions that the two cars of a crash have in a branch. */
typedef struct cp_treatment {
    const char *name; /* of the variant */
    const cp_control_settings *functions;
    size_t function_count;
} cp_treatment;

typedef struct cp_treatments {
    const char *baseline; /* name of the variant that nobody is treated in */
    const cp_treatment *treatment;
    size_t count;
    cp_study_counterfactual timing;
    uint64_t study_seed, seed; /* who has a function is drawn by (control.h) */
} cp_treatments;

#endif
