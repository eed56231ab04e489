/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_WEIGHTED_H
#define STATS_WEIGHTED_H

#include <stddef.h>

/* Observations with weights that are no counts. Weights are >= 0; those of 0 do not count. */

/* Kish's (1965) effective number of observations, (sum w)^2 / sum w^2; 0 of nothing. */
double cp_weighted_effective(const double *weight, size_t count);

/* Quantile of ascending values (finite or -INFINITY: left-censored), 0 <= p <= 1. Neighbours lie
 * half of their weights apart, linear between them: with equal weights Hyndman and Fan's type 7, as
 * cp_sample_quantile. times (may be NULL: once): copies of each value, next to each other.
 * -INFINITY among censored ones, NAN of nothing. */
double cp_weighted_quantile(const double *value, const double *weight, const unsigned *times,
                            size_t count, double p);

/* How far two distributions lie apart. */
typedef struct cp_weighted_distance {
    double largest_1; /* between the distribution functions, 0 ... 1; NAN when either is empty */
    double mean;      /* area between them: how far weight has to be moved on average (Wasserstein),
                         in the unit of the values */
} cp_weighted_distance;

/* Both in ascending order, finite. */
cp_weighted_distance cp_weighted_distance_of(const double *a, const double *weight_a,
                                             size_t count_a, const double *b,
                                             const double *weight_b, size_t count_b);

#endif
