/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/rates.h"

#include "core/rng.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

#include "builders/assert_near.h"

// Published 95 % limits of a Poisson mean (Garwood 1936; tables of exact limits).
static void garwood_agrees_with_the_tables(void **state)
{
    (void)state;
    const double table[][3] = {
        {0, 0.0, 3.6889},      {1, 0.0253, 5.5716},    {5, 1.6235, 11.6683},
        {10, 4.7954, 18.3904}, {100, 81.364, 121.627},
    };
    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        cp_interval interval = cp_rate_garwood(table[k][0], 0.95);
        assert_int_equal(interval.status, CP_INTERVAL_VALUE);
        assert_near(interval.low, table[k][1], k == 4 ? 5e-4 : 5e-5);
        assert_near(interval.high, table[k][2], k == 4 ? 5e-4 : 5e-5);
    }
}

static void dispersion_is_variance_over_mean(void **state)
{
    (void)state;
    const double counts[] = {2, 4, 4, 6, 9}, exposure[] = {1, 1, 1, 1, 1};
    cp_exposure e = {5, counts, exposure};
    // mean 5, variance (9 + 1 + 1 + 1 + 16) / 4 = 7
    assert_near(cp_rate_dispersion(&e, NULL), 1.4, 1e-12);
    e.cluster_count = 1;
    assert_true(isnan(cp_rate_dispersion(&e, NULL)));
    const double none[] = {0, 0};
    assert_true(isnan(cp_rate_dispersion(&(cp_exposure){2, none, exposure}, NULL)));
}

// Two scenarios whose counts differ by design, constant within each: no dispersion at all. Twice
// the count on twice the road is no dispersion either.
static void dispersion_is_within_strata_and_per_exposure(void **state)
{
    (void)state;
    const double counts[] = {2, 50, 2, 50}, one[] = {1, 1, 1, 1};
    const size_t stratum[] = {0, 1, 0, 1};
    cp_exposure e = {4, counts, one};
    assert_near(cp_rate_dispersion(&e, stratum), 0.0, 1e-12);
    assert_true(cp_rate_dispersion(&e, NULL) > 20.0);
    const double doubled[] = {3, 6, 3, 6}, km[] = {10, 20, 10, 20};
    assert_near(cp_rate_dispersion(&(cp_exposure){4, doubled, km}, NULL), 0.0, 1e-12);
}

static void rate_and_ratio_are_of_sums(void **state)
{
    (void)state;
    const double counts_a[] = {3, 1}, km_a[] = {100, 300};
    const double counts_b[] = {1, 2}, km_b[] = {200, 400};
    cp_exposure a = {2, counts_a, km_a}, b = {2, counts_b, km_b};
    assert_near(cp_rate(&a), 0.01, 1e-15);
    assert_near(cp_rate_ratio(&a, &b, NULL, NULL), 0.5, 1e-12);
    assert_true(isnan(cp_rate(&(cp_exposure){0, NULL, NULL})));
}

// No event of b against n of a at equal exposure: the share's upper limit is 1 - 0.025^(1/n).
// n against n: the limits are each other's inverse.
static void poisson_ratio_agrees_with_closed_forms(void **state)
{
    (void)state;
    const double km[] = {10}, none[] = {0}, eight[] = {8};
    cp_exposure without = {1, none, km}, with = {1, eight, km};
    cp_interval interval = cp_rate_ratio_poisson(&with, &without, 0.95);
    double share = 1.0 - pow(0.025, 1.0 / 8.0);
    assert_near(interval.low, 0.0, 0.0);
    assert_near(interval.high, share / (1.0 - share), 1e-9);

    interval = cp_rate_ratio_poisson(&with, &with, 0.95);
    assert_near(interval.low * interval.high, 1.0, 1e-9);
    interval = cp_rate_ratio_poisson(&without, &with, 0.95);
    assert_true(isinf(interval.high));
    assert_int_equal(cp_rate_ratio_poisson(&without, &without, 0.95).status, CP_INTERVAL_UNDEFINED);
}

enum { REPLICATIONS = 40 };

// Poisson count by inversion; with effect > 0 replications differ (their mean is spread).
static double simulated_count(cp_rng_key key, uint64_t number, double mean, double effect)
{
    mean *= exp(effect * cp_rng_normal(key, 500 + number) - 0.5 * effect * effect);
    double u = cp_rng_uniform(key, number), p = exp(-mean), sum = p;
    int k = 0;
    while (u > sum && k < 1000) {
        p *= mean / ++k;
        sum += p;
    }
    return k;
}

// 300 simulated studies: with replications that differ the bootstrap still covers, Garwood not.
static void bootstrap_covers_where_garwood_does_not(void **state)
{
    (void)state;
    double counts[REPLICATIONS], exposure[REPLICATIONS];
    int covered = 0, covered_garwood = 0;
    for (uint64_t study = 0; study < 300; study++) {
        double total = 0.0;
        for (uint64_t k = 0; k < REPLICATIONS; k++) {
            counts[k] = simulated_count(cp_rng_key_seed(study), k, 5.0, 0.6);
            exposure[k] = 1.0;
            total += counts[k];
        }
        cp_exposure e = {REPLICATIONS, counts, exposure};
        cp_interval interval;
        cp_error error = {0};
        assert_int_equal(cp_rate_bootstrap(&e, NULL, study, &interval, &error), CP_OK);
        covered += interval.low <= 5.0 && 5.0 <= interval.high;
        cp_interval garwood = cp_rate_garwood(total, 0.95);
        covered_garwood += garwood.low <= 5.0 * REPLICATIONS && 5.0 * REPLICATIONS <= garwood.high;
    }
    assert_in_range(covered, 270, 294);
    assert_true(covered_garwood < 250);
}

static void ratio_bootstrap_has_the_truth_and_uses_pairs(void **state)
{
    (void)state;
    double counts_a[REPLICATIONS], counts_b[REPLICATIONS], exposure[REPLICATIONS];
    for (uint64_t k = 0; k < REPLICATIONS; k++) {
        // Seeds differ much, the treatment halves each.
        counts_a[k] = 2.0 * (double)(1 + k);
        counts_b[k] = (double)(1 + k) + (double)(k % 2);
        exposure[k] = 10.0;
    }
    cp_exposure a = {REPLICATIONS, counts_a, exposure}, b = {REPLICATIONS, counts_b, exposure};
    cp_resampling resampling = cp_resampling_default();
    resampling.cluster_count[0] = resampling.cluster_count[1] = REPLICATIONS;
    cp_interval apart, paired;
    cp_error error = {0};
    assert_int_equal(cp_rate_ratio_bootstrap(&a, &b, &resampling, &apart, &error), CP_OK);
    resampling.paired = true;
    assert_int_equal(cp_rate_ratio_bootstrap(&a, &b, &resampling, &paired, &error), CP_OK);
    double ratio = cp_rate_ratio(&a, &b, NULL, NULL);
    assert_true(apart.low < ratio && ratio < apart.high);
    assert_true(paired.low < ratio && ratio < paired.high);
    assert_true(paired.high - paired.low < 0.2 * (apart.high - apart.low));
}

// Counts of large studies, where GSL's inverses end the program: close to the normal intervals.
static void large_counts_have_intervals(void **state)
{
    (void)state;
    for (double n = 1e3; n <= 1e7; n *= 10.0) {
        cp_interval i = cp_rate_garwood(n, 0.95);
        double wider = 0.6 / sqrt(n) + 1e-3; // exact intervals allow for whole counts
        assert_near((i.high - i.low) / (2.0 * 1.959964 * sqrt(n)), 1.0, wider);
        assert_true(i.low < n && n < i.high);
        double b = 0.51 * n, km = 10.0;
        cp_exposure ea = {1, &n, &km}, eb = {1, &b, &km};
        cp_interval ratio = cp_rate_ratio_poisson(&ea, &eb, 0.95);
        double se = sqrt(1.0 / n + 1.0 / b);
        assert_near(log(ratio.high / ratio.low) / (2.0 * 1.959964 * se), 1.0, wider);
        assert_true(ratio.low < 0.51 && 0.51 < ratio.high);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(garwood_agrees_with_the_tables),
        cmocka_unit_test(large_counts_have_intervals),
        cmocka_unit_test(dispersion_is_variance_over_mean),
        cmocka_unit_test(dispersion_is_within_strata_and_per_exposure),
        cmocka_unit_test(rate_and_ratio_are_of_sums),
        cmocka_unit_test(poisson_ratio_agrees_with_closed_forms),
        cmocka_unit_test(bootstrap_covers_where_garwood_does_not),
        cmocka_unit_test(ratio_bootstrap_has_the_truth_and_uses_pairs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
