/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_PAIRED_H
#define STATS_PAIRED_H

#include "stats/bootstrap.h"
#include "stats/contrast.h"
#include "stats/sample.h"

/* Differences within pairs: treatment minus baseline of the same crash. Crashes of one replication
 * belong together. */

/* Hodges-Lehmann estimate: the median of all Walsh averages (d[i] + d[j]) / 2, i <= j, exactly, in
 * O(n) memory. sample: the differences, all finite; weight: how often each cluster occurs in a
 * resample, NULL once each. NAN of nothing. */
double cp_paired_hodges_lehmann(const cp_sample *sample, const unsigned *weight);

typedef struct cp_paired {
    size_t count;  /* pairs */
    size_t lower;  /* of these with a treatment below its baseline */
    size_t higher; /* above */
    double mean;   /* of the differences; NAN without any */
    cp_interval mean_interval;
    double hodges_lehmann; /* NAN without any */
    cp_interval hodges_lehmann_interval;
    cp_permutation_test signed_rank; /* Wilcoxon's V: sum of the ranks of |d| where d > 0, zeros
                                        left out; p by flipping the sign of whole replications */
} cp_paired;

/* Everything about paired differences; neither interval nor p of too few (cp_sample_too_few).
 * resampling: cluster_count[0] is the sample's, [1] is 0. permutations: of the test. Error:
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_paired_compare(const cp_sample *differences,
                                          const cp_resampling *resampling, size_t permutations,
                                          cp_paired *paired, cp_error *error);

#endif
