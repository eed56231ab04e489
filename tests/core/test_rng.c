/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/rng.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "builders/assert_near.h"

#define DRAWS 200000

/* Fixed for ever: a change would silently change every study's driver errors. Reckoned from the
 * definition by an independent program. */
static void draws_are_the_same_for_ever(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_seed(42);
    assert_true(key.value == UINT64_C(0xd6f8dddd0708e485));
    assert_true(cp_rng_bits(key, 0) == UINT64_C(0x8bc14c2939a82052));
    key = cp_rng_key_text(cp_rng_key_number(key, 7), "failed_to_see");
    assert_true(key.value == UINT64_C(0x9a1be0113f50fa6e));
    key = cp_rng_key_text(key, "veh.12");
    assert_true(key.value == UINT64_C(0x47630f01a13337a6));
    assert_true(cp_rng_uniform(key, 3) == 0.63208960950270998);
    assert_near(cp_rng_exponential(key, 3, 2.0), -2.0 * log(1.0 - 0.63208960950270998), 1e-14);
}

static void every_part_of_the_name_counts(void **state)
{
    (void)state;
    cp_rng_key root = cp_rng_key_seed(1);
    cp_rng_key ab_c = cp_rng_key_text(cp_rng_key_text(root, "ab"), "c");
    cp_rng_key a_bc = cp_rng_key_text(cp_rng_key_text(root, "a"), "bc");
    cp_rng_key abc = cp_rng_key_text(root, "abc");
    assert_true(ab_c.value != a_bc.value && abc.value != ab_c.value && abc.value != a_bc.value);
    assert_true(cp_rng_key_text(root, "").value != root.value);
    assert_true(cp_rng_key_text(root, "12345678").value !=
                cp_rng_key_text(cp_rng_key_text(root, "12345678"), "").value);
    assert_true(cp_rng_key_seed(1).value != cp_rng_key_seed(2).value);
    // Order of ego and opponent.
    assert_true(cp_rng_key_text(cp_rng_key_text(root, "ego"), "foe").value !=
                cp_rng_key_text(cp_rng_key_text(root, "foe"), "ego").value);
}

static void uniform_draws_fill_the_unit_interval_evenly(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(3), "uniform");
    int bin[20] = {0};
    double lowest = 1.0, highest = 0.0;
    for (uint64_t k = 0; k < DRAWS; k++) {
        double u = cp_rng_uniform(key, k);
        assert_true(u >= 0.0 && u < 1.0);
        lowest = fmin(lowest, u);
        highest = fmax(highest, u);
        bin[(int)(20.0 * u)]++;
    }
    // Chi-square with 19 degrees of freedom: 43.8 is exceeded once in a thousand seeds.
    double chi_square = 0.0, expected = DRAWS / 20.0;
    for (int k = 0; k < 20; k++)
        chi_square += (bin[k] - expected) * (bin[k] - expected) / expected;
    assert_true(chi_square < 43.8);
    assert_true(lowest < 1e-4 && highest > 1.0 - 1e-4);
}

static void neighbouring_keys_and_counters_are_unrelated(void **state)
{
    (void)state;
    double by_counter = 0.0, by_key = 0.0;
    for (uint64_t k = 0; k < DRAWS; k++) {
        cp_rng_key key = cp_rng_key_number(cp_rng_key_seed(9), k);
        cp_rng_key next = cp_rng_key_number(cp_rng_key_seed(9), k + 1);
        double u = cp_rng_uniform(key, 0) - 0.5;
        by_counter += u * (cp_rng_uniform(key, 1) - 0.5) * 12.0 / DRAWS;
        by_key += u * (cp_rng_uniform(next, 0) - 0.5) * 12.0 / DRAWS;
    }
    // Correlations of independent draws scatter by 1/sqrt(DRAWS) = 0.0022.
    assert_near(by_counter, 0.0, 0.009);
    assert_near(by_key, 0.0, 0.009);
}

static void every_bit_is_set_half_the_time(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_seed(0);
    int set[64] = {0};
    for (uint64_t k = 0; k < DRAWS; k++) {
        uint64_t bits = cp_rng_bits(key, k);
        for (int b = 0; b < 64; b++)
            set[b] += (int)(bits >> b & 1);
    }
    for (int b = 0; b < 64; b++) // 4.5 standard deviations
        assert_near(set[b] / (double)DRAWS, 0.5, 4.5 * 0.5 / sqrt(DRAWS));
}

static void exponential_and_normal_draws_have_their_moments(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(5), "moments");
    double mean = 0.0, beyond = 0.0, normal_1 = 0.0, normal_2 = 0.0, normal_4 = 0.0, within = 0.0;
    for (uint64_t k = 0; k < DRAWS; k++) {
        double e = cp_rng_exponential(key, k, 3.0), z = cp_rng_normal(key, k);
        assert_true(e >= 0.0 && isfinite(e) && isfinite(z));
        mean += e / DRAWS;
        beyond += (e > 3.0) / (double)DRAWS;
        normal_1 += z / DRAWS;
        normal_2 += z * z / DRAWS;
        normal_4 += z * z * z * z / DRAWS;
        within += (fabs(z) < 1.0) / (double)DRAWS;
    }
    assert_near(mean, 3.0, 0.03);
    assert_near(beyond, exp(-1.0), 0.005);
    assert_near(normal_1, 0.0, 0.01);
    assert_near(normal_2, 1.0, 0.015);
    assert_near(normal_4, 3.0, 0.12);
    assert_near(within, 0.682689, 0.005);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(draws_are_the_same_for_ever),
        cmocka_unit_test(every_part_of_the_name_counts),
        cmocka_unit_test(uniform_draws_fill_the_unit_interval_evenly),
        cmocka_unit_test(neighbouring_keys_and_counters_are_unrelated),
        cmocka_unit_test(every_bit_is_set_half_the_time),
        cmocka_unit_test(exponential_and_normal_draws_have_their_moments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
