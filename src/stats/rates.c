/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/rates.h"

#include "stats/sample.h"

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
    if (cp_rate_too_few(exposure)) {
        *interval = (cp_interval){CP_INTERVAL_TOO_FEW_CRASHES, NAN, NAN};
        return CP_OK;
    }
    return cp_bootstrap(&resampling, rate_statistic, exposure, interval, error);
}

bool cp_rate_too_few(const cp_exposure *exposure)
{
    size_t there = 0;
    for (size_t k = 0; k < exposure->cluster_count; k++)
        there += exposure->events[k] > 0.0;
    return there < CP_SAMPLE_CLUSTERS_MIN;
}

static size_t strata_of(const size_t *stratum, size_t count)
{
    size_t strata = 1;
    for (size_t k = 0; stratum && k < count; k++)
        strata = stratum[k] >= strata ? stratum[k] + 1 : strata;
    return strata;
}

/* Sums of one stratum. */
typedef struct cell {
    double events;
    double exposure;
    double members;
} cell;

static cell cell_of(const cp_exposure *e, const size_t *stratum, const unsigned *weight, size_t s)
{
    cell c = {0.0, 0.0, 0.0};
    for (size_t k = 0; k < e->cluster_count; k++) {
        if (stratum && stratum[k] != s)
            continue;
        double times = weight ? weight[k] : 1.0;
        c.events += times * e->events[k];
        c.exposure += times * e->exposure[k];
        c.members++;
    }
    return c;
}

/* Both arms in their strata; arm 0 is a. */
typedef struct arms {
    const cp_exposure *arm[2];
    const size_t *stratum[2];
    const unsigned *weight[2];
    size_t strata;
} arms;

static arms arms_of(const cp_exposure *a, const cp_exposure *b, const size_t *stratum_a,
                    const size_t *stratum_b)
{
    size_t of_a = strata_of(stratum_a, a->cluster_count);
    size_t of_b = strata_of(stratum_b, b->cluster_count);
    return (arms){{a, b}, {stratum_a, stratum_b}, {NULL, NULL}, of_a > of_b ? of_a : of_b};
}

/* What an arm counts in Mantel and Haenszel's ratio: sum of q y, its Poisson variance sum of q^2 y,
 * with q the other arm's share of the exposure of a stratum. */
typedef struct weighted_count {
    double sum;
    double variance;
} weighted_count;

static double share_of_other(const arms *x, size_t s, int g)
{
    double own = cell_of(x->arm[g], x->stratum[g], x->weight[g], s).exposure;
    double other = cell_of(x->arm[!g], x->stratum[!g], x->weight[!g], s).exposure;
    return own > 0.0 && other > 0.0 ? other / (own + other) : 0.0;
}

static weighted_count weighted_count_of(const arms *x, int g)
{
    weighted_count w = {0.0, 0.0};
    for (size_t s = 0; s < x->strata; s++) {
        double q = share_of_other(x, s, g);
        double events = cell_of(x->arm[g], x->stratum[g], x->weight[g], s).events;
        w.sum += q * events;
        w.variance += q * q * events;
    }
    return w;
}

static double ratio_of(const arms *x)
{
    double b = weighted_count_of(x, 1).sum, a = weighted_count_of(x, 0).sum;
    if (a > 0.0)
        return b / a;
    return b > 0.0 ? INFINITY : NAN;
}

double cp_rate_ratio(const cp_exposure *a, const cp_exposure *b, const size_t *stratum_a,
                     const size_t *stratum_b)
{
    arms x = arms_of(a, b, stratum_a, stratum_b);
    double ratio = ratio_of(&x);
    return isfinite(ratio) ? ratio : NAN;
}

static double ratio_statistic(const unsigned *weight_a, const unsigned *weight_b,
                              const void *context)
{
    arms x = *(const arms *)context;
    x.weight[0] = weight_a;
    x.weight[1] = weight_b;
    return ratio_of(&x);
}

cp_status cp_rate_ratio_bootstrap(const cp_exposure *a, const cp_exposure *b,
                                  const cp_resampling *resampling, cp_interval *interval,
                                  cp_error *error)
{
    if (cp_rate_too_few(a) || cp_rate_too_few(b)) {
        *interval = (cp_interval){CP_INTERVAL_TOO_FEW_CRASHES, NAN, NAN};
        return CP_OK;
    }
    arms x = arms_of(a, b, resampling->stratum[0], resampling->stratum[1]);
    return cp_bootstrap(resampling, ratio_statistic, &x, interval, error);
}

// ---- intervals widened by what counts scatter ------------------------------------------------

/* Scatter of counts around what their stratum's rate leads to expect. */
typedef struct scatter {
    double variance; /* of the sum, over strata of two replications or more */
    double poisson;  /* what Poisson counts would have there */
    double freedom;
} scatter;

static cp_widening widening_of(scatter s, double level_1)
{
    cp_widening w = {NAN, s.freedom, 1.0};
    if (!(s.poisson > 0.0) || s.freedom < 1.0)
        return w;
    double tail = 0.5 * (1.0 + level_1);
    double t = gsl_cdf_tdist_Pinv(tail, s.freedom) / gsl_cdf_ugaussian_Pinv(tail);
    w.dispersion_1 = s.variance / s.poisson;
    w.factor_1 = fmax(1.0, w.dispersion_1 * t * t);
    return w;
}

// Events of a stratum's replications around its rate, each times q.
static void add_scatter(const cp_exposure *e, const size_t *stratum, size_t s, double q,
                        scatter *sum)
{
    cell c = cell_of(e, stratum, NULL, s);
    if (c.members < 2.0 || c.exposure <= 0.0)
        return;
    double squares = 0.0;
    for (size_t k = 0; k < e->cluster_count; k++) {
        double apart = e->events[k] - c.events * e->exposure[k] / c.exposure;
        squares += stratum && stratum[k] != s ? 0.0 : apart * apart;
    }
    sum->variance += q * q * squares * c.members / (c.members - 1.0);
    sum->poisson += q * q * c.events;
    sum->freedom += c.members - 1.0;
}

// Of a Poisson mean with the middle of the two tails a count lies between (mid-P): exact intervals
// hold more than they promise by the leaps of a distribution function that is not continuous.
static double middle_gamma(double mean, double events, double unused)
{
    (void)unused;
    double above = gsl_cdf_gamma_P(mean, events + 1.0, 1.0);
    return 0.5 * (above + (events > 0.0 ? gsl_cdf_gamma_P(mean, events, 1.0) : 1.0));
}

static cp_interval middle_poisson(double events, double level_1)
{
    if (events > 1e5)
        return cp_rate_garwood(events, level_1);
    double tail = 0.5 * (1.0 - level_1), reach = 12.0 * sqrt(events + 1.0) + 30.0;
    double least = fmax(0.0, events - reach), most = events + 1.0 + reach;
    double low = events > 0.0 ? quantile(middle_gamma, tail, events, 0.0, least, most) : 0.0;
    double high = quantile(middle_gamma, 1.0 - tail, events, 0.0, least, most);
    return (cp_interval){CP_INTERVAL_VALUE, low, high};
}

// The same of a binomial share: b of a + b.
static double middle_beta(double share, double events_b, double events_a)
{
    double low = events_b > 0.0 ? gsl_cdf_beta_P(share, events_b, events_a + 1.0) : 1.0;
    double high = events_a > 0.0 ? gsl_cdf_beta_P(share, events_b + 1.0, events_a) : 0.0;
    return 0.5 * (low + high);
}

static cp_interval middle_share(double events_b, double events_a, double level_1)
{
    double tail = 0.5 * (1.0 - level_1);
    double low = events_b > 0.0 ? quantile(middle_beta, tail, events_b, events_a, 0.0, 1.0) : 0.0;
    double high =
        events_a > 0.0 ? quantile(middle_beta, 1.0 - tail, events_b, events_a, 0.0, 1.0) : 1.0;
    return (cp_interval){CP_INTERVAL_VALUE, low, high};
}

cp_interval cp_rate_widened(const cp_exposure *exposure, const size_t *stratum, double level_1,
                            cp_widening *widening)
{
    scatter sum = {0.0, 0.0, 0.0};
    for (size_t s = 0; s < strata_of(stratum, exposure->cluster_count); s++)
        add_scatter(exposure, stratum, s, 1.0, &sum);
    *widening = widening_of(sum, level_1);
    double events = weighted_sum(exposure->events, NULL, exposure->cluster_count);
    double total = weighted_sum(exposure->exposure, NULL, exposure->cluster_count);
    if (!(total > 0.0))
        return (cp_interval){CP_INTERVAL_UNDEFINED, NAN, NAN};
    cp_interval interval = middle_poisson(events / widening->factor_1, level_1);
    interval.low *= widening->factor_1 / total;
    interval.high *= widening->factor_1 / total;
    return interval;
}

// Scatter of the logarithm of the ratio: of a pair's two counts together when paired.
static scatter scatter_of_ratio(const arms *x, const weighted_count w[2], bool paired)
{
    scatter arm[2] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    double common = 0.0;
    for (size_t s = 0; s < x->strata; s++) {
        double q[2] = {share_of_other(x, s, 0), share_of_other(x, s, 1)};
        for (int g = 0; g < 2; g++)
            if (w[g].sum > 0.0)
                add_scatter(x->arm[g], x->stratum[g], s, q[g] / w[g].sum, &arm[g]);
        if (!paired || !(w[0].sum > 0.0) || !(w[1].sum > 0.0))
            continue;
        // Twice the covariance of the deviations of a pair.
        cell c[2] = {cell_of(x->arm[0], x->stratum[0], NULL, s),
                     cell_of(x->arm[1], x->stratum[1], NULL, s)};
        double products = 0.0;
        for (size_t k = 0; k < x->arm[0]->cluster_count; k++) {
            if (x->stratum[0] && x->stratum[0][k] != s)
                continue;
            double apart[2];
            for (int g = 0; g < 2; g++)
                apart[g] =
                    x->arm[g]->events[k] - c[g].events * x->arm[g]->exposure[k] / c[g].exposure;
            products += apart[0] * apart[1];
        }
        if (c[0].members >= 2.0)
            common += 2.0 * q[0] * q[1] / (w[0].sum * w[1].sum) * products * c[0].members /
                      (c[0].members - 1.0);
    }
    double sum = arm[0].variance + arm[1].variance;
    double freedom = arm[0].freedom;
    if (!paired && sum > 0.0)
        freedom = sum * sum /
                  (arm[0].variance * arm[0].variance / fmax(1.0, arm[0].freedom) +
                   arm[1].variance * arm[1].variance / fmax(1.0, arm[1].freedom));
    return (scatter){fmax(0.0, sum - common), arm[0].poisson + arm[1].poisson, freedom};
}

// Given the sum, b's count is binomial with share s; the ratio is s/(1-s) over the exposures.
static cp_interval ratio_of_shares(cp_interval share, double events_a, double events_b,
                                   double scale, double level_1)
{
    if (isnan(share.low) || isnan(share.high)) {
        // Millions of events: the normal interval of the log ratio is exact to their inverse.
        double reach =
            gsl_cdf_ugaussian_Pinv(0.5 * (1.0 + level_1)) * sqrt(1.0 / events_a + 1.0 / events_b);
        double ratio = scale * events_b / events_a;
        return (cp_interval){CP_INTERVAL_VALUE, ratio * exp(-reach), ratio * exp(reach)};
    }
    return (cp_interval){CP_INTERVAL_VALUE, scale * share.low / (1.0 - share.low),
                         share.high < 1.0 ? scale * share.high / (1.0 - share.high) : INFINITY};
}

cp_interval cp_rate_ratio_poisson(const cp_exposure *a, const cp_exposure *b, double level_1)
{
    double events_a = weighted_sum(a->events, NULL, a->cluster_count);
    double events_b = weighted_sum(b->events, NULL, b->cluster_count);
    double exposure_a = weighted_sum(a->exposure, NULL, a->cluster_count);
    double exposure_b = weighted_sum(b->exposure, NULL, b->cluster_count);
    if (events_a + events_b <= 0.0 || exposure_a <= 0.0 || exposure_b <= 0.0)
        return (cp_interval){CP_INTERVAL_UNDEFINED, NAN, NAN};
    double tail = 0.5 * (1.0 - level_1);
    cp_interval share = {CP_INTERVAL_VALUE, 0.0, 1.0};
    if (events_b > 0.0)
        share.low = quantile(gsl_cdf_beta_P, tail, events_b, events_a + 1.0, 0.0, 1.0);
    if (events_a > 0.0)
        share.high = quantile(gsl_cdf_beta_P, 1.0 - tail, events_b + 1.0, events_a, 0.0, 1.0);
    return ratio_of_shares(share, events_a, events_b, exposure_a / exposure_b, level_1);
}

cp_interval cp_rate_ratio_widened(const cp_exposure *a, const cp_exposure *b,
                                  const cp_resampling *resampling, cp_widening *widening)
{
    arms x = arms_of(a, b, resampling->stratum[0], resampling->stratum[1]);
    weighted_count w[2] = {weighted_count_of(&x, 0), weighted_count_of(&x, 1)};
    *widening = widening_of(scatter_of_ratio(&x, w, resampling->paired), resampling->level_1);
    double exposure[2] = {weighted_sum(a->exposure, NULL, a->cluster_count),
                          weighted_sum(b->exposure, NULL, b->cluster_count)};
    if (!(w[0].sum + w[1].sum > 0.0) || !(exposure[0] > 0.0) || !(exposure[1] > 0.0))
        return (cp_interval){CP_INTERVAL_UNDEFINED, NAN, NAN};

    // Counts that have the relative variance of each weighted sum.
    double events[2];
    for (int g = 0; g < 2; g++)
        events[g] = w[g].sum > 0.0 ? w[g].sum * w[g].sum / w[g].variance : 0.0;
    double scale = events[0] > 0.0 && events[1] > 0.0 ? w[1].sum / w[0].sum * events[0] / events[1]
                                                      : exposure[0] / exposure[1];
    for (int g = 0; g < 2; g++)
        events[g] /= widening->factor_1;
    cp_interval share = middle_share(events[1], events[0], resampling->level_1);
    return ratio_of_shares(share, events[0], events[1], scale, resampling->level_1);
}

cp_interval cp_share_widened(const cp_exposure *share, const size_t *stratum, double least_factor_1,
                             double level_1, cp_widening *widening)
{
    scatter sum = {0.0, 0.0, 0.0};
    for (size_t s = 0; s < strata_of(stratum, share->cluster_count); s++)
        add_scatter(share, stratum, s, 1.0, &sum);
    double events = weighted_sum(share->events, NULL, share->cluster_count);
    double trials = weighted_sum(share->exposure, NULL, share->cluster_count);
    // A share's trials scatter less than Poisson counts: n p (1 - p).
    sum.poisson *= trials > 0.0 ? 1.0 - events / trials : 0.0;
    *widening = widening_of(sum, level_1);
    if (!(trials > 0.0))
        return (cp_interval){CP_INTERVAL_UNDEFINED, NAN, NAN};
    widening->factor_1 = fmax(widening->factor_1, least_factor_1);
    double n = trials / widening->factor_1, x = events / widening->factor_1;
    return middle_share(x, n - x, level_1);
}
