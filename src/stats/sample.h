/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_SAMPLE_H
#define STATS_SAMPLE_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>

/* Observations that come in clusters: all values of one replication belong together, and
 * replications, not values, are what is resampled. Clusters without a value (a replication without
 * a crash) count too.
 *
 * A left-censored observation (known only to lie below every value) is -INFINITY: it sorts first,
 * takes part in ranks, quantiles and distribution functions, and not in means. */
typedef struct cp_sample {
    size_t count;
    double *value;   /* ascending, finite or -INFINITY */
    size_t *cluster; /* of each value, < cluster_count */
    size_t cluster_count;
} cp_sample;

/* Copy and sort count observations. The caller destroys. Errors: CP_NO_MEMORY; CP_BAD_INPUT for a
 * value that is NAN or +INFINITY or a cluster out of range. */
CP_MUST_CHECK cp_status cp_sample_create(const double *value, const size_t *cluster, size_t count,
                                         size_t cluster_count, cp_sample *sample, cp_error *error);
/* A zero-initialised sample is fine too. */
void cp_sample_destroy(cp_sample *sample);

/* Fewer observations than this, or fewer clusters that have any, are too few for an interval or a
 * test: what resamples or jackknife show of their scatter cannot be trusted. */
#define CP_SAMPLE_OBSERVATIONS_MIN 8
#define CP_SAMPLE_CLUSTERS_MIN 5

/* Whether a sample has too few of either. */
bool cp_sample_too_few(const cp_sample *sample);

/* Clusters that have an observation. */
size_t cp_sample_informative(const cp_sample *sample);

/* Number of censored observations. */
size_t cp_sample_censored(const cp_sample *sample);

/* The functions below take the weight of each cluster, how often it occurs in a resample; NULL
 * means once each. So no resample is ever copied or sorted again. */

/* Observations, censored ones included. */
size_t cp_sample_weighted_count(const cp_sample *sample, const unsigned *weight);

/* Mean of the finite values; NAN when there are none. */
double cp_sample_mean(const cp_sample *sample, const unsigned *weight);

/* Quantile by linear interpolation between order statistics (Hyndman and Fan's type 7, R's
 * default); -INFINITY when it falls among censored observations, NAN of nothing. 0 <= p <= 1. */
double cp_sample_quantile(const cp_sample *sample, const unsigned *weight, double p);

/* Cliff's delta = P(b > a) - P(b < a), -1 ... 1, censored observations tied with each other; NAN
 * when either is empty. */
double cp_sample_cliffs_delta(const cp_sample *a, const unsigned *weight_a, const cp_sample *b,
                              const unsigned *weight_b);

#endif
