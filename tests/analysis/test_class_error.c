/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/class_error.h"

#include "analysis/comparison.h"
#include "core/rng.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "builders/small_study.h"

enum { CLASSES = 3, CRASHES = 40, WORLDS = 20000 };

// OLC, class and its relative error of invented crashes of two arms.
typedef struct arm {
    double olc_g[CRASHES];
    size_t class_of[CRASHES];
} arm;

static const double ERROR_1[CLASSES] = {0.1, 0.2, 0.3};

static void fill(arm *a, uint64_t seed, double mean_g, size_t favoured)
{
    cp_rng_key key = cp_rng_key_seed(seed);
    for (size_t k = 0; k < CRASHES; k++) {
        a->olc_g[k] = mean_g + 2.0 * cp_rng_uniform(key, k);
        a->class_of[k] = cp_rng_uniform(key, 1000 + k) < 0.5 ? favoured : k % CLASSES;
    }
}

static void mean_errors(const arm *a, double mean_g[CLASSES])
{
    memset(mean_g, 0, CLASSES * sizeof *mean_g);
    for (size_t k = 0; k < CRASHES; k++)
        mean_g[a->class_of[k]] += a->olc_g[k] * ERROR_1[a->class_of[k]] / CRASHES;
}

static double mean_in_world(const arm *a, const double error[CLASSES])
{
    double sum = 0.0;
    for (size_t k = 0; k < CRASHES; k++)
        sum += a->olc_g[k] * (1.0 + error[a->class_of[k]]);
    return sum / CRASHES;
}

// In worlds whose classes are wrong by an error of their own, the difference of means scatters as
// said, and the true one lies within two standard errors as often as of a normal law.
static void the_error_is_the_scatter_over_worlds(void **state)
{
    (void)state;
    arm baseline, treatment;
    double mean_g[2][CLASSES], squares = 0.0;
    fill(&baseline, 1, 20.0, 0);
    fill(&treatment, 2, 6.0, 2);
    mean_errors(&baseline, mean_g[0]);
    mean_errors(&treatment, mean_g[1]);
    double error_g = cp_class_error_difference(mean_g[0], mean_g[1], CLASSES);
    const double none[CLASSES] = {0.0};
    double known_g = mean_in_world(&treatment, none) - mean_in_world(&baseline, none);
    size_t within = 0;
    for (uint64_t world = 0; world < WORLDS; world++) {
        double error[CLASSES];
        for (uint64_t c = 0; c < CLASSES; c++)
            error[c] = ERROR_1[c] * cp_rng_normal(cp_rng_key_seed(77), CLASSES * world + c);
        double off_g = mean_in_world(&treatment, error) - mean_in_world(&baseline, error) - known_g;
        squares += off_g * off_g;
        within += fabs(off_g) <= 1.96 * error_g;
    }
    // Five standard errors of a standard deviation, and of a share.
    assert_true(fabs(sqrt(squares / WORLDS) / error_g - 1.0) < 5.0 / sqrt(2.0 * WORLDS));
    assert_true(fabs(within / (double)WORLDS - 0.95) < 5.0 * sqrt(0.95 * 0.05 / WORLDS));
}

static void what_both_arms_share_cancels(void **state)
{
    (void)state;
    const double one[CLASSES] = {1.0, 0.5, 0.0}, other[CLASSES] = {1.0, 0.5, 1.2};
    assert_true(cp_class_error_difference(one, one, CLASSES) == 0.0);
    assert_true(fabs(cp_class_error_difference(one, other, CLASSES) - 1.2) < 1e-12);
    assert_true(cp_class_error_difference(one, other, 0) == 0.0);
}

// Of a study: vehicles with and without a class, and what they leave of the contrast.
static void of_a_study_it_counts_and_sums(void **state)
{
    (void)state;
    cp_store *store = open_study("small_study.db");
    cp_study_data data = {0};
    cp_error error = {0};
    if (cp_study_data_read(store, &data, &error) != CP_OK)
        fail_msg("%s", error.text);
    const cp_slice everything = {CP_SLICE_ALL, CP_SLICE_ALL, NULL};
    cp_replication_set set[2] = {{0}, {0}};
    for (size_t g = 0; g < 2; g++)
        assert_int_equal(cp_replication_set_create(&data, everything, g, &set[g], &error), CP_OK);

    // No crash of it has a class.
    cp_class_error found;
    assert_int_equal(cp_class_error_of(&data, set, everything, &found, &error), CP_OK);
    assert_true(isnan(found.error_g) && found.without[0] == found.vehicles[0]);
    assert_true(found.vehicles[0] > 0 && found.vehicles[1] > 0);

    // One class of 2 g for all frontal vehicles of the baseline, 0.5 g for those of the treatment.
    static char *names[] = {"wall"};
    data.evidence_count = 1;
    data.evidence = names;
    for (size_t k = 0; k < data.vehicle_count; k++) {
        const cp_study_crash *crash = &data.crash[data.vehicle[k].crash];
        bool is_first = data.replication[crash->replication].variant == 0;
        data.vehicle[k].class_error_g = is_first ? 2.0 : 0.5;
    }
    assert_int_equal(cp_class_error_of(&data, set, everything, &found, &error), CP_OK);
    assert_true(fabs(found.error_g - 1.5) < 1e-12);
    assert_int_equal(found.without[0] + found.without[1], 0);
    data.evidence_count = 0;
    data.evidence = NULL;
    for (size_t g = 0; g < 2; g++)
        cp_replication_set_destroy(&set[g]);
    cp_study_data_destroy(&data);
    cp_store_close(store);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_error_is_the_scatter_over_worlds),
        cmocka_unit_test(what_both_arms_share_cancels),
        cmocka_unit_test(of_a_study_it_counts_and_sums),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
