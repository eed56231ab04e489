/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/contrast.h"

#include "stats/permutation.h"
#include "stats/pooled.h"

#include <gsl/gsl_sort.h>

#include <math.h>
#include <stdlib.h>

// At least as extreme, up to rounding of sums taken in another order.
static bool as_extreme(double permuted, double observed)
{
    if (isinf(observed))
        return permuted >= observed;
    return permuted >= observed - 1e-12 * fmax(1.0, fabs(observed));
}

static cp_status test_samples(const cp_pooled *p, const cp_resampling *resampling,
                              size_t permutations, cp_contrast *contrast, cp_error *error)
{
    cp_permutation permutation;
    cp_status status = cp_permutation_create(resampling, &permutation, error);
    if (status != CP_OK)
        return status;
    cp_pooled_ranks observed = cp_pooled_rank(p, permutation.label);
    contrast->mann_whitney = (cp_permutation_test){observed.u, NAN};
    contrast->kolmogorov_smirnov = (cp_permutation_test){observed.ks, NAN};

    // Labellings that leave a group empty say nothing and are left out.
    double valid = 0.0, u_extreme = 0.0, ks_extreme = 0.0;
    for (size_t number = 1; !isnan(observed.u) && number <= permutations; number++) {
        cp_permutation_set(&permutation, number);
        cp_pooled_ranks permuted = cp_pooled_rank(p, permutation.label);
        if (isnan(permuted.u))
            continue;
        valid++;
        u_extreme += as_extreme(permuted.shift, observed.shift);
        ks_extreme += as_extreme(permuted.ks, observed.ks);
    }
    if (!isnan(observed.u) && permutations > 0) {
        contrast->mann_whitney.p = (1.0 + u_extreme) / (1.0 + valid);
        contrast->kolmogorov_smirnov.p = (1.0 + ks_extreme) / (1.0 + valid);
    }
    cp_permutation_destroy(&permutation);
    return CP_OK;
}

static void differences(const unsigned *weight_a, const unsigned *weight_b, const void *context,
                        double *value)
{
    cp_pooled_differences(context, weight_a, weight_b, value);
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
    cp_pooled p;
    cp_interval interval[CP_POOLED_COUNT];
    cp_status status = cp_pooled_create(a, b, &p, error);
    if (status == CP_OK)
        status = cp_bootstrap_many(resampling, differences, CP_POOLED_COUNT, &p, interval, error);
    if (status == CP_OK) {
        contrast->mean_interval = interval[CP_POOLED_MEAN];
        contrast->median_interval = interval[CP_POOLED_MEDIAN];
        contrast->p90_interval = interval[CP_POOLED_P90];
        contrast->cliffs_delta_interval = interval[CP_POOLED_CLIFFS_DELTA];
        status = test_samples(&p, resampling, permutations, contrast, error);
    }
    cp_pooled_destroy(&p);
    return status;
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
