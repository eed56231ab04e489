/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "calibrate/simplex.h"

// Rosenbrock's valley with its bottom at (0.6, 0.36) in 0..1 coordinates.
static double valley(void *context, const double *p, size_t dimension)
{
    (void)context;
    (void)dimension;
    double across = p[1] - p[0] * p[0];
    return (0.6 - p[0]) * (0.6 - p[0]) + 10.0 * across * across;
}

static void it_walks_down_the_valley(void **state)
{
    (void)state;
    double point[2] = {0.1, 0.9}, value = 0.0;
    cp_error error = {0};
    assert_int_equal(cp_simplex_search(valley, NULL, 2, 0.2, 2000, point, &value, NULL, &error),
                     CP_OK);
    assert_near(point[0], 0.6, 1e-3);
    assert_near(point[1], 0.36, 2e-3);
    assert_near(value, valley(NULL, point, 2), 0.0);
}

// Falls towards a bottom outside of the bounds.
static double slope(void *context, const double *p, size_t dimension)
{
    (void)context;
    (void)dimension;
    assert_true(p[0] >= 0.0 && p[0] <= 1.0 && p[1] >= 0.0 && p[1] <= 1.0);
    return p[0] + (p[1] - 0.5) * (p[1] - 0.5);
}

static void it_keeps_the_bounds(void **state)
{
    (void)state;
    double point[2] = {0.8, 0.1}, value = 0.0;
    cp_error error = {0};
    assert_int_equal(cp_simplex_search(slope, NULL, 2, 0.2, 1000, point, &value, NULL, &error),
                     CP_OK);
    assert_near(point[0], 0.0, 1e-3);
    assert_near(point[1], 0.5, 1e-2);
}

static void it_stops_at_its_budget(void **state)
{
    (void)state;
    double point[2] = {0.1, 0.9}, value = 0.0, start = valley(NULL, point, 2);
    cp_error error = {0};
    assert_int_equal(cp_simplex_search(valley, NULL, 2, 0.2, 10, point, &value, NULL, &error),
                     CP_OK);
    assert_true(value <= start && value > 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_walks_down_the_valley),
        cmocka_unit_test(it_keeps_the_bounds),
        cmocka_unit_test(it_stops_at_its_budget),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
