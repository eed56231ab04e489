/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_SUPERIORITY_H
#define STATS_SUPERIORITY_H

#include "stats/bootstrap.h"
#include "stats/sample.h"

/* Stochastic superiority of one sample over another, Cliff's delta, from clusters (replications) of
 * any size, in strata (scenarios) that are compared within themselves.
 *
 * The test of "no difference" and the interval come from one standard error, that of the jackknife
 * over whole clusters, so that they cannot contradict each other, against Student's t. Its degrees
 * of freedom are Satterthwaite's over the two samples, each with Kish's effective number of
 * clusters (sum m)^2 / sum m^2 of m observations minus 1 for every stratum; of paired samples the
 * smaller of the two. Unlike the permutation of whole replications this needs no alike numbers of
 * observations in the two samples. Size and coverage: tests/stats/null_study.md.
 *
 * Where every observation of one sample lies above all of the other (of its stratum), nothing
 * scatters: there is no interval, and p is a bound. One observation of each cluster would be
 * separated too, and without a difference those are as likely in any order: 2 / C(k_a + k_b, k_a)
 * for k_a and k_b clusters that have any, a factor for every stratum; of paired samples 2 / 2^m for
 * m pairs that both have. */

typedef struct cp_superiority {
    double cliffs_delta;       /* P(b > a) - P(b < a), ties half, over the strata weighted with
                                  n_a n_b / (n_a + n_b); NAN when no stratum has both */
    double standard_error;     /* NAN without */
    double freedom;            /* likewise */
    cp_interval_status status; /* whether p and interval are given, or why not: either sample has
                                  too few observations (cp_sample_too_few), or no scatter */
    double p;                  /* two-sided; NAN without; a bound with CP_INTERVAL_ALL_ALIKE */
    cp_interval interval;
} cp_superiority;

/* resampling: counts, strata, pairing and level of the clusters of a and b (repetitions do not
 * matter). A stratum of one cluster shows no scatter of its own: all of these are taken as one.
 * Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_superiority_of(const cp_sample *a, const cp_sample *b,
                                          const cp_resampling *resampling,
                                          cp_superiority *superiority, cp_error *error);

#endif
