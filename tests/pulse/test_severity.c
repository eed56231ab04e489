/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pulse/severity.h"

#include "core/geometry.h"
#include "core/units.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "builders/assert_near.h"

#define INTERVAL_S 0.0005

static cp_pulse new_pulse(size_t count)
{
    cp_pulse pulse;
    assert_int_equal(cp_pulse_create(&pulse, count, INTERVAL_S, NULL), CP_OK);
    return pulse;
}

/* Straight pulse, a_x constant for the first `push` intervals, then nothing. */
static cp_pulse rectangle(size_t count, size_t push, double v0_m_s, double a_m_s2)
{
    cp_pulse pulse = new_pulse(count);
    for (size_t k = 0; k < count; k++) {
        pulse.channel[CP_CHANNEL_AX][k] = k <= push ? -a_m_s2 : 0.0;
        pulse.channel[CP_CHANNEL_VX][k] =
            v0_m_s - a_m_s2 * INTERVAL_S * (double)(k < push ? k : push);
    }
    return pulse;
}

static cp_severity judge(cp_pulse *pulse, double separation_s, int barrier)
{
    cp_severity severity;
    assert_int_equal(cp_severity_of_pulse(pulse, separation_s, barrier, &severity, NULL), CP_OK);
    cp_pulse_destroy(pulse);
    return severity;
}

static void constant_deceleration_against_a_barrier(void **state)
{
    (void)state;
    // 10 g for 100 ms from 8 m/s: stops at 81.6 ms, rebounds.
    double a_m_s2 = 10.0 * CP_G0_M_S2;
    cp_pulse pulse = rectangle(401, 200, 8.0, a_m_s2);
    cp_severity s = judge(&pulse, 0.1, 1);
    assert_near(s.end_s, 0.1, 1e-12);
    assert_near(s.delta_v_m_s, a_m_s2 * 0.1, 1e-9);
    assert_near(s.delta_v_x_m_s, a_m_s2 * 0.1, 1e-9);
    assert_near(s.delta_v_y_m_s, 0.0, 1e-12);
    assert_near(s.mean_g, 10.0, 1e-9);
    assert_near(s.max_50ms_g, 10.0, 1e-9);
    assert_near(s.asi_1, 10.0 / 12.0, 1e-9);
    assert_near(s.t_v0_s, 8.0 / a_m_s2, 1e-9);
    assert_near(s.pdof_rad, 0.0, 1e-12);
    assert_true(s.yaw_change_rad_s == 0.0);
    assert_int_equal(s.olc.status, CP_OLC_VALUE);
    // The edge of a rectangle overshoots in a Butterworth filter by a few percent.
    assert_in_range((int)(1000.0 * s.peak_g), 10000, 11500);
}

static void half_sine_peak_and_windows(void **state)
{
    (void)state;
    double peak_m_s2 = 20.0 * CP_G0_M_S2;
    cp_pulse pulse = new_pulse(401);
    for (size_t k = 0; k < 401; k++) {
        double t_s = fmin(0.1, (double)k * INTERVAL_S);
        pulse.channel[CP_CHANNEL_AX][k] = k <= 200 ? -peak_m_s2 * sin(CP_PI * t_s / 0.1) : 0.0;
        pulse.channel[CP_CHANNEL_VX][k] =
            10.0 - peak_m_s2 * 0.1 / CP_PI * (1.0 - cos(CP_PI * t_s / 0.1));
    }
    cp_severity s = judge(&pulse, 0.1, 0);
    assert_near(s.peak_g, 20.0, 0.05);
    assert_near(s.mean_g, 20.0 * 2.0 / CP_PI, 1e-6);
    // The middle 50 ms: mean of a sine from a quarter to three quarters of its half wave.
    assert_near(s.max_50ms_g, 20.0 * 4.0 / CP_PI * sin(CP_PI / 4.0), 1e-6);
    assert_near(s.asi_1, s.max_50ms_g / 12.0, 1e-9);
    assert_true(isnan(s.t_v0_s));
}

static void a_pulse_shorter_than_the_window_is_averaged_over_the_window(void **state)
{
    (void)state;
    // 20 g for 20 ms, then thrown forward again at 5 g for 20 ms: the best window begins before
    // the contact.
    cp_pulse pulse = rectangle(81, 40, 10.0, 20.0 * CP_G0_M_S2);
    for (size_t k = 41; k < 81; k++)
        pulse.channel[CP_CHANNEL_VX][k] =
            pulse.channel[CP_CHANNEL_VX][k - 1] + 5.0 * CP_G0_M_S2 * INTERVAL_S;
    cp_severity s = judge(&pulse, 0.04, 0);
    assert_near(s.max_50ms_g, 20.0 * 0.4, 1e-9);
}

static void the_end_is_separation_or_the_largest_delta_v(void **state)
{
    (void)state;
    // Separation after the largest delta-v: values at separation.
    cp_pulse pulse = rectangle(401, 100, 8.0, 100.0);
    for (size_t k = 101; k < 401; k++)
        pulse.channel[CP_CHANNEL_VX][k] = 3.0 + 2.0 * (double)(k - 100) / 300.0;
    cp_severity s = judge(&pulse, 0.125, 0);
    assert_near(s.end_s, 0.125, 1e-12);
    assert_near(s.delta_v_m_s, 4.0, 1e-9);
    assert_near(s.delta_v_x_m_s, 4.0, 1e-9);

    // Separation before it: values at the largest. Coasting afterwards adds nothing.
    pulse = rectangle(401, 100, 8.0, 100.0);
    s = judge(&pulse, 0.01, 0);
    assert_near(s.end_s, 0.05, 1e-12);
    assert_near(s.delta_v_m_s, 5.0, 1e-9);

    // Unknown separation counts as none.
    pulse = rectangle(401, 100, 8.0, 100.0);
    assert_near(judge(&pulse, NAN, 0).end_s, 0.05, 1e-12);

    // Never beyond 0.5 s.
    pulse = rectangle(1401, 1400, 80.0, 100.0);
    s = judge(&pulse, 0.65, 0);
    assert_near(s.end_s, 0.5, 1e-12);
    assert_near(s.delta_v_m_s, 50.0, 1e-8);
}

/* A car that turns at a constant rate while a force of fixed world direction acts on it. */
static void delta_v_of_a_turning_car_is_that_of_the_world(void **state)
{
    (void)state;
    double rate_rad_s = 4.0, a_m_s2 = 150.0, direction_rad = CP_PI + 0.3;
    cp_pulse pulse = new_pulse(401);
    for (size_t k = 0; k < 401; k++) {
        // a in the turning axes is (a cos(d - w t), a sin(d - w t)); v its integrals.
        double t_s = fmin(0.1, (double)k * INTERVAL_S), turned = direction_rad - rate_rad_s * t_s;
        pulse.channel[CP_CHANNEL_VX][k] =
            20.0 - a_m_s2 / rate_rad_s * (sin(turned) - sin(direction_rad));
        pulse.channel[CP_CHANNEL_VY][k] = a_m_s2 / rate_rad_s * (cos(turned) - cos(direction_rad));
        pulse.channel[CP_CHANNEL_YAW][k] = rate_rad_s * (double)k * INTERVAL_S;
        pulse.channel[CP_CHANNEL_YAW_RATE][k] = rate_rad_s + (k > 100 ? 1.5 : 0.0);
        pulse.channel[CP_CHANNEL_AX][k] = k <= 200 ? a_m_s2 * cos(turned) : 0.0;
    }
    double vx_end = pulse.channel[CP_CHANNEL_VX][200], vy_end = pulse.channel[CP_CHANNEL_VY][200];
    cp_severity s = judge(&pulse, 0.1, 0);
    assert_near(s.delta_v_m_s, a_m_s2 * 0.1, 1e-5);
    assert_near(s.pdof_rad, 0.3, 1e-6); // from the front, left of the axis
    assert_near(s.delta_v_x_m_s, 20.0 - vx_end, 1e-12);
    assert_near(s.delta_v_y_m_s, -vy_end, 1e-12);
    assert_near(s.yaw_change_rad_s, 1.5, 1e-12);
    // Here the lab's velocities and the world's differ visibly.
    assert_true(hypot(s.delta_v_x_m_s, s.delta_v_y_m_s) < s.delta_v_m_s - 0.05);
}

static void force_from_the_side_and_from_behind(void **state)
{
    (void)state;
    // Pushed to the right: struck from the left.
    cp_pulse pulse = new_pulse(201);
    for (size_t k = 0; k < 201; k++)
        pulse.channel[CP_CHANNEL_VY][k] = -90.0 * (double)k * INTERVAL_S;
    cp_severity s = judge(&pulse, 0.1, 0);
    assert_near(s.pdof_rad, CP_PI / 2.0, 1e-12);
    assert_near(s.delta_v_y_m_s, 9.0, 1e-12);
    assert_near(s.asi_1, 90.0 / CP_G0_M_S2 / 9.0, 1e-9);
    assert_near(s.max_50ms_y_g, 90.0 / CP_G0_M_S2, 1e-9);
    assert_true(isnan(s.mean_g));
    assert_int_equal(s.olc.status, CP_OLC_NO_DECELERATION);

    // Pushed forward: struck from behind.
    pulse = rectangle(201, 200, 5.0, -90.0);
    s = judge(&pulse, 0.1, 0);
    assert_near(s.pdof_rad, CP_PI, 1e-12);
    assert_near(s.delta_v_x_m_s, -9.0, 1e-12);
    assert_near(s.delta_v_m_s, 9.0, 1e-12);
}

// Constant 6 g along x and 6 g to the right together: the two parts of ASI add as squares.
static void asi_adds_both_axes(void **state)
{
    (void)state;
    cp_pulse pulse = rectangle(401, 200, 10.0, 6.0 * CP_G0_M_S2);
    for (size_t k = 1; k < 401; k++)
        pulse.channel[CP_CHANNEL_VY][k] =
            pulse.channel[CP_CHANNEL_VY][k - 1] - (k <= 200 ? 6.0 * CP_G0_M_S2 * INTERVAL_S : 0.0);
    cp_severity s = judge(&pulse, 0.1, 0);
    assert_near(s.asi_1, sqrt(0.25 + 4.0 / 9.0), 1e-9);
    assert_near(s.max_50ms_g, 6.0, 1e-9);
    assert_near(s.max_50ms_y_g, 6.0, 1e-9);
}

static void an_undisturbed_car_has_no_direction_of_force(void **state)
{
    (void)state;
    cp_pulse pulse = rectangle(401, 0, 10.0, 0.0);
    cp_severity s = judge(&pulse, NAN, 1);
    assert_true(s.end_s == 0.0 && s.delta_v_m_s == 0.0 && s.peak_g == 0.0);
    assert_true(s.max_50ms_g == 0.0 && s.asi_1 == 0.0);
    assert_true(isnan(s.pdof_rad) && isnan(s.mean_g) && isnan(s.t_v0_s));
}

static void a_pulse_too_coarse_or_too_short_is_refused(void **state)
{
    (void)state;
    cp_severity severity;
    cp_error error = {0};
    cp_pulse pulse = new_pulse(100);
    pulse.sample_interval_s = 0.005;
    assert_int_equal(cp_severity_of_pulse(&pulse, 0.1, 0, &severity, &error), CP_BAD_INPUT);
    pulse.sample_interval_s = 0.0005;
    pulse.sample_count = 1;
    assert_int_equal(cp_severity_of_pulse(&pulse, 0.1, 0, &severity, &error), CP_BAD_INPUT);
    cp_pulse_destroy(&pulse);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constant_deceleration_against_a_barrier),
        cmocka_unit_test(half_sine_peak_and_windows),
        cmocka_unit_test(a_pulse_shorter_than_the_window_is_averaged_over_the_window),
        cmocka_unit_test(the_end_is_separation_or_the_largest_delta_v),
        cmocka_unit_test(delta_v_of_a_turning_car_is_that_of_the_world),
        cmocka_unit_test(force_from_the_side_and_from_behind),
        cmocka_unit_test(asi_adds_both_axes),
        cmocka_unit_test(an_undisturbed_car_has_no_direction_of_force),
        cmocka_unit_test(a_pulse_too_coarse_or_too_short_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
