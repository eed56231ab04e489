/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "calibrate/least_squares.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { POINTS = 20 };

// A curve a exp(-b t) sampled at twenty times; a few samples spoilt by `outlier`.
typedef struct curve {
    double sample[POINTS];
    size_t calls;
} curve;

static double curve_at(const double *p, int k)
{
    return (1.0 + 4.0 * p[0]) * exp(-(0.5 + 2.0 * p[1]) * 0.1 * k);
}

static curve make_curve(double a, double b, double outlier)
{
    curve c = {.calls = 0};
    double p[2] = {a, b};
    for (int k = 0; k < POINTS; k++)
        c.sample[k] = curve_at(p, k) + (k % 7 == 3 ? outlier : 0.0);
    return c;
}

static double misfit(void *context, const double *p, size_t dimension, double *residual,
                     size_t count)
{
    curve *c = context;
    assert_int_equal(dimension, 2);
    assert_int_equal(count, POINTS);
    double sum = 0.0;
    for (int k = 0; k < POINTS; k++) {
        assert_true(p[0] >= 0.0 && p[0] <= 1.0 && p[1] >= 0.0 && p[1] <= 1.0);
        residual[k] = curve_at(p, k) - c->sample[k];
        sum += fabs(residual[k]);
    }
    c->calls++;
    return sum / POINTS;
}

static cp_least_squares settings_for(curve *c, size_t evaluations)
{
    return (cp_least_squares){.function = misfit,
                              .context = c,
                              .dimension = 2,
                              .count = POINTS,
                              .soft = 0.05,
                              .step = 0.01,
                              .evaluations = evaluations};
}

static void it_finds_the_curve_in_few_evaluations(void **state)
{
    (void)state;
    curve c = make_curve(0.7, 0.3, 0.0);
    cp_least_squares settings = settings_for(&c, 60);
    double point[2] = {0.1, 0.9}, value = 0.0;
    cp_error error = {0};
    assert_int_equal(cp_least_squares_search(&settings, point, &value, &error), CP_OK);
    assert_near(point[0], 0.7, 1e-3);
    assert_near(point[1], 0.3, 1e-3);
    assert_true(value < 1e-3);
    assert_true(c.calls <= 60);
}

static void a_few_spoilt_samples_do_not_pull_it_away(void **state)
{
    (void)state;
    curve c = make_curve(0.7, 0.3, 3.0);
    cp_least_squares settings = settings_for(&c, 400);
    double point[2] = {0.1, 0.9}, value = 0.0;
    cp_error error = {0};
    assert_int_equal(cp_least_squares_search(&settings, point, &value, &error), CP_OK);

    // Plain least squares would move the first coordinate by 0.05 and more.
    assert_near(point[0], 0.7, 0.02);
    assert_near(point[1], 0.3, 0.02);
}

static void a_bottom_outside_ends_on_the_bound(void **state)
{
    (void)state;
    curve c = make_curve(1.3, 0.3, 0.0);
    cp_least_squares settings = settings_for(&c, 200);
    double point[2] = {0.5, 0.5}, value = 0.0;
    cp_error error = {0};
    assert_int_equal(cp_least_squares_search(&settings, point, &value, &error), CP_OK);
    assert_near(point[0], 1.0, 0.01);
    double best[POINTS];
    assert_near(value, misfit(&c, point, 2, best, POINTS), 0.0);
}

static void the_robust_mean_lies_between_the_two_means(void **state)
{
    (void)state;
    const double MISFIT[] = {3.0, -0.5, 0.0, 1.0, -2.0};
    double absolute = 6.5 / 5.0, root_mean_square = sqrt(14.25 / 5.0);
    assert_near(cp_robust_mean(MISFIT, 5, 1e-6), absolute, 1e-5);
    assert_near(cp_robust_mean(MISFIT, 5, 1e3), root_mean_square, 1e-5);
    double between = cp_robust_mean(MISFIT, 5, 1.0);
    assert_true(between > absolute && between < root_mean_square);

    // Where all are the same it is them.
    const double SAME[] = {0.7, -0.7, 0.7};
    assert_near(cp_robust_mean(SAME, 3, 0.3), 0.7, 1e-12);
}

static void fewer_residuals_than_unknowns_are_refused(void **state)
{
    (void)state;
    curve c = make_curve(0.5, 0.5, 0.0);
    cp_least_squares settings = settings_for(&c, 20);
    settings.count = 1;
    double point[2] = {0.5, 0.5}, value = 0.0;
    cp_error error = {0};
    assert_int_equal(cp_least_squares_search(&settings, point, &value, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "as many residuals as unknowns: 2, found 1"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_finds_the_curve_in_few_evaluations),
        cmocka_unit_test(a_few_spoilt_samples_do_not_pull_it_away),
        cmocka_unit_test(a_bottom_outside_ends_on_the_bound),
        cmocka_unit_test(the_robust_mean_lies_between_the_two_means),
        cmocka_unit_test(fewer_residuals_than_unknowns_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
