/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_CONTRAST_H
#define STATS_CONTRAST_H

#include "stats/bootstrap.h"
#include "stats/describe.h"
#include "stats/rates.h"

/* Two variants compared: a is the baseline, b the treatment, every difference is b - a. */

/* A test statistic and its p by permutation of whole replications: within strata, replications
 * change the variant they belong to; in the paired design each seed's pair is swapped or not (sign
 * flips). p = (1 + permutations at least as extreme) / (1 + permutations); NAN without data. */
typedef struct cp_permutation_test {
    double statistic;
    double p;
} cp_permutation_test;

/* Severity of one variant against another. */
typedef struct cp_contrast {
    cp_estimate mean_difference; /* of the values */
    cp_interval mean_interval;
    cp_estimate median_difference;
    cp_interval median_interval;
    cp_estimate p90_difference;
    cp_interval p90_interval;
    double cliffs_delta; /* P(b > a) - P(b < a); NAN when either is empty */
    cp_interval cliffs_delta_interval;
    cp_permutation_test mann_whitney; /* statistic: U of b, pairs with b > a + half the ties */
    cp_permutation_test kolmogorov_smirnov; /* statistic: largest distance of the two ECDFs */
} cp_contrast;

/* resampling: clusters of a and b, strata, pairing, seed; its repetitions serve the intervals,
 * permutations the tests (0: none, p is NAN; 1999 is a good number). Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_contrast_samples(const cp_sample *a, const cp_sample *b,
                                            const cp_resampling *resampling, size_t permutations,
                                            cp_contrast *contrast, cp_error *error);

/* Difference of two rates; statistic: log of the ratio (+-INFINITY with no event on one side). */
CP_MUST_CHECK cp_status cp_contrast_rates(const cp_exposure *a, const cp_exposure *b,
                                          const cp_resampling *resampling, size_t permutations,
                                          cp_permutation_test *test, cp_error *error);

/* Holm's (1979) adjustment of count p-values for several treatments, in place; NAN stays NAN and
 * does not count. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_holm_adjust(double *p, size_t count, cp_error *error);

#endif
