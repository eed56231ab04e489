/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_CONTRAST_H
#define STATS_CONTRAST_H

#include "stats/bootstrap.h"
#include "stats/describe.h"
#include "stats/rates.h"
#include "stats/superiority.h"

/* Two variants compared: a is the baseline, b the treatment, every difference is b - a. */

/* A test statistic and its p by permutation of whole replications: within strata, replications
 * change the variant they belong to; in the paired design each seed's pair is swapped or not (sign
 * flips). p = (1 + permutations at least as extreme) / (1 + permutations); NAN without data. Valid
 * where "no difference" leaves nothing to tell the variants apart: for their rates, not for the
 * severity of crashes of which one has more than the other. */
typedef struct cp_permutation_test {
    double statistic;
    double p;
} cp_permutation_test;

/* Severity of one variant against another, over the strata in which both have observations, mixed
 * alike (stats/pooled.h). */
typedef struct cp_contrast {
    size_t compared[2]; /* observations of a and b in such strata */
    cp_estimate median[2];
    cp_estimate mean_difference;
    cp_interval mean_interval;
    cp_estimate median_difference;
    cp_interval median_interval;
    cp_estimate p90_difference;
    cp_interval p90_interval;
    cp_superiority superiority; /* Cliff's delta, its interval and test (Mann-Whitney's question) */
    double distance;            /* largest between the two distribution functions; NAN without */
    double distance_p; /* how often clusters drawn anew differ as much from the functions as
                          observed; NAN: too few */
} cp_contrast;

/* Fewer observations of either sample give no interval of a difference of 90 % quantiles: of 8 to
 * 30 it holds the truth in 75 to 92 % only, of 30 to 40 in 91 to 95 %. */
#define CP_CONTRAST_P90_OBSERVATIONS_MIN 50

/* Fewer events in both samples together give no p of their rates: so few leave labellings too few
 * for a test at 5 %. */
#define CP_CONTRAST_EVENTS_MIN 10

/* resampling: clusters of a and b, strata, pairing, seed and repetitions of intervals and of the
 * distance's p. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_contrast_samples(const cp_sample *a, const cp_sample *b,
                                            const cp_resampling *resampling, cp_contrast *contrast,
                                            cp_error *error);

/* Difference of two rates; statistic: log of the ratio (+-INFINITY with no event on one side).
 * permutations: 0: none, p is NAN; 1999 is a good number. p is NAN of fewer than
 * CP_CONTRAST_EVENTS_MIN events too. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_contrast_rates(const cp_exposure *a, const cp_exposure *b,
                                          const cp_resampling *resampling, size_t permutations,
                                          cp_permutation_test *test, cp_error *error);

/* Holm's (1979) adjustment of count p-values for several treatments, in place; NAN stays NAN and
 * does not count. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_holm_adjust(double *p, size_t count, cp_error *error);

#endif
