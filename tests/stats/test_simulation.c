/* SPDX-License-Identifier: GPL-3.0-or-later */
// Short versions of the simulations whose tables are coverage.md and null_study.md.
#include "stats/null_study.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

enum { STUDIES = 200, REPETITIONS = 300 };

// Identical variants, independent and clustered crashes, both designs: no p-value betrays which
// seeds were called treatment. Fixed seeds; a test of single values would fail by far (below).
static void p_values_of_identical_variants_are_uniform(void **state)
{
    (void)state;
    static double p[NULL_TESTS * STUDIES];
    for (int paired = 0; paired < 2; paired++) {
        for (int clustered = 0; clustered < 2; clustered++) {
            simulated_design d = {.replications = 20,
                                  .mean_crashes = 6.0,
                                  .rho = clustered ? 0.5 : 0.0,
                                  .rate_ratio = 1.0,
                                  .paired = paired};
            null_p_values(&d, 50000, STUDIES, 199, p);
            for (int test = 0; test < NULL_TESTS; test++) {
                null_summary s = null_summary_of(p + test * STUDIES, STUDIES);
                if (s.p < 0.01 || s.rejected_1 > 0.10)
                    fail_msg("%s, rho %g, paired %d: rejects %.3f, distance %.3f, p %.4f",
                             NULL_TEST_TEXT[test], d.rho, paired, s.rejected_1, s.distance, s.p);
            }
        }
    }
}

// The same clustered crashes with every crash taken for a replication of its own: the test must
// fall, else the one above would show nothing.
static void ignoring_replications_is_found_out(void **state)
{
    (void)state;
    static double p[STUDIES];
    simulated_design d = {.replications = 20, .mean_crashes = 6.0, .rho = 0.5, .rate_ratio = 1.0};
    for (uint64_t k = 0; k < STUDIES; k++) {
        simulated_variant side[2] = {simulate_variant(&d, 50000 + k, 0),
                                     simulate_variant(&d, 50000 + k, 1)};
        cp_resampling r = cp_resampling_default();
        r.repetitions = 1;
        for (int g = 0; g < 2; g++) {
            for (size_t j = 0; j < side[g].sample.count; j++)
                side[g].sample.cluster[j] = j;
            side[g].sample.cluster_count = r.cluster_count[g] = side[g].sample.count;
        }
        cp_contrast c;
        cp_error error = {0};
        assert_int_equal(cp_contrast_samples(&side[0].sample, &side[1].sample, &r, 199, &c, &error),
                         CP_OK);
        p[k] = c.mann_whitney.p;
        simulated_variant_destroy(&side[0]);
        simulated_variant_destroy(&side[1]);
    }
    null_summary s = null_summary_of(p, STUDIES);
    assert_true(s.rejected_1 > 0.15);
    assert_true(s.p < 0.01);
}

// Nominal 95 % at 20 and 40 replications of clustered crashes; 300 repetitions of 400 resamples.
// Bounds: three standard errors of an entry around 93 and 97, which coverage.md measures finely.
static void intervals_hold_the_truth(void **state)
{
    (void)state;
    for (int n = 0; n < 2; n++) {
        simulated_design d = {.replications = n ? 40 : 20,
                              .mean_crashes = n ? 3.0 : 10.0,
                              .rho = 0.3,
                              .rate_ratio = 0.7,
                              .shift = -0.2};
        simulated_truth truth = simulated_truth_of(&d);
        double covered[4] = {0.0};
        for (uint64_t k = 0; k < REPETITIONS; k++) {
            simulated_variant a = simulate_variant(&d, 9000 + k, 0);
            simulated_variant b = simulate_variant(&d, 9000 + k, 1);
            cp_resampling r = cp_resampling_default();
            r.cluster_count[0] = r.cluster_count[1] = d.replications;
            r.repetitions = 400;
            r.seed = k;
            cp_contrast c;
            cp_interval ratio;
            cp_exposure ea = simulated_exposure(&a), eb = simulated_exposure(&b);
            cp_error error = {0};
            assert_int_equal(cp_contrast_samples(&a.sample, &b.sample, &r, 0, &c, &error), CP_OK);
            assert_int_equal(cp_rate_ratio_bootstrap(&ea, &eb, &r, &ratio, &error), CP_OK);
            const cp_interval interval[] = {c.mean_interval, c.median_interval,
                                            c.cliffs_delta_interval, ratio};
            const double wanted[] = {truth.mean_difference, truth.median_difference,
                                     truth.cliffs_delta, truth.rate_ratio};
            for (int f = 0; f < 4; f++)
                covered[f] += interval[f].low <= wanted[f] && wanted[f] <= interval[f].high;
            simulated_variant_destroy(&a);
            simulated_variant_destroy(&b);
        }
        for (int f = 0; f < 4; f++) {
            double share = covered[f] / REPETITIONS;
            if (share < 0.93 - 3.0 * 0.0126 || share > 0.97 + 3.0 * 0.0126)
                fail_msg("%zu replications, figure %d: %.3f", d.replications, f, share);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(p_values_of_identical_variants_are_uniform),
        cmocka_unit_test(ignoring_replications_is_found_out),
        cmocka_unit_test(intervals_hold_the_truth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
