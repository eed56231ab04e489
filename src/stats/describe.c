/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/describe.h"

#include <gsl/gsl_statistics_double.h>

#include <math.h>

cp_estimate cp_describe_quantile(const cp_sample *sample, double p)
{
    size_t censored = cp_sample_censored(sample);
    if (censored == sample->count)
        return (cp_estimate){CP_NO_VALUE, NAN};
    double quantile = cp_sample_quantile(sample, NULL, p);
    if (isinf(quantile))
        return (cp_estimate){CP_LESS_THAN, sample->value[censored]};
    return (cp_estimate){CP_EXACTLY, quantile};
}

cp_estimate cp_estimate_of(double value)
{
    return (cp_estimate){isnan(value) ? CP_NO_VALUE : CP_EXACTLY, value};
}

cp_estimate cp_estimate_difference(cp_estimate a, cp_estimate b)
{
    // Two one-sided figures, or one that is missing, leave the difference open to both sides.
    if (a.relation == CP_NO_VALUE || b.relation == CP_NO_VALUE ||
        (a.relation != CP_EXACTLY && b.relation != CP_EXACTLY))
        return (cp_estimate){CP_NO_VALUE, NAN};
    cp_relation relation = b.relation;
    if (a.relation == CP_LESS_THAN)
        relation = CP_MORE_THAN;
    if (a.relation == CP_MORE_THAN)
        relation = CP_LESS_THAN;
    return (cp_estimate){relation, b.value - a.value};
}

static cp_estimate mean_of_all(const cp_sample *sample)
{
    size_t censored = cp_sample_censored(sample), values = sample->count - censored;
    if (values == 0)
        return (cp_estimate){CP_NO_VALUE, NAN};
    double mean = gsl_stats_mean(sample->value + censored, 1, values);
    if (censored == 0)
        return (cp_estimate){CP_EXACTLY, mean};
    double share = (double)censored / (double)sample->count;
    return (cp_estimate){CP_LESS_THAN, (1.0 - share) * mean + share * sample->value[censored]};
}

cp_description cp_describe(const cp_sample *sample)
{
    size_t censored = cp_sample_censored(sample);
    size_t values = sample->count - censored;
    return (cp_description){
        .count = sample->count,
        .censored = censored,
        .mean = values ? gsl_stats_mean(sample->value + censored, 1, values) : NAN,
        .sd = values > 1 ? gsl_stats_sd(sample->value + censored, 1, values) : NAN,
        .mean_of_all = mean_of_all(sample),
        .minimum = cp_describe_quantile(sample, 0.0),
        .q25 = cp_describe_quantile(sample, 0.25),
        .median = cp_describe_quantile(sample, 0.5),
        .q75 = cp_describe_quantile(sample, 0.75),
        .p90 = cp_describe_quantile(sample, 0.9),
        .p95 = cp_describe_quantile(sample, 0.95),
        .maximum = cp_describe_quantile(sample, 1.0),
    };
}

double cp_ecdf(const cp_sample *sample, double x)
{
    if (sample->count == 0)
        return NAN;
    // Bisection for the number of observations <= x.
    size_t low = 0, high = sample->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (sample->value[middle] <= x)
            low = middle + 1;
        else
            high = middle;
    }
    return (double)low / (double)sample->count;
}
