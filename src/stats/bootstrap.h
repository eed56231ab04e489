/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_BOOTSTRAP_H
#define STATS_BOOTSTRAP_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Confidence intervals by resampling whole clusters (replications): values of one replication are
 * not independent. Bias-corrected and accelerated (BCa, Efron 1987), and expanded for few clusters
 * (Hesterberg 2015, "What teachers should know about the bootstrap", section 5.2): in place of the
 * normal quantile z stands sqrt(n / f) t(f), with n clusters of the smaller group and f = n minus
 * its strata degrees of freedom. How well they cover: tests/stats/coverage.md. */

/* Fewer clusters than this in either group give no interval: its coverage cannot be trusted. Nor
 * does a stratum of one cluster, which shows no scatter. */
#define CP_BOOTSTRAP_CLUSTERS_MIN 20

/* X(name, text in results). */
#define CP_INTERVAL_STATUSES(X)                                                                    \
    X(CP_INTERVAL_UNDEFINED, "undefined")                                                          \
    X(CP_INTERVAL_VALUE, "value")                                                                  \
    X(CP_INTERVAL_TOO_FEW_REPLICATIONS, "too few replications")                                    \
    X(CP_INTERVAL_TOO_FEW_CRASHES, "too few crashes")                                              \
    X(CP_INTERVAL_ALL_ALIKE, "no scatter")                                                         \
    X(CP_INTERVAL_CENSORED, "left-censored")

typedef enum cp_interval_status {
#define CP_INTERVAL_NAME(name, text) name,
    CP_INTERVAL_STATUSES(CP_INTERVAL_NAME)
#undef CP_INTERVAL_NAME
} cp_interval_status;

typedef struct cp_interval {
    cp_interval_status status;
    double
        low; /* NAN unless status is CP_INTERVAL_VALUE; -INFINITY where censoring leaves it open */
    double high; /* likewise, +INFINITY */
} cp_interval;

const char *cp_interval_status_text(cp_interval_status status);

/* The clusters of one group or of two to be compared. */
typedef struct cp_resampling {
    size_t cluster_count[2];  /* [1] = 0: one group only */
    const size_t *stratum[2]; /* of each cluster (its scenario); NULL: one stratum. Clusters are
                                 drawn within their stratum, whose size is fixed by design */
    bool paired;              /* cluster k of both groups ran the same seed and is drawn together;
                                 then both counts and strata are equal */
    size_t informative[2];    /* clusters that have an observation, from which few-cluster reach is
                                 taken; 0 (default): all of them */
    size_t repetitions;       /* default 2000 */
    uint64_t seed;
    double level_1; /* of confidence, default 0.95 */
    bool expanded;  /* for few clusters, default true; false: BCa as published */
} cp_resampling;

/* All fields at their defaults, no clusters, seed 1. */
cp_resampling cp_resampling_default(void);

/* A statistic of the resample in which cluster k of group g occurs weight_g[k] times. NAN where it
 * does not exist (nothing was drawn); +-INFINITY where censoring leaves it open. weight_b is NULL
 * for one group. */
typedef double (*cp_statistic)(const unsigned *weight_a, const unsigned *weight_b,
                               const void *context);

/* Several statistics of one resample at once, written to value[0 ... count - 1]; like cp_statistic
 * each. */
typedef void (*cp_statistics)(const unsigned *weight_a, const unsigned *weight_b,
                              const void *context, double *value);

/* The intervals of count >= 1 statistics from the same resamples. Each is the same as from
 * cp_bootstrap. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_bootstrap_many(const cp_resampling *resampling, cp_statistics statistics,
                                          size_t count, const void *context, cp_interval *interval,
                                          cp_error *error);

/* What to do with one resample; weight_b as for a statistic. */
typedef void (*cp_draw)(void *context, const unsigned *weight_a, const unsigned *weight_b);

/* The resamples alone, one call of draw each: those of the intervals above for the same resampling.
 * scale (may be NULL): sqrt(n / f), by which what is resampled scatters too little, f clusters
 * minus strata, the larger of the groups; INFINITY when a group has no freedom. Error:
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_bootstrap_draws(const cp_resampling *resampling, cp_draw draw,
                                           void *context, double *scale, cp_error *error);

/* CP_INTERVAL_VALUE when the groups have clusters enough for a bootstrap, else why not. */
cp_interval_status cp_bootstrap_allowed(const cp_resampling *resampling);

/* The interval of a statistic. The same input gives the same bits. Undefined when the statistic
 * itself, or more than one resample in twenty, does not exist, or when all resamples agree on one
 * side of the estimate; CP_INTERVAL_ALL_ALIKE when more than half of them are the estimate itself:
 * then the resamples show no scatter to go by. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_bootstrap(const cp_resampling *resampling, cp_statistic statistic,
                                     const void *context, cp_interval *interval, cp_error *error);

#endif
