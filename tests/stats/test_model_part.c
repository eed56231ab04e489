/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/model_part.h"

#include "core/rng.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

static const cp_interval FROM_9_TO_13 = {CP_INTERVAL_VALUE, 9.0, 13.0};

// By hand: 9 and 11 have sd sqrt(2); Student's t of one degree of freedom is 12.7062.
static void two_sets_by_hand(void **state)
{
    (void)state;
    const cp_estimate of_set[] = {cp_estimate_of(9.0), cp_estimate_of(11.0)};
    cp_model_part p = cp_model_part_of(cp_estimate_of(10.0), FROM_9_TO_13, of_set, 2);
    assert_int_equal(p.status, CP_INTERVAL_VALUE);
    assert_true(p.mean == 10.0);
    assert_true(fabs(p.sd - sqrt(2.0)) < 1e-12);
    assert_true(fabs(p.half_width - 12.7062 * sqrt(2.0)) < 1e-3);
    assert_true(fabs(p.combined.low - (10.0 - hypot(1.0, p.half_width))) < 1e-12);
    assert_true(fabs(p.combined.high - (10.0 + hypot(3.0, p.half_width))) < 1e-12);
}

// Sets that agree leave the interval of the replications as it was.
static void sets_that_agree_add_nothing(void **state)
{
    (void)state;
    const cp_estimate of_set[] = {cp_estimate_of(11.0), cp_estimate_of(11.0), cp_estimate_of(11.0)};
    cp_model_part p = cp_model_part_of(cp_estimate_of(10.0), FROM_9_TO_13, of_set, 3);
    assert_true(p.sd == 0.0 && p.mean == 11.0);
    assert_true(p.combined.low == 9.0 && p.combined.high == 13.0);
}

// What is missing is said, and no number stands in its place.
static void a_missing_part_leaves_no_combined_interval(void **state)
{
    (void)state;
    const cp_estimate known[] = {cp_estimate_of(9.0), cp_estimate_of(11.0)};
    const cp_estimate censored[] = {cp_estimate_of(9.0), {CP_LESS_THAN, 5.0}};
    const cp_estimate none[] = {{CP_LESS_THAN, 5.0}, {CP_NO_VALUE, NAN}};
    const cp_interval few = {CP_INTERVAL_TOO_FEW_REPLICATIONS, NAN, NAN};
    cp_model_part p = cp_model_part_of(cp_estimate_of(10.0), few, known, 2);
    assert_int_equal(p.combined.status, CP_INTERVAL_TOO_FEW_REPLICATIONS);
    assert_true(isnan(p.combined.low) && fabs(p.sd - sqrt(2.0)) < 1e-12);
    p = cp_model_part_of(cp_estimate_of(10.0), FROM_9_TO_13, censored, 2);
    assert_int_equal(p.status, CP_INTERVAL_CENSORED);
    assert_int_equal(p.combined.status, CP_INTERVAL_CENSORED);
    assert_true(isnan(p.sd) && isnan(p.half_width) && isnan(p.combined.low));
    p = cp_model_part_of(cp_estimate_of(10.0), FROM_9_TO_13, none, 2);
    assert_int_equal(p.status, CP_INTERVAL_UNDEFINED);
    p = cp_model_part_of((cp_estimate){CP_LESS_THAN, 5.0}, FROM_9_TO_13, known, 2);
    assert_int_equal(p.status, CP_INTERVAL_CENSORED);
    const cp_interval open = {CP_INTERVAL_VALUE, -INFINITY, 13.0};
    p = cp_model_part_of(cp_estimate_of(10.0), open, known, 2);
    assert_true(p.combined.low == -INFINITY && isfinite(p.combined.high));
}

// Share of simulated studies whose combined interval holds the truth. The traffic's error is normal
// with a known standard error; truth and sets are draws of one spread around the estimate's model.
static double coverage(size_t sets, double model_sd, double standard_error)
{
    enum { STUDIES = 20000 };
    cp_rng_key key = cp_rng_key_number(cp_rng_key_seed(17), sets);
    uint64_t draw = 0;
    double held = 0.0;
    for (int study = 0; study < STUDIES; study++) {
        cp_estimate of_set[16];
        double estimate = standard_error * cp_rng_normal(key, draw++);
        double truth = model_sd * cp_rng_normal(key, draw++);
        for (size_t m = 0; m < sets; m++)
            of_set[m] = cp_estimate_of(estimate + model_sd * cp_rng_normal(key, draw++));
        cp_interval replications = {CP_INTERVAL_VALUE, estimate - 1.959964 * standard_error,
                                    estimate + 1.959964 * standard_error};
        cp_model_part p = cp_model_part_of(cp_estimate_of(estimate), replications, of_set, sets);
        held += p.combined.low <= truth && truth <= p.combined.high;
    }
    return held / STUDIES;
}

static void combined_intervals_hold_the_truth(void **state)
{
    (void)state;
    static const size_t SETS[] = {2, 4, 8, 16};
    static const double MODEL_SD[] = {0.0, 0.3, 1.0, 3.0};
    for (size_t s = 0; s < 4; s++) {
        for (size_t m = 0; m < 4; m++) {
            double held = coverage(SETS[s], MODEL_SD[m], 1.0);
            print_message("sets %2zu, model's sd over standard error %.1f: %.3f\n", SETS[s],
                          MODEL_SD[m], held);
            // Few sets make it wide, never narrow.
            assert_true(held > 0.94);
            assert_true(SETS[s] < 8 || held < 0.97);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_sets_by_hand),
        cmocka_unit_test(sets_that_agree_add_nothing),
        cmocka_unit_test(a_missing_part_leaves_no_combined_interval),
        cmocka_unit_test(combined_intervals_hold_the_truth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
