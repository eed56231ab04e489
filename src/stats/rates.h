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

/* Interval of a rate by resampling replications; stratum as in cp_resampling, may be NULL. None
 * when too few replications have events. */
CP_MUST_CHECK cp_status cp_rate_bootstrap(const cp_exposure *exposure, const size_t *stratum,
                                          uint64_t seed, cp_interval *interval, cp_error *error);

/* How much more counts scatter over replications than Poisson counts do, and what it makes of an
 * interval that trusts the Poisson law. */
typedef struct cp_widening {
    double dispersion_1; /* variance over that of Poisson counts, from deviations within strata; NAN
                            when no stratum has two replications and an event */
    double freedom;      /* of it */
    double factor_1;     /* by which the variance is taken for larger: dispersion (t / z)^2 with the
                            quantiles of Student's t and of the normal distribution, at least 1; 1
                            when the dispersion is unknown */
} cp_widening;

/* Garwood's interval of the rate, of events / factor counts: it holds for counts that scatter more
 * than Poisson's, from any number of replications and events. stratum may be NULL. Undefined
 * without exposure. Coverage: tests/stats/null_study.md. */
cp_interval cp_rate_widened(const cp_exposure *exposure, const size_t *stratum, double level_1,
                            cp_widening *widening);

/* Rate of b over rate of a, in strata: Mantel and Haenszel's ratio (Rothman 1986: sum of y_b X_a /
 * (X_a + X_b) over sum of y_a X_b / (X_a + X_b)); strata may be NULL, and with one of them it is
 * the ratio of the two rates. NAN without events of a. */
double cp_rate_ratio(const cp_exposure *a, const cp_exposure *b, const size_t *stratum_a,
                     const size_t *stratum_b);

/* The interval that holds if counts are Poisson: conditional on the sum of counts, exact (Clopper
 * and Pearson 1934 on the binomial share), over everything. high is +INFINITY without events of a;
 * undefined without any. */
cp_interval cp_rate_ratio_poisson(const cp_exposure *a, const cp_exposure *b, double level_1);

/* The same around Mantel and Haenszel's ratio with both counts divided by the factor of the ratio's
 * own variance (with what paired replications have in common taken off, but never below
 * Poisson's). Counts, strata, pairing, level in resampling. */
cp_interval cp_rate_ratio_widened(const cp_exposure *a, const cp_exposure *b,
                                  const cp_resampling *resampling, cp_widening *widening);

/* Share of events in trials, both summed over replications: Clopper and Pearson's interval of
 * counts divided by the factor (Korn and Graubard 1998). least_factor_1: at least this, for events
 * of which too few happened to show how they scatter; 1 without. */
cp_interval cp_share_widened(const cp_exposure *share, const size_t *stratum, double least_factor_1,
                             double level_1, cp_widening *widening);

/* Whether the events lie in too few replications, or are too few, for resamples to show how they
 * scatter: fewer than CP_SAMPLE_CLUSTERS_MIN replications with any. */
bool cp_rate_too_few(const cp_exposure *exposure);

/* The ratio's interval by resampling; counts, strata and pairing in resampling. None when too few
 * replications of either have events. */
CP_MUST_CHECK cp_status cp_rate_ratio_bootstrap(const cp_exposure *a, const cp_exposure *b,
                                                const cp_resampling *resampling,
                                                cp_interval *interval, cp_error *error);

#endif
