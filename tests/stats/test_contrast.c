/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/contrast.h"

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

static cp_contrast contrast_of(const cp_sample *a, const cp_sample *b)
{
    cp_resampling resampling = cp_resampling_default();
    resampling.cluster_count[0] = a->cluster_count;
    resampling.cluster_count[1] = b->cluster_count;
    cp_contrast contrast;
    cp_error error = {0};
    assert_int_equal(cp_contrast_samples(a, b, &resampling, &contrast, &error), CP_OK);
    return contrast;
}

// R: wilcox.test(c(6,8,9,11), c(1,2,3,5,7)) gives W = 19 of 20 pairs. So few say no more.
static void few_observations_give_figures_and_no_test(void **state)
{
    (void)state;
    const size_t cluster[] = {0, 1, 2, 3, 4};
    cp_sample a = sample_of((const double[]){1, 2, 3, 5, 7}, cluster, 5, 5);
    cp_sample b = sample_of((const double[]){6, 8, 9, 11}, cluster, 4, 4);
    cp_contrast contrast = contrast_of(&a, &b);
    assert_near(contrast.superiority.cliffs_delta, 0.9, 1e-12);
    assert_near(contrast.distance, 0.8, 1e-12);
    assert_near(contrast.median_difference.value, 5.5, 1e-12);
    assert_int_equal(contrast.superiority.status, CP_INTERVAL_TOO_FEW_CRASHES);
    assert_true(isnan(contrast.superiority.p) && isnan(contrast.distance_p));
    assert_int_equal(contrast.median_interval.status, CP_INTERVAL_TOO_FEW_CRASHES);
    cp_sample_destroy(&a);
    cp_sample_destroy(&b);
}

// Two scenarios without any difference within them, mixed otherwise in the treatment: none
// together.
static void unlike_mixes_make_no_difference(void **state)
{
    (void)state;
    enum { CLUSTERS = 20 };
    double value[2][MOST];
    size_t cluster[2][MOST], stratum[CLUSTERS], count[2] = {0, 0};
    for (size_t c = 0; c < CLUSTERS; c++) {
        stratum[c] = c / 10;
        for (int g = 0; g < 2; g++) {
            // The baseline crashes thrice as often in the mild scenario, the treatment in the
            // other.
            size_t crashes = (stratum[c] == 0) == (g == 0) ? 3 : 1;
            for (size_t k = 0; k < crashes; k++) {
                value[g][count[g]] = (stratum[c] ? 20.0 : 5.0) + 0.1 * (double)((c + 3 * k) % 7);
                cluster[g][count[g]++] = c;
            }
        }
    }
    cp_sample a = sample_of(value[0], cluster[0], count[0], CLUSTERS);
    cp_sample b = sample_of(value[1], cluster[1], count[1], CLUSTERS);
    cp_resampling r = cp_resampling_default();
    r.cluster_count[0] = r.cluster_count[1] = CLUSTERS;
    cp_contrast together, apart;
    cp_error error = {0};
    assert_int_equal(cp_contrast_samples(&a, &b, &r, &together, &error), CP_OK);
    r.stratum[0] = r.stratum[1] = stratum;
    assert_int_equal(cp_contrast_samples(&a, &b, &r, &apart, &error), CP_OK);
    assert_true(together.superiority.p < 0.01 && together.median_difference.value > 10.0);
    assert_true(apart.superiority.p > 0.1 && fabs(apart.superiority.cliffs_delta) < 0.2);
    assert_true(fabs(apart.mean_difference.value) < 0.2);
    assert_true(apart.distance < 0.3);
    cp_sample_destroy(&a);
    cp_sample_destroy(&b);
}

// A treatment that turns three of four crashes into ones without OLC lowers severity; dropping them
// would have raised its mean by 4 g.
static void censored_treatment_counts_as_lower(void **state)
{
    (void)state;
    const size_t cluster[] = {0, 1, 2, 3};
    cp_sample a = sample_of((const double[]){10, 12, 14, 16}, cluster, 4, 4);
    cp_sample b = sample_of((const double[]){-INFINITY, -INFINITY, -INFINITY, 17}, cluster, 4, 4);
    cp_contrast contrast = contrast_of(&a, &b);
    assert_near(contrast.superiority.cliffs_delta, -0.5, 1e-12);
    assert_int_equal(contrast.median_difference.relation, CP_LESS_THAN);
    assert_near(contrast.median_difference.value, 4.0, 1e-12);
    assert_int_equal(contrast.mean_difference.relation, CP_LESS_THAN);
    assert_near(contrast.mean_difference.value, 4.0, 1e-12); // 17 at most, each
    cp_contrast backwards = contrast_of(&b, &a);
    assert_int_equal(backwards.mean_difference.relation, CP_MORE_THAN);
    cp_sample_destroy(&a);
    cp_sample_destroy(&b);
}

// Six clusters a sample, all of b above all of a: at most 2 / C(12, 6) by chance; paired 2 / 2^6.
static void complete_separation_has_a_bound(void **state)
{
    (void)state;
    const size_t cluster[] = {0, 0, 1, 1, 2, 2, 3, 3, 4, 5};
    cp_sample a = sample_of((const double[]){1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, cluster, 10, 8);
    cp_sample b =
        sample_of((const double[]){11, 12, 13, 14, 15, 16, 17, 18, 19, 20}, cluster, 10, 8);
    cp_resampling r = cp_resampling_default();
    r.cluster_count[0] = r.cluster_count[1] = 8;
    cp_contrast contrast;
    cp_error error = {0};
    for (int paired = 0; paired < 2; paired++) {
        r.paired = paired;
        assert_int_equal(cp_contrast_samples(&a, &b, &r, &contrast, &error), CP_OK);
        assert_true(contrast.superiority.cliffs_delta == 1.0);
        assert_int_equal(contrast.superiority.interval.status, CP_INTERVAL_ALL_ALIKE);
        assert_near(contrast.superiority.p, paired ? 2.0 / 64.0 : 2.0 / 924.0, 1e-12);
    }
    cp_sample_destroy(&a);
    cp_sample_destroy(&b);
}

static void nothing_to_compare_gives_no_numbers(void **state)
{
    (void)state;
    const size_t cluster[] = {0, 1};
    cp_sample a = sample_of((const double[]){1, 2}, cluster, 2, 2);
    cp_sample b = sample_of((const double[]){0}, cluster, 0, 2);
    cp_contrast contrast = contrast_of(&a, &b);
    assert_true(isnan(contrast.superiority.cliffs_delta));
    assert_true(isnan(contrast.superiority.p));
    assert_int_equal(contrast.median_difference.relation, CP_NO_VALUE);
    cp_sample_destroy(&a);
    cp_sample_destroy(&b);
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
        cmocka_unit_test(few_observations_give_figures_and_no_test),
        cmocka_unit_test(unlike_mixes_make_no_difference),
        cmocka_unit_test(complete_separation_has_a_bound),
        cmocka_unit_test(censored_treatment_counts_as_lower),
        cmocka_unit_test(nothing_to_compare_gives_no_numbers),
        cmocka_unit_test(rates_are_tested_by_whole_replications),
        cmocka_unit_test(holm_adjusts_step_by_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
