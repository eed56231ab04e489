/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_CROSS_VALIDATION_H
#define CALIBRATE_CROSS_VALIDATION_H

#include "calibrate/fit_search.h"
#include "calibrate/validation.h"

/* Fit without a part of the cases, from scratch, and predict that part; every case is predicted
 * once. */
typedef enum cp_cross_kind {
    CP_CROSS_FOLDS, /* seeded random folds: what a fit does not see may be all there is of a corner
                       of the table */
    CP_CROSS_SPEED, /* one speed at a time, likewise offset and angle: prediction of a level never
                       seen, at the edge of the range an extrapolation */
    CP_CROSS_OFFSET,
    CP_CROSS_ANGLE,
    CP_CROSS_NEIGHBOURS, /* stratified folds: of as many neighbours in the table, by speed, offset
                            and angle, as there are folds every fold gets one, drawn with the seed
                          */
    CP_CROSS_KINDS
} cp_cross_kind;

typedef struct cp_cross_validation {
    cp_cross_kind kind;
    size_t part_count;
    size_t *part;       /* owned: of every case, from 0 */
    double *held_out_g; /* owned: a case's OLC by the model fitted without its part */
    cp_validation validation;
} cp_cross_validation;

/* "5-fold cross-validation", "one speed left out at a time", ... */
void cp_cross_title(const cp_cross_validation *cross, char title[80]);

/* Deal the cases of a fit's reference into parts by that kind: part of every case, from 0. Returns
 * how many parts there are; the same fit file deals the same parts. */
size_t cp_cross_deal(const cp_fit *fit, cp_cross_kind kind, size_t *part);

/* Run one kind, with progress on stderr; its searches keep their states beside the fit's output.
 * The caller destroys. Errors: those of the search. */
CP_MUST_CHECK cp_status cp_cross_validate(const cp_fit *fit, cp_cross_kind kind,
                                          cp_cross_validation *cross, cp_error *error);
void cp_cross_validation_destroy(cp_cross_validation *cross);

/* Remove the states its searches have left. */
void cp_cross_validation_forget(const cp_fit *fit, const cp_cross_validation *cross);

#endif
