/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TESTS_STATS_NULL_STUDY_H
#define TESTS_STATS_NULL_STUDY_H

#include "builders/simulated_study.h"
#include "stats/contrast.h"
#include "stats/paired.h"

/* Shared by the long program and by its short version in the suite. */

enum { NULL_RATE, NULL_MANN_WHITNEY, NULL_KOLMOGOROV_SMIRNOV, NULL_SIGNED_RANK, NULL_TESTS };

static const char *const NULL_TEST_TEXT[NULL_TESTS] = {
    "crash rate", "Mann–Whitney", "Kolmogorov–Smirnov", "signed rank by replication"};

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

/* p[test * studies + study]. */
static inline void null_p_values(const simulated_design *d, uint64_t seed, size_t studies,
                                 size_t permutations, double *p)
{
    for (size_t k = 0; k < studies; k++) {
        simulated_variant a = simulate_variant(d, seed + k, 0);
        simulated_variant b = simulate_variant(d, seed + k, 1);
        cp_resampling r = cp_resampling_default();
        r.cluster_count[0] = r.cluster_count[1] = d->replications;
        r.repetitions = 1;
        r.seed = seed + k;
        r.paired = d->paired;
        cp_contrast c;
        cp_permutation_test rate;
        cp_exposure ea = simulated_exposure(&a), eb = simulated_exposure(&b);
        cp_error error = {0};
        if (cp_contrast_samples(&a.sample, &b.sample, &r, permutations, &c, &error) != CP_OK ||
            cp_contrast_rates(&ea, &eb, &r, permutations, &rate, &error) != CP_OK)
            abort();
        p[NULL_RATE * studies + k] = rate.p;
        p[NULL_MANN_WHITNEY * studies + k] = c.mann_whitney.p;
        p[NULL_KOLMOGOROV_SMIRNOV * studies + k] = c.kolmogorov_smirnov.p;
        p[NULL_SIGNED_RANK * studies + k] = null_signed_rank(d, seed + k, permutations);
        simulated_variant_destroy(&a);
        simulated_variant_destroy(&b);
    }
}

typedef struct null_summary {
    double rejected_1; /* share of p <= 0.05 */
    double distance;   /* Kolmogorov's, from the uniform distribution */
    double p;          /* of the distance, Kolmogorov's limit with Stephens' correction */
} null_summary;

static inline int null_ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static inline null_summary null_summary_of(double *p, size_t count)
{
    null_summary s = {0.0, 0.0, 0.0};
    qsort(p, count, sizeof *p, null_ascending);
    for (size_t k = 0; k < count; k++) {
        s.rejected_1 += (p[k] <= 0.05) / (double)count;
        s.distance = fmax(s.distance, fmax((double)(k + 1) / (double)count - p[k],
                                           p[k] - (double)k / (double)count));
    }
    double root = sqrt((double)count), x = (root + 0.12 + 0.11 / root) * s.distance;
    for (int k = 1; k < 100; k++)
        s.p += 2.0 * (k % 2 ? 1.0 : -1.0) * exp(-2.0 * k * k * x * x);
    s.p = fmin(1.0, fmax(0.0, s.p));
    return s;
}

#endif
