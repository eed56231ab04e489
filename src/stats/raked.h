/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_RAKED_H
#define STATS_RAKED_H

#include "stats/bootstrap.h"
#include "stats/raking.h"

/* Crashes of one variant or of two, weighted so that those of the first (the baseline) have the
 * margins of a population: rates, their ratio, quantiles of severity, with intervals by resampling
 * whole replications in which the weights are found anew each time, so that an interval holds what
 * the weights owe to chance. The population's margins are taken as known.
 *
 * Units of the second variant take the weight that the factors of the baseline give to their
 * classes. */

enum {
    CP_RAKED_EVENTS_MAX = 16,
    CP_RAKED_MEDIAN = 0, /* quantiles of severity */
    CP_RAKED_P90,
    CP_RAKED_QUANTILES
};

/* The units (frontally struck vehicles) of one variant, by ascending severity. All arrays are
 * borrowed. */
typedef struct cp_raked_arm {
    size_t count;
    const size_t *cluster; /* of each unit, < cluster_count */
    const cp_raking_classes *classes;
    const double *event; /* count x events, >= 0: what of each event the unit stands for (1 of "a
                            crash", the probability of an injury) */
    const double
        *severity;     /* ascending, -INFINITY: left-censored; of the first `severities` units */
    size_t severities; /* units with one; the others stand behind them */
    size_t cluster_count;
    const double *exposure; /* of each cluster, > 0 */
    const size_t *stratum;  /* of each cluster; NULL: one */
} cp_raked_arm;

typedef struct cp_raked {
    const cp_raking *raking; /* NULL: every weight is 1 */
    size_t events;           /* <= CP_RAKED_EVENTS_MAX */
    cp_raked_arm arm[2];     /* [0]: the baseline; [1].cluster_count 0: none */
} cp_raked;

typedef struct cp_raked_arm_figures {
    double effective;                 /* Kish's number of units */
    double rate[CP_RAKED_EVENTS_MAX]; /* weighted events per exposure */
    cp_interval rate_interval[CP_RAKED_EVENTS_MAX];
    double quantile[CP_RAKED_QUANTILES]; /* -INFINITY: left-censored, NAN: none */
    cp_interval quantile_interval[CP_RAKED_QUANTILES];
} cp_raked_arm_figures;

typedef struct cp_raked_figures {
    cp_raking_factors factors;
    cp_raked_arm_figures arm[2];
    double ratio[CP_RAKED_EVENTS_MAX]; /* [1] over [0], Mantel and Haenszel's over strata */
    cp_interval ratio_interval[CP_RAKED_EVENTS_MAX];
    double difference[CP_RAKED_QUANTILES]; /* [1] - [0] */
    cp_interval difference_interval[CP_RAKED_QUANTILES];
} cp_raked_figures;

/* Fewer effective units of the baseline than this give no interval when raked: classes of which a
 * sample that small has none by chance pull every figure, by more than resamples show. */
#define CP_RAKED_EFFECTIVE_MIN 40

/* And fewer than this, of the treatment than half of it, none of a quantile of severity. */
#define CP_RAKED_QUANTILE_EFFECTIVE_MIN 150

/* Effective numbers below which there is no interval of a quantile without raking:
 * CP_SAMPLE_OBSERVATIONS_MIN of the median, CP_CONTRAST_P90_OBSERVATIONS_MIN of the 90 % quantile;
 * and fewer than CP_SAMPLE_CLUSTERS_MIN clusters with any event give none of a rate or ratio.
 * Otherwise as cp_bootstrap. resampling: clusters, strata, pairing, repetitions, seed; its counts
 * must be those of the arms. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_raked_of(const cp_raked *raked, const cp_resampling *resampling,
                                    cp_raked_figures *figures, cp_error *error);

/* Weight of every unit of an arm by factors that were found, written to weight[count]; 1 without
 * raking. */
void cp_raked_weights(const cp_raked *raked, const cp_raking_factors *factors, int arm,
                      double *weight);

#endif
