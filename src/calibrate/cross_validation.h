/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_CROSS_VALIDATION_H
#define CALIBRATE_CROSS_VALIDATION_H

#include "calibrate/fit_search.h"
#include "calibrate/validation.h"

/* Fit without a part of the cases, from scratch, and predict that part; every case is predicted
 * once. */
typedef enum cp_cross_kind {
    CP_CROSS_FOLDS, /* seeded random folds */
    CP_CROSS_SPEED, /* one speed at a time, likewise offset and angle: prediction of a level never
                       seen, at the edge of the range an extrapolation */
    CP_CROSS_OFFSET,
    CP_CROSS_ANGLE,
    CP_CROSS_KINDS
} cp_cross_kind;

typedef struct cp_cross_validation {
    cp_cross_kind kind;
    size_t part_count;
    double *held_out_g; /* owned: a case's OLC by the model fitted without its part */
    cp_validation validation;
} cp_cross_validation;

/* "5-fold cross-validation", "one speed left out at a time", ... */
void cp_cross_title(const cp_cross_validation *cross, char title[80]);

/* Run one kind, with progress on stderr; its searches keep their states beside the fit's output.
 * The caller destroys. Errors: those of the search. */
CP_MUST_CHECK cp_status cp_cross_validate(const cp_fit *fit, cp_cross_kind kind,
                                          cp_cross_validation *cross, cp_error *error);
void cp_cross_validation_destroy(cp_cross_validation *cross);

/* Remove the states its searches have left. */
void cp_cross_validation_forget(const cp_fit *fit, const cp_cross_validation *cross);

#endif
