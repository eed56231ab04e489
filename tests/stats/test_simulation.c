/* SPDX-License-Identifier: GPL-3.0-or-later */
// Short versions of the simulations whose tables are coverage.md and null_study.md. Seeds are
// fixed; bounds are three standard errors of the share seen here around 3 to 7, or 93 to 97 per
// cent.
#include "stats/null_study.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

enum { STUDIES = 200 };

static double reach(double share, double given)
{
    return 3.0 * sqrt(share * (1.0 - share) / given);
}

static null_counts simulate(simulated_design d)
{
    null_counts c = {{0.0}, {0.0}};
    for (uint64_t k = 0; k < STUDIES; k++)
        null_study(&d, 50000 + k, 300, 99, &c);
    return c;
}

// Half, a fifth, a twentieth of the crashes, the severity the same: no test betrays the treatment.
static void tests_keep_their_size_when_crash_rates_differ(void **state)
{
    (void)state;
    const simulated_design cells[] = {
        null_cell(5, 30, 0.3, 0.2, true),   null_cell(10, 10, 0.3, 0.05, false),
        null_cell(20, 10, 0.0, 0.05, true), null_cell(20, 30, 0.3, 0.2, false),
        null_cell(20, 30, 0.3, 1.0, true),
    };
    for (size_t k = 0; k < sizeof cells / sizeof *cells; k++) {
        null_counts c = simulate(cells[k]);
        for (int f = 0; f < NULL_COUNT; f++) {
            if (!NULL_IS_TEST[f] || NULL_IS_OLD[f] || c.given[f] < 100.0)
                continue;
            double size = c.hits[f] / c.given[f];
            if (size < 0.03 - reach(0.03, c.given[f]) || size > 0.07 + reach(0.07, c.given[f]))
                fail_msg("cell %zu, %s: rejects %.3f of %g", k, NULL_TEXT[f], size, c.given[f]);
        }
        assert_true(c.given[NULL_SEVERITY] >= 100.0);
    }
}

// The simulation can see a wrong test: permuted replications reject several times too often.
static void permuted_replications_are_found_out(void **state)
{
    (void)state;
    null_counts c = simulate(null_cell(20, 10, 0.0, 0.05, true));
    assert_true(c.hits[NULL_SEVERITY_OLD] > 0.15 * c.given[NULL_SEVERITY_OLD]);
    assert_true(c.hits[NULL_DISTANCE_OLD] > 0.25 * c.given[NULL_DISTANCE_OLD]);
}

// Three crashes in the smaller variant: hardly ever a test, and never an interval of severity.
static void three_crashes_are_too_few(void **state)
{
    (void)state;
    null_counts c = simulate(null_cell(20, 3, 0.3, 0.2, true));
    for (int f = NULL_DELTA; f <= NULL_P90; f++)
        assert_true(c.given[f] <= 0.05 * STUDIES);
    assert_true(c.given[NULL_SEVERITY] <= 0.05 * STUDIES);
    assert_true(c.given[NULL_RATIO] >= 0.95 * STUDIES);
    assert_true(c.hits[NULL_RATIO] >= (0.93 - reach(0.93, STUDIES)) * c.given[NULL_RATIO]);
}

// Every interval that is given holds the truth often enough, from five replications on.
static void intervals_hold_the_truth(void **state)
{
    (void)state;
    const simulated_design cells[] = {
        null_cell(5, 30, 0.3, 0.5, false), null_cell(10, 10, 0.3, 1.0, false),
        null_cell(20, 30, 0.3, 0.2, true), {40, 3.0, 0.3, 0.7, -0.2, false},
        {20, 10.0, 0.3, 0.7, -0.2, true},
    };
    for (size_t k = 0; k < sizeof cells / sizeof *cells; k++) {
        null_counts c = simulate(cells[k]);
        for (int f = 0; f < NULL_COUNT; f++) {
            if (NULL_IS_TEST[f] || NULL_IS_OLD[f] || c.given[f] < 100.0)
                continue;
            // Not 97: few replications make intervals of rates wider than they need be.
            double share = c.hits[f] / c.given[f];
            if (share < 0.93 - reach(0.93, c.given[f]))
                fail_msg("cell %zu, %s: holds %.3f of %g", k, NULL_TEXT[f], share, c.given[f]);
        }
    }
}

// Replications that differ by a factor of their own: plain Poisson intervals miss more than a
// third.
static void counts_that_scatter_widen_the_poisson_interval(void **state)
{
    (void)state;
    double plain = 0.0, widened = 0.0;
    const simulated_design d = {
        .replications = 10, .mean_crashes = 10, .rho = 0.8, .rate_ratio = 1};
    for (uint64_t k = 0; k < STUDIES; k++) {
        simulated_variant a = simulate_variant(&d, 7000 + k, 0);
        simulated_variant b = simulate_variant(&d, 7000 + k, 1);
        cp_exposure ea = simulated_exposure(&a), eb = simulated_exposure(&b);
        cp_resampling r = cp_resampling_default();
        r.cluster_count[0] = r.cluster_count[1] = d.replications;
        cp_widening w;
        cp_interval i = cp_rate_ratio_poisson(&ea, &eb, 0.95);
        plain += i.low <= 1.0 && 1.0 <= i.high;
        i = cp_rate_ratio_widened(&ea, &eb, &r, &w);
        widened += i.low <= 1.0 && 1.0 <= i.high;
        simulated_variant_destroy(&a);
        simulated_variant_destroy(&b);
    }
    if (plain > 0.75 * STUDIES)
        fail_msg("plain holds %.3f", plain / STUDIES);
    if (widened < (0.93 - reach(0.93, STUDIES)) * STUDIES)
        fail_msg("holds %.3f", widened / STUDIES);
}

static void signed_ranks_by_replication_keep_their_size(void **state)
{
    (void)state;
    for (int clustered = 0; clustered < 2; clustered++) {
        simulated_design d = {.replications = 20, .rho = clustered ? 0.5 : 0.0};
        double rejected = 0.0;
        for (uint64_t k = 0; k < STUDIES; k++)
            rejected += null_signed_rank(&d, 50000 + k, 199) <= 0.05;
        assert_true(rejected >= (0.03 - reach(0.03, STUDIES)) * STUDIES);
        assert_true(rejected <= (0.07 + reach(0.07, STUDIES)) * STUDIES);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tests_keep_their_size_when_crash_rates_differ),
        cmocka_unit_test(permuted_replications_are_found_out),
        cmocka_unit_test(three_crashes_are_too_few),
        cmocka_unit_test(intervals_hold_the_truth),
        cmocka_unit_test(counts_that_scatter_widen_the_poisson_interval),
        cmocka_unit_test(signed_ranks_by_replication_keep_their_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
