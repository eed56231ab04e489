/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pulse/cfc_filter.h"

#include "core/units.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "builders/assert_near.h"

#define COUNT 4000
#define INTERVAL_S 0.0001

/* Gain of the two passes together, |H|^2 of the bilinear Butterworth two-pole. */
static double analytic_gain(double frequency_hz, double cfc)
{
    double ratio = tan(CP_PI * frequency_hz * INTERVAL_S) / tan(CP_PI * cfc * 2.0775 * INTERVAL_S);
    return 1.0 / (1.0 + pow(ratio, 4.0));
}

/* Amplitude (and phase) of a sine after the filter, from the middle of the record. */
static void measure(double frequency_hz, double cfc, double *amplitude, double *phase_rad)
{
    double value[COUNT];
    for (int k = 0; k < COUNT; k++)
        value[k] = sin(2.0 * CP_PI * frequency_hz * k * INTERVAL_S);
    assert_int_equal(cp_cfc_filter(value, COUNT, INTERVAL_S, cfc, NULL), CP_OK);
    double in = 0.0, quadrature = 0.0;
    int samples = (int)lround(round(0.2 * frequency_hz) / frequency_hz / INTERVAL_S);
    for (int k = 1000; k < 1000 + samples; k++) {
        in += value[k] * sin(2.0 * CP_PI * frequency_hz * k * INTERVAL_S) * 2.0 / samples;
        quadrature += value[k] * cos(2.0 * CP_PI * frequency_hz * k * INTERVAL_S) * 2.0 / samples;
    }
    *amplitude = hypot(in, quadrature);
    *phase_rad = atan2(quadrature, in);
}

static void sines_are_damped_as_the_standard_says_without_delay(void **state)
{
    (void)state;
    static const double CLASS[] = {60, 180, 600};
    for (int c = 0; c < 3; c++)
        for (double share = 0.25; share < 3.0; share *= 2.0) {
            double frequency_hz = CLASS[c] * share, amplitude, phase_rad;
            // Whole periods in whole samples keep the measurement free of leakage.
            frequency_hz = 10000.0 / round(10000.0 / frequency_hz);
            measure(frequency_hz, CLASS[c], &amplitude, &phase_rad);
            assert_near(amplitude, analytic_gain(frequency_hz, CLASS[c]), 1e-4);
            assert_near(phase_rad, 0.0, 1e-4);
        }
}

static void cfc60_passes_three_decibels_less_at_100_hz(void **state)
{
    (void)state;
    double amplitude, phase_rad;
    measure(100.0, 60, &amplitude, &phase_rad);
    assert_near(20.0 * log10(amplitude), -3.0, 0.15);
}

static void constants_and_straight_lines_pass_unchanged(void **state)
{
    (void)state;
    double value[500];
    for (int k = 0; k < 500; k++)
        value[k] = 7.0;
    assert_int_equal(cp_cfc_filter(value, 500, INTERVAL_S, 60, NULL), CP_OK);
    for (int k = 0; k < 500; k++)
        assert_near(value[k], 7.0, 1e-12);

    // The point-mirrored ends continue a line as itself.
    for (int k = 0; k < 500; k++)
        value[k] = 3.0 - 0.2 * k;
    assert_int_equal(cp_cfc_filter(value, 500, INTERVAL_S, 60, NULL), CP_OK);
    for (int k = 0; k < 500; k++)
        assert_near(value[k], 3.0 - 0.2 * k, 1e-6);
}

static void a_mirrored_record_gives_the_mirrored_result(void **state)
{
    (void)state;
    double forward[800], backward[800];
    for (int k = 0; k < 800; k++)
        forward[k] = sin(0.03 * k) + (k > 300 && k < 420 ? 5.0 : 0.0);
    for (int k = 0; k < 800; k++)
        backward[k] = forward[799 - k];
    assert_int_equal(cp_cfc_filter(forward, 800, 0.0005, 60, NULL), CP_OK);
    assert_int_equal(cp_cfc_filter(backward, 800, 0.0005, 60, NULL), CP_OK);
    for (int k = 0; k < 800; k++)
        assert_near(forward[k], backward[799 - k], 1e-6);
}

static void short_records_work(void **state)
{
    (void)state;
    double value[3] = {1.0, 2.0, 3.0};
    assert_int_equal(cp_cfc_filter(value, 0, INTERVAL_S, 60, NULL), CP_OK);
    assert_int_equal(cp_cfc_filter(value, 1, INTERVAL_S, 60, NULL), CP_OK);
    assert_true(value[0] == 1.0);
    assert_int_equal(cp_cfc_filter(value, 3, INTERVAL_S, 60, NULL), CP_OK);
    assert_true(isfinite(value[0]) && isfinite(value[1]) && isfinite(value[2]));
}

static void a_corner_beyond_a_quarter_of_the_rate_is_refused(void **state)
{
    (void)state;
    double value[10] = {0};
    cp_error error = {0};
    double limit_s = 0.25 / (60 * 2.0775);
    assert_int_equal(cp_cfc_filter(value, 10, 0.999 * limit_s, 60, &error), CP_OK);
    assert_int_equal(cp_cfc_filter(value, 10, 1.001 * limit_s, 60, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "CFC 60"));
    assert_int_equal(cp_cfc_filter(value, 10, 0.0005, 0.0, &error), CP_BAD_INPUT);
    assert_int_equal(cp_cfc_filter(value, 10, NAN, 60, &error), CP_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sines_are_damped_as_the_standard_says_without_delay),
        cmocka_unit_test(cfc60_passes_three_decibels_less_at_100_hz),
        cmocka_unit_test(constants_and_straight_lines_pass_unchanged),
        cmocka_unit_test(a_mirrored_record_gives_the_mirrored_result),
        cmocka_unit_test(short_records_work),
        cmocka_unit_test(a_corner_beyond_a_quarter_of_the_rate_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
