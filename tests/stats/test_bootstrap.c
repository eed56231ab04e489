/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/bootstrap.h"

#include "core/rng.h"
#include "stats/sample.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "builders/assert_near.h"

enum { CLUSTERS = 30, VALUES = 6, MOST = 256 };

static double mean_of_a(const unsigned *weight_a, const unsigned *weight_b, const void *context)
{
    (void)weight_b;
    return cp_sample_mean(context, weight_a);
}

// Clusters of equal size: an effect of the cluster (sd between) and one of the value (sd 1).
static cp_sample clustered(uint64_t seed, size_t clusters, double between, double mean)
{
    double value[MOST];
    size_t cluster[MOST];
    cp_rng_key key = cp_rng_key_seed(seed);
    for (size_t k = 0; k < clusters * VALUES; k++) {
        cluster[k] = k / VALUES;
        value[k] = mean + between * cp_rng_normal(key, 1000 + cluster[k]) + cp_rng_normal(key, k);
    }
    cp_sample sample;
    cp_error error = {0};
    assert_int_equal(cp_sample_create(value, cluster, clusters * VALUES, clusters, &sample, &error),
                     CP_OK);
    return sample;
}

static cp_interval interval_of(const cp_sample *sample, cp_resampling resampling)
{
    resampling.cluster_count[0] = sample->cluster_count;
    cp_interval interval;
    cp_error error = {0};
    assert_int_equal(cp_bootstrap(&resampling, mean_of_a, sample, &interval, &error), CP_OK);
    return interval;
}

static void under_twenty_clusters_there_is_no_interval(void **state)
{
    (void)state;
    cp_sample sample = clustered(1, 19, 0.0, 0.0);
    cp_interval interval = interval_of(&sample, cp_resampling_default());
    assert_int_equal(interval.status, CP_INTERVAL_TOO_FEW_REPLICATIONS);
    assert_string_equal(cp_interval_status_text(interval.status), "too few replications");
    cp_sample_destroy(&sample);
    sample = clustered(1, 20, 0.0, 0.0);
    assert_int_equal(interval_of(&sample, cp_resampling_default()).status, CP_INTERVAL_VALUE);
    cp_sample_destroy(&sample);
}

static void same_seed_same_bits_other_seed_other_bits(void **state)
{
    (void)state;
    cp_sample sample = clustered(2, CLUSTERS, 1.0, 0.0);
    cp_resampling resampling = cp_resampling_default();
    cp_interval first = interval_of(&sample, resampling);
    cp_interval again = interval_of(&sample, resampling);
    assert_memory_equal(&first.low, &again.low, sizeof first.low);
    assert_memory_equal(&first.high, &again.high, sizeof first.high);
    resampling.seed = 2;
    assert_true(interval_of(&sample, resampling).low != first.low);
    cp_sample_destroy(&sample);
}

// For equal clusters the mean's standard error is that of the cluster means: width = 2 z se, with
// (n - 1 over n of it, as the bootstrap has it) z = 1.95996, expanded sqrt(n / (n - 1)) t(n - 1).
static void width_is_that_of_the_cluster_means(void **state)
{
    (void)state;
    cp_sample sample = clustered(3, CLUSTERS, 2.0, 0.0);
    double cluster_mean[CLUSTERS] = {0.0}, mean = 0.0, squares = 0.0;
    for (size_t k = 0; k < sample.count; k++)
        cluster_mean[sample.cluster[k]] += sample.value[k] / VALUES;
    for (size_t c = 0; c < CLUSTERS; c++)
        mean += cluster_mean[c] / CLUSTERS;
    for (size_t c = 0; c < CLUSTERS; c++)
        squares += (cluster_mean[c] - mean) * (cluster_mean[c] - mean);
    double se = sqrt(squares) / CLUSTERS;

    cp_resampling resampling = cp_resampling_default();
    resampling.repetitions = 10000;
    cp_interval interval = interval_of(&sample, resampling);
    assert_true(interval.low < mean && mean < interval.high);
    double expanded = sqrt(30.0 / 29.0) * 2.045229642;
    assert_near((interval.high - interval.low) / (2.0 * expanded * se), 1.0, 0.04);
    resampling.expanded = false;
    interval = interval_of(&sample, resampling);
    assert_near((interval.high - interval.low) / (2.0 * 1.95996 * se), 1.0, 0.04);
    cp_sample_destroy(&sample);
}

// Differences between strata are by design, not chance: they must not widen the interval.
static void strata_are_resampled_apart(void **state)
{
    (void)state;
    double value[40];
    size_t cluster[40], stratum[40];
    cp_rng_key key = cp_rng_key_seed(4);
    for (size_t k = 0; k < 40; k++) {
        cluster[k] = k;
        stratum[k] = k % 2;
        value[k] = 100.0 * (double)(k % 2) + cp_rng_normal(key, k);
    }
    cp_sample sample;
    cp_error error = {0};
    assert_int_equal(cp_sample_create(value, cluster, 40, 40, &sample, &error), CP_OK);
    cp_resampling resampling = cp_resampling_default();
    cp_interval pooled = interval_of(&sample, resampling);
    resampling.stratum[0] = stratum;
    cp_interval apart = interval_of(&sample, resampling);
    assert_true(pooled.high - pooled.low > 20.0);
    assert_true(apart.high - apart.low < 1.0);
    cp_sample_destroy(&sample);
}

static double difference(const unsigned *weight_a, const unsigned *weight_b, const void *context)
{
    const cp_sample *both = context;
    return cp_sample_mean(&both[1], weight_b) - cp_sample_mean(&both[0], weight_a);
}

// The same replications in both groups: paired, what they share cancels.
static void pairing_removes_what_seeds_share(void **state)
{
    (void)state;
    cp_sample both[2] = {clustered(5, CLUSTERS, 5.0, 0.0), clustered(5, CLUSTERS, 5.0, 1.0)};
    cp_resampling resampling = cp_resampling_default();
    resampling.cluster_count[0] = resampling.cluster_count[1] = CLUSTERS;
    cp_interval apart, paired;
    cp_error error = {0};
    assert_int_equal(cp_bootstrap(&resampling, difference, both, &apart, &error), CP_OK);
    resampling.paired = true;
    assert_int_equal(cp_bootstrap(&resampling, difference, both, &paired, &error), CP_OK);
    assert_true(apart.high - apart.low > 3.0);
    // Every resample gives exactly 1 up to rounding.
    if (paired.status == CP_INTERVAL_VALUE)
        assert_true(fabs(paired.low - 1.0) < 1e-9 && fabs(paired.high - 1.0) < 1e-9);
    cp_sample_destroy(&both[0]);
    cp_sample_destroy(&both[1]);
}

static double variance_of_a(const unsigned *weight_a, const unsigned *weight_b, const void *context)
{
    (void)weight_b;
    const cp_sample *sample = context;
    double mean = cp_sample_mean(sample, weight_a), sum = 0.0, count = 0.0;
    for (size_t k = 0; k < sample->count; k++) {
        double weight = weight_a[sample->cluster[k]];
        sum += weight * (sample->value[k] - mean) * (sample->value[k] - mean);
        count += weight;
    }
    return sum / count;
}

// Efron and Tibshirani 1993, section 14.2, test A of the 26 neurologically impaired children:
// variance 171.5, 90 % BCa interval 115.8 to 259.6 (plain percentiles 100.8 to 233.9).
static void bca_agrees_with_the_published_example(void **state)
{
    (void)state;
    const double value[] = {48, 36, 20, 29, 42, 42, 20, 42, 22, 41, 45, 14, 6,
                            0,  33, 28, 34, 4,  32, 24, 47, 41, 24, 26, 30, 41};
    enum { COUNT = sizeof value / sizeof *value };
    size_t cluster[COUNT];
    for (size_t k = 0; k < COUNT; k++)
        cluster[k] = k;
    cp_sample sample;
    cp_error error = {0};
    assert_int_equal(cp_sample_create(value, cluster, COUNT, COUNT, &sample, &error), CP_OK);
    cp_resampling resampling = cp_resampling_default();
    resampling.cluster_count[0] = COUNT;
    resampling.repetitions = 20000;
    resampling.level_1 = 0.9;
    resampling.expanded = false;
    cp_interval interval;
    assert_int_equal(cp_bootstrap(&resampling, variance_of_a, &sample, &interval, &error), CP_OK);
    assert_near(interval.low, 115.8, 2.5);
    assert_near(interval.high, 259.6, 5.0);
    cp_sample_destroy(&sample);
}

// Nominal 95 % on clustered values, 300 repetitions: between 91 and 98 % cover the truth, while
// taking values as independent would cover far less.
static void coverage_holds_for_clustered_values(void **state)
{
    (void)state;
    int covered = 0;
    cp_resampling resampling = cp_resampling_default();
    resampling.repetitions = 600;
    for (uint64_t repetition = 0; repetition < 300; repetition++) {
        cp_sample sample = clustered(100 + repetition, CLUSTERS, 1.0, 7.0);
        resampling.seed = repetition;
        cp_interval interval = interval_of(&sample, resampling);
        covered += interval.low <= 7.0 && 7.0 <= interval.high;
        cp_sample_destroy(&sample);
    }
    assert_in_range(covered, 273, 294);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(under_twenty_clusters_there_is_no_interval),
        cmocka_unit_test(same_seed_same_bits_other_seed_other_bits),
        cmocka_unit_test(width_is_that_of_the_cluster_means),
        cmocka_unit_test(strata_are_resampled_apart),
        cmocka_unit_test(pairing_removes_what_seeds_share),
        cmocka_unit_test(bca_agrees_with_the_published_example),
        cmocka_unit_test(coverage_holds_for_clustered_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
