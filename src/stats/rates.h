/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_RATES_H
#define STATS_RATES_H

#include "stats/bootstrap.h"

/* Crash rates: counts over exposure, replication by replication. */

/* Counts and exposures of the replications (clusters) of one variant. */
typedef struct cp_exposure {
    size_t cluster_count;
    const double *events;   /* of each replication, >= 0 */
    const double *exposure; /* of each replication, > 0, e.g. vehicle-km */
} cp_exposure;

/* Exact (Garwood 1936) interval of the mean of a Poisson count, by quantiles of the gamma
 * distribution. events >= 0 and whole; 0 < level < 1, e.g. 0.95. */
cp_interval cp_rate_garwood(double events, double level_1);

/* Dispersion index: squared deviations of the counts from what their exposure leads to expect, over
 * that expectation, per degree of freedom (Pearson); with equal exposures the variance over the
 * mean of the counts. 1 for Poisson, above 1 when replications differ, and then Garwood's interval
 * is too narrow. Each stratum (scenario) has a rate of its own; stratum may be NULL. NAN when no
 * stratum has two replications and an event. */
double cp_rate_dispersion(const cp_exposure *exposure, const size_t *stratum);

/* Events per exposure; NAN without exposure. */
double cp_rate(const cp_exposure *exposure);

/* Interval of a rate by resampling replications; stratum as in cp_resampling, may be NULL. */
CP_MUST_CHECK cp_status cp_rate_bootstrap(const cp_exposure *exposure, const size_t *stratum,
                                          uint64_t seed, cp_interval *interval, cp_error *error);

/* Rate of b over rate of a, with the interval that holds if counts are Poisson: conditional on
 * the sum of counts, exact (Clopper and Pearson 1934 on the binomial share). NAN without events of
 * a; high is +INFINITY likewise. */
double cp_rate_ratio(const cp_exposure *a, const cp_exposure *b);
cp_interval cp_rate_ratio_poisson(const cp_exposure *a, const cp_exposure *b, double level_1);

/* The ratio's interval by resampling; counts, strata and pairing in resampling. */
CP_MUST_CHECK cp_status cp_rate_ratio_bootstrap(const cp_exposure *a, const cp_exposure *b,
                                                const cp_resampling *resampling,
                                                cp_interval *interval, cp_error *error);

#endif
