/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_CLASS_ERROR_H
#define ANALYSIS_CLASS_ERROR_H

#include "analysis/slice_sample.h"

/* What the errors of the classes of tests leave open of a treatment against the baseline
 * (db/validation/README.md, "From the scorecard to validity"). Errors are independent between
 * classes and common to all crashes of a class in both arms: with E_A,c the mean over the arm's
 * frontally struck vehicles of class_error_g where the class is c and 0 elsewhere, the standard
 * error of a difference of mean OLC is sqrt(sum over c of (E_A,c - E_B,c)^2). Left-censored
 * vehicles count with 0 g, those outside with no error that is known: they are counted. */
typedef struct cp_class_error {
    size_t vehicles[2]; /* frontally struck, of baseline and treatment; failed ones left out */
    size_t without[2];  /* of these with no class, or with one whose error is not known */
    double error_g;     /* NAN without any vehicle in an arm, or any class in either */
} cp_class_error;

/* set: replications of baseline and treatment. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_class_error_of(const cp_study_data *data,
                                          const cp_replication_set set[2], cp_slice slice,
                                          cp_class_error *figures, cp_error *error);

/* sqrt(sum (a_c - b_c)^2) over classes. */
double cp_class_error_difference(const double *mean_a_g, const double *mean_b_g, size_t classes);

#endif
