/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_DESCRIBE_H
#define STATS_DESCRIBE_H

#include "stats/sample.h"

/* A figure that censoring may leave known only from one side: "<1.9" is CP_LESS_THAN 1.9. */
typedef enum cp_relation { CP_NO_VALUE, CP_EXACTLY, CP_LESS_THAN, CP_MORE_THAN } cp_relation;

typedef struct cp_estimate {
    cp_relation relation;
    double value; /* NAN for CP_NO_VALUE */
} cp_estimate;

/* Quantile p of a sample: CP_LESS_THAN the smallest value when it falls among censored
 * observations, CP_NO_VALUE when there is no value at all. */
cp_estimate cp_describe_quantile(const cp_sample *sample, double p);

/* A value known exactly; CP_NO_VALUE for NAN. */
cp_estimate cp_estimate_of(double value);

/* b - a: one-sided when one is, CP_NO_VALUE when both are (or there is none). */
cp_estimate cp_estimate_difference(cp_estimate a, cp_estimate b);

/* The usual figures of a distribution. */
typedef struct cp_description {
    size_t count;            /* observations, censored ones included */
    size_t censored;         /* of these */
    double mean;             /* of the count - censored values; NAN without any */
    double sd;               /* likewise, n - 1; NAN under two */
    cp_estimate mean_of_all; /* censored ones too: CP_LESS_THAN what it is with each of them at the
                                smallest value, below which they lie */
    cp_estimate minimum;
    cp_estimate q25;
    cp_estimate median;
    cp_estimate q75;
    cp_estimate p90;
    cp_estimate p95;
    cp_estimate maximum;
} cp_description;

cp_description cp_describe(const cp_sample *sample);

/* Empirical distribution function: share of observations <= x; starts at the censored share. NAN
 * of nothing. */
double cp_ecdf(const cp_sample *sample, double x);

#endif
