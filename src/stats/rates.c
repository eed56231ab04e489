/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/rates.h"

#include <gsl/gsl_cdf.h>

#include <math.h>

/* A distribution function of x with two parameters. */
typedef double (*cdf)(double x, double a, double b);

// Where a distribution function reaches p, by bisection to neighbouring doubles: GSL's own inverses
// of gamma and beta give up on counts of some ten thousand. NAN where the function does not exist.
static double quantile(cdf function, double p, double a, double b, double low, double high)
{
    for (;;) {
        double middle = 0.5 * low + 0.5 * high;
        if (!(middle > low && middle < high))
            return high;
        double reached = function(middle, a, b);
        if (isnan(reached))
            return NAN;
        if (reached >= p)
            high = middle;
        else
            low = middle;
    }
}

cp_interval cp_rate_garwood(double events, double level_1)
{
    if (events > 1e5) {
        // Wilson and Hilferty 1931, exact to some 1e-9 of itself for such counts; GSL has no gamma
        // distribution function far from the mean of millions.
        double z = gsl_cdf_ugaussian_Pinv(0.5 * (1.0 + level_1)), n = events + 1.0;
        double low = events * pow(1.0 - 1.0 / (9.0 * events) - z / (3.0 * sqrt(events)), 3.0);
        double high = n * pow(1.0 - 1.0 / (9.0 * n) + z / (3.0 * sqrt(n)), 3.0);
        return (cp_interval){CP_INTERVAL_VALUE, low, high};
    }
    // Brackets of 12 standard deviations: far outside, GSL cannot evaluate the function either.
    double tail = 0.5 * (1.0 - level_1), reach = 12.0 * sqrt(events + 1.0) + 30.0;
    double least = fmax(0.0, events - reach), most = events + 1.0 + reach;
    double low = events > 0.0 ? quantile(gsl_cdf_gamma_P, tail, events, 1.0, least, most) : 0.0;
    double high = quantile(gsl_cdf_gamma_P, 1.0 - tail, events + 1.0, 1.0, least, most);
    return (cp_interval){CP_INTERVAL_VALUE, low, high};
}

double cp_rate_dispersion(const cp_exposure *exposure, const size_t *stratum)
{
    size_t strata = 1;
    for (size_t k = 0; stratum && k < exposure->cluster_count; k++)
        strata = stratum[k] >= strata ? stratum[k] + 1 : strata;

    // Every stratum adds its deviations and takes one degree of freedom for its rate.
    double deviations = 0.0, freedom = 0.0;
    for (size_t s = 0; s < strata; s++) {
        double events = 0.0, total = 0.0, members = 0.0, sum = 0.0;
        for (size_t k = 0; k < exposure->cluster_count; k++) {
            if (stratum && stratum[k] != s)
                continue;
            events += exposure->events[k];
            total += exposure->exposure[k];
            members++;
        }
        if (events <= 0.0 || total <= 0.0 || members < 2.0)
            continue;
        for (size_t k = 0; k < exposure->cluster_count; k++) {
            double expected = events * exposure->exposure[k] / total;
            if ((!stratum || stratum[k] == s) && expected > 0.0)
                sum +=
                    (exposure->events[k] - expected) * (exposure->events[k] - expected) / expected;
        }
        deviations += sum;
        freedom += members - 1.0;
    }
    return freedom > 0.0 ? deviations / freedom : NAN;
}

static double weighted_sum(const double *values, const unsigned *weight, size_t count)
{
    double sum = 0.0;
    for (size_t k = 0; k < count; k++)
        sum += (weight ? weight[k] : 1) * values[k];
    return sum;
}

static double weighted_rate(const cp_exposure *e, const unsigned *weight)
{
    double exposure = weighted_sum(e->exposure, weight, e->cluster_count);
    return exposure > 0.0 ? weighted_sum(e->events, weight, e->cluster_count) / exposure : NAN;
}

double cp_rate(const cp_exposure *exposure)
{
    return weighted_rate(exposure, NULL);
}

static double rate_statistic(const unsigned *weight_a, const unsigned *weight_b,
                             const void *context)
{
    (void)weight_b;
    return weighted_rate(context, weight_a);
}

cp_status cp_rate_bootstrap(const cp_exposure *exposure, const size_t *stratum, uint64_t seed,
                            cp_interval *interval, cp_error *error)
{
    cp_resampling resampling = cp_resampling_default();
    resampling.cluster_count[0] = exposure->cluster_count;
    resampling.stratum[0] = stratum;
    resampling.seed = seed;
    return cp_bootstrap(&resampling, rate_statistic, exposure, interval, error);
}

double cp_rate_ratio(const cp_exposure *a, const cp_exposure *b)
{
    double rate_a = cp_rate(a);
    return rate_a > 0.0 ? cp_rate(b) / rate_a : NAN;
}

cp_interval cp_rate_ratio_poisson(const cp_exposure *a, const cp_exposure *b, double level_1)
{
    double events_a = weighted_sum(a->events, NULL, a->cluster_count);
    double events_b = weighted_sum(b->events, NULL, b->cluster_count);
    double exposure_a = weighted_sum(a->exposure, NULL, a->cluster_count);
    double exposure_b = weighted_sum(b->exposure, NULL, b->cluster_count);
    if (events_a + events_b <= 0.0 || exposure_a <= 0.0 || exposure_b <= 0.0)
        return (cp_interval){CP_INTERVAL_UNDEFINED, NAN, NAN};

    // Given the sum, b's count is binomial with share s; the ratio is s/(1-s) over the exposures.
    double tail = 0.5 * (1.0 - level_1);
    double low =
        events_b > 0.0 ? quantile(gsl_cdf_beta_P, tail, events_b, events_a + 1.0, 0.0, 1.0) : 0.0;
    double high = events_a > 0.0
                      ? quantile(gsl_cdf_beta_P, 1.0 - tail, events_b + 1.0, events_a, 0.0, 1.0)
                      : 1.0;
    double scale = exposure_a / exposure_b;
    if (isnan(low) || isnan(high)) {
        // Millions of events: the normal interval of the log ratio is exact to their inverse.
        double reach = gsl_cdf_ugaussian_Pinv(1.0 - tail) * sqrt(1.0 / events_a + 1.0 / events_b);
        double ratio = scale * events_b / events_a;
        return (cp_interval){CP_INTERVAL_VALUE, ratio * exp(-reach), ratio * exp(reach)};
    }
    return (cp_interval){CP_INTERVAL_VALUE, scale * low / (1.0 - low),
                         high < 1.0 ? scale * high / (1.0 - high) : INFINITY};
}

static double ratio_statistic(const unsigned *weight_a, const unsigned *weight_b,
                              const void *context)
{
    const cp_exposure *const *pair = context;
    double rate_a = weighted_rate(pair[0], weight_a);
    double rate_b = weighted_rate(pair[1], weight_b);
    if (rate_a > 0.0)
        return rate_b / rate_a;
    return rate_b > 0.0 ? INFINITY : NAN;
}

cp_status cp_rate_ratio_bootstrap(const cp_exposure *a, const cp_exposure *b,
                                  const cp_resampling *resampling, cp_interval *interval,
                                  cp_error *error)
{
    const cp_exposure *pair[2] = {a, b};
    return cp_bootstrap(resampling, ratio_statistic, pair, interval, error);
}
