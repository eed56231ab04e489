/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/describe.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "builders/assert_near.h"

static const size_t ONE_CLUSTER[16] = {0};

static cp_sample sample_of(const double *values, size_t count)
{
    cp_sample sample;
    cp_error error = {0};
    assert_int_equal(cp_sample_create(values, ONE_CLUSTER, count, 1, &sample, &error), CP_OK);
    return sample;
}

static void assert_estimate(cp_estimate found, cp_relation relation, double value)
{
    assert_int_equal(found.relation, relation);
    assert_near(found.value, value, 1e-12);
}

// R: quantile(c(7,1,3,12,5,9,2,30,4,6), c(0,.25,.5,.75,.9,.95,1)), mean, sd.
static void figures_agree_with_r(void **state)
{
    (void)state;
    cp_sample sample = sample_of((const double[]){7, 1, 3, 12, 5, 9, 2, 30, 4, 6}, 10);
    cp_description d = cp_describe(&sample);
    assert_int_equal(d.count, 10);
    assert_int_equal(d.censored, 0);
    assert_near(d.mean, 7.9, 1e-12);
    assert_near(d.sd, sqrt(640.9 / 9.0), 1e-12);
    assert_estimate(d.minimum, CP_EXACTLY, 1);
    assert_estimate(d.q25, CP_EXACTLY, 3.25);
    assert_estimate(d.median, CP_EXACTLY, 5.5);
    assert_estimate(d.q75, CP_EXACTLY, 8.5);
    assert_estimate(d.p90, CP_EXACTLY, 13.8);
    assert_estimate(d.p95, CP_EXACTLY, 21.9);
    assert_estimate(d.maximum, CP_EXACTLY, 30);
    cp_sample_destroy(&sample);
}

// Two of five censored: they lower the median from 20 to 10 and take no part in the mean.
static void censored_values_count_below_every_value(void **state)
{
    (void)state;
    cp_sample sample = sample_of((const double[]){20, -INFINITY, 30, 10, -INFINITY}, 5);
    cp_description d = cp_describe(&sample);
    assert_int_equal(d.count, 5);
    assert_int_equal(d.censored, 2);
    assert_near(d.mean, 20, 1e-12);
    assert_near(d.sd, 10, 1e-12);
    assert_estimate(d.median, CP_EXACTLY, 10);
    assert_estimate(d.q25, CP_LESS_THAN, 10);
    assert_estimate(d.minimum, CP_LESS_THAN, 10);
    assert_estimate(d.q75, CP_EXACTLY, 20);
    assert_near(cp_ecdf(&sample, 0.0), 0.4, 1e-12);
    assert_near(cp_ecdf(&sample, 10.0), 0.6, 1e-12);
    assert_near(cp_ecdf(&sample, 9.999), 0.4, 1e-12);
    assert_near(cp_ecdf(&sample, 30.0), 1.0, 1e-12);
    cp_sample_destroy(&sample);
}

// A quantile between a censored observation and a value has nothing to interpolate from.
static void quantile_on_the_edge_of_censoring_is_censored(void **state)
{
    (void)state;
    cp_sample sample = sample_of((const double[]){-INFINITY, -INFINITY, 8, 9}, 4);
    assert_estimate(cp_describe_quantile(&sample, 0.5), CP_LESS_THAN, 8);
    assert_estimate(cp_describe_quantile(&sample, 2.0 / 3.0), CP_EXACTLY, 8);
    cp_sample_destroy(&sample);
}

static void nothing_and_only_censored_have_no_figures(void **state)
{
    (void)state;
    cp_sample nothing = sample_of((const double[]){0}, 0);
    cp_description d = cp_describe(&nothing);
    assert_int_equal(d.count, 0);
    assert_true(isnan(d.mean));
    assert_int_equal(d.median.relation, CP_NO_VALUE);
    assert_true(isnan(cp_ecdf(&nothing, 1.0)));
    cp_sample_destroy(&nothing);

    cp_sample censored = sample_of((const double[]){-INFINITY, -INFINITY}, 2);
    d = cp_describe(&censored);
    assert_int_equal(d.censored, 2);
    assert_int_equal(d.median.relation, CP_NO_VALUE);
    assert_near(cp_ecdf(&censored, 0.0), 1.0, 0.0);
    cp_sample_destroy(&censored);
}

static void difference_keeps_the_side_that_is_open(void **state)
{
    (void)state;
    cp_estimate ten = {CP_EXACTLY, 10}, below_two = {CP_LESS_THAN, 2}, none = {CP_NO_VALUE, NAN};
    assert_estimate(cp_estimate_difference(ten, (cp_estimate){CP_EXACTLY, 7}), CP_EXACTLY, -3);
    assert_estimate(cp_estimate_difference(ten, below_two), CP_LESS_THAN, -8);
    assert_estimate(cp_estimate_difference(below_two, ten), CP_MORE_THAN, 8);
    assert_int_equal(cp_estimate_difference(below_two, below_two).relation, CP_NO_VALUE);
    assert_int_equal(cp_estimate_difference(ten, none).relation, CP_NO_VALUE);
}

// A weight is as good as a copy.
static void weights_stand_for_copies(void **state)
{
    (void)state;
    const double values[] = {5, 1, 9, 3};
    const size_t cluster[] = {0, 1, 2, 1};
    const unsigned weight[] = {2, 1, 0};
    cp_error error = {0};
    cp_sample sample;
    assert_int_equal(cp_sample_create(values, cluster, 4, 3, &sample, &error), CP_OK);
    cp_sample copies = sample_of((const double[]){5, 5, 1, 3}, 4);
    assert_near(cp_sample_mean(&sample, weight), 3.5, 1e-12);
    for (double p = 0.0; p <= 1.0; p += 0.0625)
        assert_near(cp_sample_quantile(&sample, weight, p), cp_sample_quantile(&copies, NULL, p),
                    1e-12);
    assert_near(cp_sample_cliffs_delta(&copies, NULL, &sample, weight), 0.0, 1e-12);
    cp_sample_destroy(&sample);
    cp_sample_destroy(&copies);
}

static void bad_observations_are_refused(void **state)
{
    (void)state;
    cp_error error = {0};
    cp_sample sample;
    const size_t cluster[] = {0, 3};
    assert_int_equal(cp_sample_create((const double[]){NAN}, cluster, 1, 1, &sample, &error),
                     CP_BAD_INPUT);
    assert_int_equal(cp_sample_create((const double[]){1, 2}, cluster, 2, 3, &sample, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "cluster"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figures_agree_with_r),
        cmocka_unit_test(censored_values_count_below_every_value),
        cmocka_unit_test(quantile_on_the_edge_of_censoring_is_censored),
        cmocka_unit_test(nothing_and_only_censored_have_no_figures),
        cmocka_unit_test(difference_keeps_the_side_that_is_open),
        cmocka_unit_test(weights_stand_for_copies),
        cmocka_unit_test(bad_observations_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
