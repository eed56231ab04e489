/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TESTS_STATS_NULL_STUDY_H
#define TESTS_STATS_NULL_STUDY_H

#include "builders/simulated_study.h"
#include "stats/contrast.h"
#include "stats/paired.h"
#include "stats/permutation.h"

/* Studies with known truth, shared by the long program and by its short version in the suite: how
 * often each test rejects what is true, and how often each interval holds it. Severity is the same
 * in both variants; their crash rates are not. */

/* X(name, text, a test (else an interval), an earlier method kept for comparison). */
#define NULL_FIGURES(X)                                                                            \
    X(NULL_SEVERITY, "severity", true, false)                                                      \
    X(NULL_SEVERITY_OLD, "old: Mann–Whitney, permuted", true, true)                                \
    X(NULL_DISTANCE, "distance", true, false)                                                      \
    X(NULL_DISTANCE_OLD, "old: KS, permuted", true, true)                                          \
    X(NULL_RATE, "rate", true, false)                                                              \
    X(NULL_DELTA, "δ", false, false)                                                               \
    X(NULL_MEDIAN, "median", false, false)                                                         \
    X(NULL_MEAN, "mean", false, false)                                                             \
    X(NULL_P90, "90 %", false, false)                                                              \
    X(NULL_RATIO, "ratio", false, false)                                                           \
    X(NULL_RATIO_OLD, "old: ratio, bootstrap or Poisson", false, true)                             \
    X(NULL_ONE_RATE, "rate of treatment", false, false)                                            \
    X(NULL_ONE_RATE_OLD, "old: the same", false, true)

enum {
#define NULL_NAME(name, text, test, old) name,
    NULL_FIGURES(NULL_NAME)
#undef NULL_NAME
        NULL_COUNT
};

static const char *const NULL_TEXT[NULL_COUNT] = {
#define NULL_TEXT_OF(name, text, test, old) text,
    NULL_FIGURES(NULL_TEXT_OF)
#undef NULL_TEXT_OF
};

static const bool NULL_IS_TEST[NULL_COUNT] = {
#define NULL_TEST_OF(name, text, test, old) test,
    NULL_FIGURES(NULL_TEST_OF)
#undef NULL_TEST_OF
};

static const bool NULL_IS_OLD[NULL_COUNT] = {
#define NULL_OLD_OF(name, text, test, old) old,
    NULL_FIGURES(NULL_OLD_OF)
#undef NULL_OLD_OF
};

/* Over the studies of a cell. */
typedef struct null_counts {
    double given[NULL_COUNT]; /* a p or an interval was given */
    double hits[NULL_COUNT];  /* of these rejected at 5 %, or held the truth */
} null_counts;

/* What relabelling whole replications does to the two rank statistics: the method of before, right
 * while both variants have alike numbers of crashes. */
static inline void null_old_tests(const cp_sample *a, const cp_sample *b, const cp_resampling *r,
                                  size_t permutations, double p[2])
{
    cp_permutation permutation;
    cp_error error = {0};
    if (cp_permutation_create(r, &permutation, &error) != CP_OK)
        abort();
    double observed[2] = {NAN, NAN}, extreme[2] = {0.0, 0.0}, valid = 0.0;
    for (size_t number = 0; number <= permutations; number++) {
        cp_permutation_set(&permutation, number);
        double size[2] = {0.0, 0.0}, passed[2] = {0.0, 0.0}, u = 0.0, ks = 0.0;
        for (size_t k = 0; k < a->count + b->count; k++) {
            bool of_a = k < a->count;
            size[permutation
                     .label[of_a ? a->cluster[k] : a->cluster_count + b->cluster[k - a->count]]]++;
        }
        if (size[0] <= 0.0 || size[1] <= 0.0)
            continue;
        for (size_t i = 0, j = 0; i < a->count || j < b->count;) {
            bool of_a = j == b->count || (i < a->count && a->value[i] <= b->value[j]);
            unsigned char g =
                permutation.label[of_a ? a->cluster[i++] : a->cluster_count + b->cluster[j++]];
            passed[g]++;
            u += g == 1 ? passed[0] : 0.0;
            ks = fmax(ks, fabs(passed[0] / size[0] - passed[1] / size[1]));
        }
        const double now[2] = {fabs(u / (size[0] * size[1]) - 0.5), ks};
        valid += number > 0;
        for (int s = 0; s < 2; s++) {
            if (number == 0)
                observed[s] = now[s];
            else
                extreme[s] += now[s] >= observed[s] - 1e-12;
        }
    }
    for (int s = 0; s < 2; s++)
        p[s] = isnan(observed[s]) ? NAN : (1.0 + extreme[s]) / (1.0 + valid);
    cp_permutation_destroy(&permutation);
}

static inline void null_test(null_counts *c, int figure, double p)
{
    c->given[figure] += !isnan(p);
    c->hits[figure] += p <= 0.05;
}

static inline void null_interval(null_counts *c, int figure, cp_interval i, double truth)
{
    if (i.status != CP_INTERVAL_VALUE)
        return;
    c->given[figure]++;
    c->hits[figure] += i.low <= truth && truth <= i.high;
}

// Every resample as it comes, as before: no look at how many events there are.
static inline double null_ratio(const unsigned *weight_a, const unsigned *weight_b,
                                const void *context)
{
    const cp_exposure *const *arm = context;
    double sum[2][2] = {{0.0, 0.0}, {0.0, 0.0}};
    for (int g = 0; g < 2; g++) {
        const unsigned *weight = g ? weight_b : weight_a;
        for (size_t k = 0; arm[g] && k < arm[g]->cluster_count; k++) {
            sum[g][0] += weight[k] * arm[g]->events[k];
            sum[g][1] += weight[k] * arm[g]->exposure[k];
        }
    }
    if (!arm[1])
        return sum[0][0] / sum[0][1];
    if (sum[0][0] <= 0.0)
        return sum[1][0] > 0.0 ? INFINITY : NAN;
    return sum[1][0] / sum[1][1] / (sum[0][0] / sum[0][1]);
}

static inline cp_interval null_bootstrap(const cp_exposure *a, const cp_exposure *b,
                                         const cp_resampling *r)
{
    const cp_exposure *arm[2] = {a, b};
    cp_resampling own = *r;
    own.cluster_count[0] = a->cluster_count;
    own.cluster_count[1] = b ? b->cluster_count : 0;
    own.paired &= b != NULL;
    cp_interval interval;
    cp_error error = {0};
    if (cp_bootstrap(&own, null_ratio, arm, &interval, &error) != CP_OK)
        abort();
    return interval;
}

/* Rates, new methods and old. */
static inline void null_rates(const simulated_design *d, const cp_exposure *a, const cp_exposure *b,
                              const cp_resampling *r, size_t permutations, null_counts *c)
{
    cp_error error = {0};
    cp_interval interval;
    cp_widening widening;
    if (cp_rate_ratio_bootstrap(a, b, r, &interval, &error) != CP_OK)
        abort();
    if (interval.status != CP_INTERVAL_VALUE)
        interval = cp_rate_ratio_widened(a, b, r, &widening);
    null_interval(c, NULL_RATIO, interval, d->rate_ratio);
    interval = null_bootstrap(a, b, r);
    if (interval.status != CP_INTERVAL_VALUE)
        interval = cp_rate_ratio_poisson(a, b, 0.95);
    null_interval(c, NULL_RATIO_OLD, interval, d->rate_ratio);

    double truth = d->mean_crashes * d->rate_ratio / 100.0, events = 0.0, exposure = 0.0;
    for (size_t k = 0; k < b->cluster_count; k++) {
        events += b->events[k];
        exposure += b->exposure[k];
    }
    if (cp_rate_bootstrap(b, NULL, r->seed, &interval, &error) != CP_OK)
        abort();
    if (interval.status != CP_INTERVAL_VALUE)
        interval = cp_rate_widened(b, NULL, 0.95, &widening);
    null_interval(c, NULL_ONE_RATE, interval, truth);
    interval = null_bootstrap(b, NULL, r);
    if (interval.status != CP_INTERVAL_VALUE) {
        interval = cp_rate_garwood(events, 0.95);
        truth *= exposure;
    }
    null_interval(c, NULL_ONE_RATE_OLD, interval, truth);

    cp_permutation_test rate = {NAN, NAN};
    if (d->rate_ratio == 1.0 && cp_contrast_rates(a, b, r, permutations, &rate, &error) != CP_OK)
        abort();
    null_test(c, NULL_RATE, rate.p);
}

/* One study with this seed. resamples: of intervals and the distance's p; permutations: of the old
 * tests and of the rate's. */
static inline void null_study(const simulated_design *d, uint64_t seed, size_t resamples,
                              size_t permutations, null_counts *c)
{
    simulated_variant a = simulate_variant(d, seed, 0), b = simulate_variant(d, seed, 1);
    cp_resampling r = cp_resampling_default();
    r.cluster_count[0] = r.cluster_count[1] = d->replications;
    r.repetitions = resamples;
    r.seed = seed;
    r.paired = d->paired;
    cp_contrast contrast;
    cp_error error = {0};
    if (cp_contrast_samples(&a.sample, &b.sample, &r, &contrast, &error) != CP_OK)
        abort();
    double old[2];
    null_old_tests(&a.sample, &b.sample, &r, permutations, old);
    null_test(c, NULL_SEVERITY, contrast.superiority.p);
    null_test(c, NULL_SEVERITY_OLD, old[0]);
    null_test(c, NULL_DISTANCE, contrast.distance_p);
    null_test(c, NULL_DISTANCE_OLD, old[1]);
    simulated_truth truth = simulated_truth_of(d);
    null_interval(c, NULL_DELTA, contrast.superiority.interval, truth.cliffs_delta);
    null_interval(c, NULL_MEDIAN, contrast.median_interval, truth.median_difference);
    null_interval(c, NULL_MEAN, contrast.mean_interval, truth.mean_difference);
    null_interval(c, NULL_P90, contrast.p90_interval, truth.p90_difference);
    cp_exposure ea = simulated_exposure(&a), eb = simulated_exposure(&b);
    null_rates(d, &ea, &eb, &r, permutations, c);
    simulated_variant_destroy(&a);
    simulated_variant_destroy(&b);
}

/* The cell of a table: crashes is what to expect in the smaller variant, in all replications. */
static inline simulated_design null_cell(size_t replications, double crashes, double rho,
                                         double rate_ratio, bool paired)
{
    return (simulated_design){.replications = replications,
                              .mean_crashes = crashes / rate_ratio / (double)replications,
                              .rho = rho,
                              .rate_ratio = rate_ratio,
                              .paired = paired};
}

// Differences within crashes of one replication share an effect; no effect on average.
static inline double null_signed_rank(const simulated_design *d, uint64_t seed, size_t permutations)
{
    enum { PAIRS = 6 };
    size_t count = PAIRS * d->replications;
    double *value = calloc(count, sizeof *value);
    size_t *cluster = calloc(count, sizeof *cluster);
    if (!value || !cluster)
        abort();
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(seed), "null pairs");
    for (size_t k = 0; k < count; k++) {
        cluster[k] = k / PAIRS;
        value[k] = sqrt(d->rho) * cp_rng_normal(key, 1000000 + cluster[k]) +
                   sqrt(1.0 - d->rho) * cp_rng_normal(key, k);
    }
    cp_sample sample;
    cp_paired paired;
    cp_error error = {0};
    cp_resampling r = cp_resampling_default();
    r.cluster_count[0] = d->replications;
    r.repetitions = 1;
    r.seed = seed;
    if (cp_sample_create(value, cluster, count, d->replications, &sample, &error) != CP_OK ||
        cp_paired_compare(&sample, &r, permutations, &paired, &error) != CP_OK)
        abort();
    cp_sample_destroy(&sample);
    free(value);
    free(cluster);
    return paired.signed_rank.p;
}

#endif
