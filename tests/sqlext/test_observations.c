/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sqlext/observations.h"

#include "core/rng.h"
#include "stats/sample.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>

/* Held against the room stats, which computes the same figures for resampling. */

#define COUNT 400

// Numbers with many ties; every eighth one left-censored.
static double draw(cp_rng_key key, uint64_t k)
{
    double u = cp_rng_uniform(key, k);
    return k % 8 == 3 ? -INFINITY : floor(60 * u) / 4;
}

static void fill(cp_observations *o, uint64_t seed, size_t count)
{
    for (size_t k = 0; k < count; k++)
        assert_true(cp_observations_add(o, draw(cp_rng_key_seed(seed), k)));
}

static cp_sample sample_of(const cp_observations *o)
{
    size_t cluster[COUNT] = {0};
    cp_sample sample;
    assert_int_equal(cp_sample_create(o->value + o->first, cluster, o->count, 1, &sample, NULL),
                     CP_OK);
    return sample;
}

static bool same(double one, double other)
{
    return (isnan(one) && isnan(other)) || one == other || fabs(one - other) < 1e-12;
}

static void quantiles_are_those_of_stats(void **state)
{
    (void)state;
    for (size_t count = 1; count < 40; count++) {
        cp_observations o = {0};
        fill(&o, count, count);
        cp_sample sample = sample_of(&o);
        for (double p = 0; p <= 1.0; p += 0.0625)
            assert_true(same(cp_sorted_quantile(cp_observations_sorted(&o), count, p),
                             cp_sample_quantile(&sample, NULL, p)));
        cp_sample_destroy(&sample);
        cp_observations_destroy(&o);
    }
    assert_true(isnan(cp_sorted_quantile(NULL, 0, 0.5)));
}

static void cliffs_delta_is_that_of_stats(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed < 20; seed++) {
        cp_observations a = {0}, b = {0};
        fill(&a, seed, 7 * seed % 50 + 1);
        fill(&b, seed + 100, 11 * seed % 70 + 1);
        cp_sample sample_a = sample_of(&a), sample_b = sample_of(&b);
        assert_true(same(cp_sorted_cliffs_delta(cp_observations_sorted(&a), a.count,
                                                cp_observations_sorted(&b), b.count),
                         cp_sample_cliffs_delta(&sample_a, NULL, &sample_b, NULL)));
        cp_sample_destroy(&sample_a);
        cp_sample_destroy(&sample_b);
        cp_observations_destroy(&a);
        cp_observations_destroy(&b);
    }
    const double one[] = {1.0};
    assert_true(isnan(cp_sorted_cliffs_delta(one, 1, NULL, 0)));
}

// By its definition: over every value of either sample.
static void ks_distance_is_the_largest_step(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed < 20; seed++) {
        cp_observations a = {0}, b = {0};
        double largest = 0.0;
        fill(&a, seed, 5 * seed % 40 + 1);
        fill(&b, seed + 100, 13 * seed % 60 + 1);
        for (size_t k = 0; k < a.count + b.count; k++) {
            double x = k < a.count ? a.value[k] : b.value[k - a.count];
            double share[2] = {0, 0};
            for (size_t i = 0; i < a.count; i++)
                share[0] += a.value[i] <= x;
            for (size_t i = 0; i < b.count; i++)
                share[1] += b.value[i] <= x;
            largest = fmax(largest, fabs(share[0] / (double)a.count - share[1] / (double)b.count));
        }
        assert_true(same(cp_sorted_ks_distance(cp_observations_sorted(&a), a.count,
                                               cp_observations_sorted(&b), b.count),
                         largest));
        cp_observations_destroy(&a);
        cp_observations_destroy(&b);
    }
}

// A window that slides: whatever way the sorted values are kept, they are those of the window.
static void window_slides(void **state)
{
    (void)state;
    cp_observations o = {0};
    cp_rng_key key = cp_rng_key_seed(3);
    size_t first = 0;
    for (size_t k = 0; k < COUNT; k++) {
        assert_true(cp_observations_add(&o, draw(key, k)));
        if (o.count > 25 || k % 7 == 5) {
            cp_observations_drop_oldest(&o);
            first++;
        }
        if (k < 30) // until then nobody asks
            continue;
        const double *sorted = cp_observations_sorted(&o);
        assert_int_equal(o.count, k + 1 - first);
        double sum = 0.0, wanted = 0.0;
        size_t censored = 0, wanted_censored = 0;
        for (size_t i = 0; i < o.count; i++) {
            double x = draw(key, first + i);
            assert_true(i == 0 || sorted[i - 1] <= sorted[i]);
            isinf(sorted[i]) ? (void)censored++ : (void)(sum += sorted[i]);
            isinf(x) ? (void)wanted_censored++ : (void)(wanted += x);
        }
        assert_int_equal(censored, wanted_censored);
        assert_true(sum == wanted); // quarters: exact
    }
    while (o.count > 0)
        cp_observations_drop_oldest(&o);
    cp_observations_drop_oldest(&o);
    assert_null(cp_observations_sorted(&o));
    cp_observations_destroy(&o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quantiles_are_those_of_stats),
        cmocka_unit_test(cliffs_delta_is_that_of_stats),
        cmocka_unit_test(ks_distance_is_the_largest_step),
        cmocka_unit_test(window_slides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
