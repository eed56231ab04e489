/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/contrast.h"

#include "core/rng.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

#include "builders/assert_near.h"

enum { MOST = 128 };

static cp_sample sample_of(const double *values, const size_t *cluster, size_t count,
                           size_t clusters)
{
    cp_sample sample;
    cp_error error = {0};
    assert_int_equal(cp_sample_create(values, cluster, count, clusters, &sample, &error), CP_OK);
    return sample;
}

static cp_contrast contrast_of(const cp_sample *a, const cp_sample *b, bool paired,
                               size_t permutations)
{
    cp_resampling resampling = cp_resampling_default();
    resampling.cluster_count[0] = a->cluster_count;
    resampling.cluster_count[1] = b->cluster_count;
    resampling.paired = paired;
    cp_contrast contrast;
    cp_error error = {0};
    assert_int_equal(cp_contrast_samples(a, b, &resampling, permutations, &contrast, &error),
                     CP_OK);
    return contrast;
}

// One value a cluster: the permutation p is the exact test's. R: wilcox.test(c(6,8,9,11),
// c(1,2,3,5,7)) gives W = 19, p = 4/126 (pairs of tails: U <= 1 or >= 19 of C(9,4) = 126).
static void mann_whitney_agrees_with_the_exact_test(void **state)
{
    (void)state;
    const size_t cluster[] = {0, 1, 2, 3, 4};
    cp_sample a = sample_of((const double[]){1, 2, 3, 5, 7}, cluster, 5, 5);
    cp_sample b = sample_of((const double[]){6, 8, 9, 11}, cluster, 4, 4);
    cp_contrast contrast = contrast_of(&a, &b, false, 40000);
    assert_near(contrast.mann_whitney.statistic, 19.0, 1e-12);
    assert_near(contrast.mann_whitney.p, 4.0 / 126.0, 0.004);
    assert_near(contrast.cliffs_delta, 0.9, 1e-12);
    assert_near(contrast.kolmogorov_smirnov.statistic, 0.8, 1e-12);
    assert_near(contrast.median_difference.value, 5.5, 1e-12);
    assert_int_equal(contrast.median_interval.status, CP_INTERVAL_TOO_FEW_REPLICATIONS);
    cp_sample_destroy(&a);
    cp_sample_destroy(&b);
}

// Six pairs that all fall: of 64 sign patterns two are as extreme.
static void sign_flips_swap_pairs_only(void **state)
{
    (void)state;
    const size_t cluster[] = {0, 1, 2, 3, 4, 5};
    cp_sample a = sample_of((const double[]){10, 20, 30, 40, 50, 60}, cluster, 6, 6);
    cp_sample b = sample_of((const double[]){9, 19, 29, 39, 49, 59}, cluster, 6, 6);
    cp_contrast paired = contrast_of(&a, &b, true, 40000);
    cp_contrast apart = contrast_of(&a, &b, false, 2000);
    assert_near(paired.mann_whitney.p, 2.0 / 64.0, 0.004);
    assert_true(apart.mann_whitney.p > 0.5);
    cp_sample_destroy(&a);
    cp_sample_destroy(&b);
}

// A treatment that turns half the crashes into ones without OLC lowers severity; dropping them
// would have raised it.
static void censored_treatment_counts_as_lower(void **state)
{
    (void)state;
    const size_t cluster[] = {0, 1, 2, 3};
    cp_sample a = sample_of((const double[]){10, 12, 14, 16}, cluster, 4, 4);
    cp_sample b = sample_of((const double[]){-INFINITY, -INFINITY, -INFINITY, 17}, cluster, 4, 4);
    cp_contrast contrast = contrast_of(&a, &b, false, 0);
    assert_near(contrast.cliffs_delta, -0.5, 1e-12);
    assert_int_equal(contrast.median_difference.relation, CP_LESS_THAN);
    assert_near(contrast.median_difference.value, 4.0, 1e-12);
    assert_true(isnan(contrast.mann_whitney.p));
    cp_sample_destroy(&a);
    cp_sample_destroy(&b);
}

static void nothing_to_compare_gives_no_numbers(void **state)
{
    (void)state;
    const size_t cluster[] = {0, 1};
    cp_sample a = sample_of((const double[]){1, 2}, cluster, 2, 2);
    cp_sample b = sample_of((const double[]){0}, cluster, 0, 2);
    cp_contrast contrast = contrast_of(&a, &b, false, 99);
    assert_true(isnan(contrast.cliffs_delta));
    assert_true(isnan(contrast.mann_whitney.p));
    assert_int_equal(contrast.median_difference.relation, CP_NO_VALUE);
    cp_sample_destroy(&a);
    cp_sample_destroy(&b);
}

// Clustered values without any difference: the whole-replication test rejects about 5 % of 400,
// and not the fifth or more that a test of single values would.
static void permutation_keeps_its_level_for_clustered_values(void **state)
{
    (void)state;
    enum { CLUSTERS = 10, VALUES = 6 };
    int rejected = 0;
    for (uint64_t study = 0; study < 400; study++) {
        cp_sample side[2];
        for (uint64_t g = 0; g < 2; g++) {
            double value[MOST];
            size_t cluster[MOST];
            cp_rng_key key = cp_rng_key_number(cp_rng_key_seed(study), g);
            for (size_t k = 0; k < CLUSTERS * VALUES; k++) {
                cluster[k] = k / VALUES;
                value[k] = cp_rng_normal(key, k) + 1.5 * cp_rng_normal(key, 1000 + cluster[k]);
            }
            side[g] = sample_of(value, cluster, CLUSTERS * VALUES, CLUSTERS);
        }
        cp_contrast contrast = contrast_of(&side[0], &side[1], false, 199);
        rejected += contrast.mann_whitney.p <= 0.05;
        cp_sample_destroy(&side[0]);
        cp_sample_destroy(&side[1]);
    }
    assert_in_range(rejected, 8, 34);
}

// Counts of five replications each, all of b below all of a: 2 of C(10,5) = 252 labellings.
static void rates_are_tested_by_whole_replications(void **state)
{
    (void)state;
    const double a_counts[] = {8, 9, 7, 10, 8}, b_counts[] = {1, 2, 0, 1, 3};
    const double km[] = {5, 5, 5, 5, 5};
    cp_exposure a = {5, a_counts, km}, b = {5, b_counts, km};
    cp_resampling resampling = cp_resampling_default();
    resampling.cluster_count[0] = resampling.cluster_count[1] = 5;
    cp_permutation_test test;
    cp_error error = {0};
    assert_int_equal(cp_contrast_rates(&a, &b, &resampling, 40000, &test, &error), CP_OK);
    assert_near(test.statistic, log(7.0 / 42.0), 1e-12);
    assert_near(test.p, 2.0 / 252.0, 0.002);

    // A stratum of its own for each pair leaves only swaps within it.
    const size_t stratum[] = {0, 1, 2, 3, 4};
    resampling.stratum[0] = resampling.stratum[1] = stratum;
    assert_int_equal(cp_contrast_rates(&a, &b, &resampling, 40000, &test, &error), CP_OK);
    assert_near(test.p, 2.0 / 32.0, 0.005);
}

// Holm: sorted 0.01, 0.02, 0.03, 0.04 times 4, 3, 2, 1, never falling.
static void holm_adjusts_step_by_step(void **state)
{
    (void)state;
    double p[] = {0.03, NAN, 0.01, 0.04, 0.02, 0.9};
    cp_error error = {0};
    assert_int_equal(cp_holm_adjust(p, 6, &error), CP_OK);
    assert_near(p[2], 0.05, 1e-12);
    assert_near(p[4], 0.08, 1e-12);
    assert_near(p[0], 0.09, 1e-12);
    assert_near(p[3], 0.09, 1e-12);
    assert_near(p[5], 0.9, 1e-12);
    assert_true(isnan(p[1]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mann_whitney_agrees_with_the_exact_test),
        cmocka_unit_test(sign_flips_swap_pairs_only),
        cmocka_unit_test(censored_treatment_counts_as_lower),
        cmocka_unit_test(nothing_to_compare_gives_no_numbers),
        cmocka_unit_test(permutation_keeps_its_level_for_clustered_values),
        cmocka_unit_test(rates_are_tested_by_whole_replications),
        cmocka_unit_test(holm_adjusts_step_by_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
