/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/contrast.h"

#include "stats/permutation.h"

#include <gsl/gsl_sort.h>

#include <math.h>
#include <stdlib.h>

/* Both samples in one ascending order; clusters numbered through as in cp_permutation. */
typedef struct pooled {
    size_t count;
    double *value;
    size_t *cluster;
} pooled;

static void pooled_destroy(pooled *p)
{
    free(p->value);
    free(p->cluster);
    *p = (pooled){0};
}

static cp_status pooled_create(const cp_sample *a, const cp_sample *b, pooled *p, cp_error *error)
{
    *p = (pooled){.count = a->count + b->count};
    p->value = calloc(p->count + 1, sizeof *p->value);
    p->cluster = calloc(p->count + 1, sizeof *p->cluster);
    if (!p->value || !p->cluster) {
        pooled_destroy(p);
        return cp_fail_memory(error, "a permutation test");
    }
    // Merge the two sorted samples.
    for (size_t i = 0, j = 0, k = 0; k < p->count; k++) {
        bool from_a = j == b->count || (i < a->count && a->value[i] <= b->value[j]);
        p->value[k] = from_a ? a->value[i] : b->value[j];
        p->cluster[k] = from_a ? a->cluster[i++] : a->cluster_count + b->cluster[j++];
    }
    return CP_OK;
}

/* The two test statistics of one labelling; NAN when a group has no observation. */
typedef struct distances {
    double u;     /* Mann-Whitney U of group 1 */
    double shift; /* |U / (n0 n1) - 1/2|: how far from no difference */
    double ks;
} distances;

static distances distances_of(const pooled *p, const unsigned char *label)
{
    double total[2] = {0.0, 0.0};
    for (size_t k = 0; k < p->count; k++)
        total[label[p->cluster[k]]]++;
    if (total[0] <= 0.0 || total[1] <= 0.0)
        return (distances){NAN, NAN, NAN};

    // Walk up the values; ties move together, a tie with the other group counts half.
    distances d = {0.0, 0.0, 0.0};
    double passed[2] = {0.0, 0.0};
    for (size_t begin = 0, end; begin < p->count; begin = end) {
        double tied[2] = {0.0, 0.0};
        for (end = begin; end < p->count && p->value[end] == p->value[begin]; end++)
            tied[label[p->cluster[end]]]++;
        d.u += tied[1] * (passed[0] + 0.5 * tied[0]);
        passed[0] += tied[0];
        passed[1] += tied[1];
        d.ks = fmax(d.ks, fabs(passed[0] / total[0] - passed[1] / total[1]));
    }
    d.shift = fabs(d.u / (total[0] * total[1]) - 0.5);
    return d;
}

// At least as extreme, up to rounding of sums taken in another order.
static bool as_extreme(double permuted, double observed)
{
    if (isinf(observed))
        return permuted >= observed;
    return permuted >= observed - 1e-12 * fmax(1.0, fabs(observed));
}

static cp_status test_samples(const cp_sample *a, const cp_sample *b,
                              const cp_resampling *resampling, size_t permutations,
                              cp_contrast *contrast, cp_error *error)
{
    pooled p = {0};
    cp_permutation permutation = {0};
    cp_status status = pooled_create(a, b, &p, error);
    if (status == CP_OK)
        status = cp_permutation_create(resampling, &permutation, error);
    if (status != CP_OK)
        goto done;
    distances observed = distances_of(&p, permutation.label);
    contrast->mann_whitney = (cp_permutation_test){observed.u, NAN};
    contrast->kolmogorov_smirnov = (cp_permutation_test){observed.ks, NAN};
    if (isnan(observed.u) || permutations == 0)
        goto done;

    // Labellings that leave a group empty say nothing and are left out.
    double valid = 0.0, u_extreme = 0.0, ks_extreme = 0.0;
    for (size_t number = 1; number <= permutations; number++) {
        cp_permutation_set(&permutation, number);
        distances d = distances_of(&p, permutation.label);
        if (isnan(d.u))
            continue;
        valid++;
        u_extreme += as_extreme(d.shift, observed.shift);
        ks_extreme += as_extreme(d.ks, observed.ks);
    }
    contrast->mann_whitney.p = (1.0 + u_extreme) / (1.0 + valid);
    contrast->kolmogorov_smirnov.p = (1.0 + ks_extreme) / (1.0 + valid);

done:
    cp_permutation_destroy(&permutation);
    pooled_destroy(&p);
    return status;
}

/* What the bootstrap statistics need: two samples, and which quantile. */
typedef struct pair {
    const cp_sample *a;
    const cp_sample *b;
    double p;
} pair;

static double mean_statistic(const unsigned *weight_a, const unsigned *weight_b,
                             const void *context)
{
    const pair *both = context;
    return cp_sample_mean(both->b, weight_b) - cp_sample_mean(both->a, weight_a);
}

static double quantile_statistic(const unsigned *weight_a, const unsigned *weight_b,
                                 const void *context)
{
    // Two censored quantiles: -INFINITY - -INFINITY is NAN, the difference does not exist.
    const pair *both = context;
    return cp_sample_quantile(both->b, weight_b, both->p) -
           cp_sample_quantile(both->a, weight_a, both->p);
}

static double delta_statistic(const unsigned *weight_a, const unsigned *weight_b,
                              const void *context)
{
    const pair *both = context;
    return cp_sample_cliffs_delta(both->a, weight_a, both->b, weight_b);
}

cp_status cp_contrast_samples(const cp_sample *a, const cp_sample *b,
                              const cp_resampling *resampling, size_t permutations,
                              cp_contrast *contrast, cp_error *error)
{
    double mean = cp_sample_mean(b, NULL) - cp_sample_mean(a, NULL);
    *contrast = (cp_contrast){
        .mean_difference = {isnan(mean) ? CP_NO_VALUE : CP_EXACTLY, mean},
        .median_difference =
            cp_estimate_difference(cp_describe_quantile(a, 0.5), cp_describe_quantile(b, 0.5)),
        .p90_difference =
            cp_estimate_difference(cp_describe_quantile(a, 0.9), cp_describe_quantile(b, 0.9)),
        .cliffs_delta = cp_sample_cliffs_delta(a, NULL, b, NULL),
    };
    const struct {
        cp_statistic statistic;
        double p;
        cp_interval *interval;
    } intervals[] = {
        {mean_statistic, 0.0, &contrast->mean_interval},
        {quantile_statistic, 0.5, &contrast->median_interval},
        {quantile_statistic, 0.9, &contrast->p90_interval},
        {delta_statistic, 0.0, &contrast->cliffs_delta_interval},
    };
    for (size_t k = 0; k < sizeof intervals / sizeof *intervals; k++) {
        pair both = {a, b, intervals[k].p};
        cp_status status =
            cp_bootstrap(resampling, intervals[k].statistic, &both, intervals[k].interval, error);
        if (status != CP_OK)
            return status;
    }
    return test_samples(a, b, resampling, permutations, contrast, error);
}

// Log of the rate ratio of group 1 over group 0 under a labelling; NAN without any exposure.
static double log_ratio(const cp_exposure *a, const cp_exposure *b, const unsigned char *label)
{
    double events[2] = {0.0, 0.0}, exposure[2] = {0.0, 0.0};
    for (size_t k = 0; k < a->cluster_count + b->cluster_count; k++) {
        const cp_exposure *from = k < a->cluster_count ? a : b;
        size_t own = k < a->cluster_count ? k : k - a->cluster_count;
        events[label[k]] += from->events[own];
        exposure[label[k]] += from->exposure[own];
    }
    if (exposure[0] <= 0.0 || exposure[1] <= 0.0 || events[0] + events[1] <= 0.0)
        return NAN;
    return log(events[1] / exposure[1]) - log(events[0] / exposure[0]);
}

cp_status cp_contrast_rates(const cp_exposure *a, const cp_exposure *b,
                            const cp_resampling *resampling, size_t permutations,
                            cp_permutation_test *test, cp_error *error)
{
    *test = (cp_permutation_test){NAN, NAN};
    cp_permutation permutation = {0};
    cp_status status = cp_permutation_create(resampling, &permutation, error);
    if (status != CP_OK)
        return status;
    test->statistic = log_ratio(a, b, permutation.label);
    if (!isnan(test->statistic) && permutations > 0) {
        double valid = 0.0, extreme = 0.0;
        for (size_t number = 1; number <= permutations; number++) {
            cp_permutation_set(&permutation, number);
            double permuted = log_ratio(a, b, permutation.label);
            valid += !isnan(permuted);
            extreme += !isnan(permuted) && as_extreme(fabs(permuted), fabs(test->statistic));
        }
        test->p = (1.0 + extreme) / (1.0 + valid);
    }
    cp_permutation_destroy(&permutation);
    return CP_OK;
}

cp_status cp_holm_adjust(double *p, size_t count, cp_error *error)
{
    size_t *order = calloc(count + 1, sizeof *order);
    double *key = calloc(count + 1, sizeof *key);
    if (!order || !key) {
        free(order);
        free(key);
        return cp_fail_memory(error, "Holm's adjustment");
    }
    // Missing p-values sort last and take no part.
    size_t tests = 0;
    for (size_t k = 0; k < count; k++) {
        key[k] = isnan(p[k]) ? INFINITY : p[k];
        tests += !isnan(p[k]);
    }
    gsl_sort_index(order, key, 1, count);

    // The smallest times all tests, the next times one fewer, never falling, at most 1.
    double largest = 0.0;
    for (size_t k = 0; k < tests; k++) {
        largest = fmax(largest, fmin(1.0, (double)(tests - k) * p[order[k]]));
        p[order[k]] = largest;
    }
    free(order);
    free(key);
    return CP_OK;
}
