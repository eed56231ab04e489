/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pulse/olc.h"

#include "core/rng.h"
#include "core/units.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "builders/assert_near.h"

#define COUNT 1001
#define INTERVAL_S 0.0005

/* Velocity of a car that decelerates at a from v0 and then stays at rest. */
static void brake_to_rest(double *vx_m_s, double v0_m_s, double a_m_s2)
{
    for (int k = 0; k < COUNT; k++)
        vx_m_s[k] = fmax(0.0, v0_m_s - a_m_s2 * k * INTERVAL_S);
}

/* Half-sine pulse of 100 ms with a given velocity change. */
static void half_sine(double *vx_m_s, int count, double v0_m_s, double delta_v_m_s)
{
    for (int k = 0; k < count; k++) {
        double t_s = fmin(0.1, k * INTERVAL_S);
        vx_m_s[k] = v0_m_s - 0.5 * delta_v_m_s * (1.0 - cos(CP_PI * t_s / 0.1));
    }
}

static void constant_deceleration_gives_1_27660_times_it(void **state)
{
    (void)state;
    for (double a_g = 5.0; a_g <= 60.0; a_g += 5.0) {
        double vx_m_s[COUNT];
        for (int k = 0; k < COUNT; k++)
            vx_m_s[k] = 30.0 - a_g * CP_G0_M_S2 * k * INTERVAL_S;
        cp_olc olc = cp_olc_from_velocity(vx_m_s, COUNT, INTERVAL_S);
        assert_int_equal(olc.status, CP_OLC_VALUE);
        assert_near(olc.olc_g / (0.300 / 0.235 * a_g), 1.0, 1e-10);
        assert_near(olc.t1_s, sqrt(2.0 * 0.065 / (a_g * CP_G0_M_S2)), 1e-12);
    }
}

static void the_starting_speed_does_not_matter(void **state)
{
    (void)state;
    double slow[COUNT], fast[COUNT];
    half_sine(slow, COUNT, 0.0, 12.0); // struck while standing
    half_sine(fast, COUNT, 25.0, 12.0);
    cp_olc a = cp_olc_from_velocity(slow, COUNT, INTERVAL_S);
    cp_olc b = cp_olc_from_velocity(fast, COUNT, INTERVAL_S);
    assert_int_equal(a.status, CP_OLC_VALUE);
    assert_near(a.olc_g, b.olc_g, 1e-9);
}

static void a_car_at_rest_before_t2_follows_the_closed_form(void **state)
{
    (void)state;
    // The sampling is chosen so that the kink at rest falls on a sample: then linear is exact.
    double v0_m_s = 56.0 / 3.6, a_m_s2 = 20.0 * CP_G0_M_S2, stop_s = v0_m_s / a_m_s2;
    double interval_s = stop_s / 150.0, vx_m_s[COUNT];
    for (int k = 0; k < COUNT; k++)
        vx_m_s[k] = k < 150 ? v0_m_s - a_m_s2 * k * interval_s : 0.0;
    cp_olc olc = cp_olc_from_velocity(vx_m_s, COUNT, interval_s);
    double crush_m = 0.5 * v0_m_s * stop_s, t1_s = sqrt(2.0 * 0.065 / a_m_s2);
    assert_near(olc.t1_s, t1_s, 1e-12);
    assert_near(olc.olc_g, v0_m_s * v0_m_s / (2.0 * (0.300 + crush_m - v0_m_s * t1_s)) / CP_G0_M_S2,
                1e-9);

    // The published figures.
    brake_to_rest(vx_m_s, v0_m_s, a_m_s2);
    olc = cp_olc_from_velocity(vx_m_s, COUNT, INTERVAL_S);
    assert_near(olc.t1_s, 0.02575, 5e-6);
    assert_near(olc.olc_g, 23.89, 0.005);
}

static void half_sines_reach_their_published_figures(void **state)
{
    (void)state;
    // The record ends with the pulse: the rest is coasting.
    double vx_m_s[201];
    half_sine(vx_m_s, 201, 3.0, 3.0);
    cp_olc olc = cp_olc_from_velocity(vx_m_s, 201, INTERVAL_S);
    assert_int_equal(olc.status, CP_OLC_VALUE);
    assert_near(olc.t2_s, 0.231, 0.0005);
    assert_near(olc.olc_g, 1.90, 0.005);
    half_sine(vx_m_s, 201, 2.0, 2.0);
    olc = cp_olc_from_velocity(vx_m_s, 201, INTERVAL_S);
    assert_near(olc.t2_s, 0.318, 0.0005);
    assert_near(olc.olc_g, 0.86, 0.005);
}

static void a_record_cut_short_counts_as_coasting(void **state)
{
    (void)state;
    double vx_m_s[COUNT];
    half_sine(vx_m_s, COUNT, 3.0, 3.0);
    cp_olc whole = cp_olc_from_velocity(vx_m_s, COUNT, INTERVAL_S);
    cp_olc cut = cp_olc_from_velocity(vx_m_s, 201, INTERVAL_S);
    assert_near(whole.olc_g, cut.olc_g, 1e-10);
    assert_near(whole.t2_s, cut.t2_s, 1e-12);
}

static void a_mild_pulse_is_beyond_the_horizon(void **state)
{
    (void)state;
    double vx_m_s[201];
    half_sine(vx_m_s, 201, 10.0, 1.0); // t1 reached, t2 not
    cp_olc olc = cp_olc_from_velocity(vx_m_s, 201, INTERVAL_S);
    assert_int_equal(olc.status, CP_OLC_BEYOND_HORIZON);
    assert_true(isnan(olc.olc_g) && isnan(olc.t1_s) && isnan(olc.t2_s));
    half_sine(vx_m_s, 201, 10.0, 0.05); // not even t1
    assert_int_equal(cp_olc_from_velocity(vx_m_s, 201, INTERVAL_S).status, CP_OLC_BEYOND_HORIZON);
}

static void the_horizon_is_exactly_half_a_second(void **state)
{
    (void)state;
    // A velocity step at once: s = u t, t1 = 0.065/u, and f = 0.3 at t2 = 0.535/u.
    for (int late = 0; late < 2; late++) {
        double u_m_s = 0.535 / (late ? 0.5005 : 0.4995);
        double vx_m_s[2] = {5.0, 5.0 - u_m_s};
        cp_olc olc = cp_olc_from_velocity(vx_m_s, 2, 1e-9);
        assert_int_equal(olc.status, late ? CP_OLC_BEYOND_HORIZON : CP_OLC_VALUE);
        if (!late)
            assert_near(olc.olc_g, u_m_s * u_m_s / 0.47 / CP_G0_M_S2, 1e-6);
    }
}

static void a_car_that_never_slows_down_has_no_deceleration(void **state)
{
    (void)state;
    double vx_m_s[COUNT];
    for (int k = 0; k < COUNT; k++)
        vx_m_s[k] = 10.0 + 0.01 * k;
    assert_int_equal(cp_olc_from_velocity(vx_m_s, COUNT, INTERVAL_S).status,
                     CP_OLC_NO_DECELERATION);
    for (int k = 0; k < COUNT; k++)
        vx_m_s[k] = 10.0 - (k > 0 ? 1e-12 : 0.0); // rounding
    assert_int_equal(cp_olc_from_velocity(vx_m_s, COUNT, INTERVAL_S).status,
                     CP_OLC_NO_DECELERATION);
}

static void a_broken_record_is_a_failed_simulation(void **state)
{
    (void)state;
    double vx_m_s[COUNT];
    half_sine(vx_m_s, COUNT, 15.0, 16.0);
    vx_m_s[77] = NAN;
    cp_olc olc = cp_olc_from_velocity(vx_m_s, COUNT, INTERVAL_S);
    assert_int_equal(olc.status, CP_OLC_SIMULATION_FAILED);
    assert_true(isnan(olc.olc_g));
}

/* Random monotone pulses: the three defining equations hold, whatever the sampling. */
static void the_defining_equations_hold_on_random_pulses(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(1), "olc");
    for (uint64_t run = 0; run < 200; run++) {
        double vx_m_s[201], interval_s = 0.001 + 0.001 * cp_rng_uniform(key, 1000 * run);
        vx_m_s[0] = 15.0;
        for (uint64_t k = 1; k < 201; k++)
            vx_m_s[k] = vx_m_s[k - 1] - 0.6 * cp_rng_uniform(key, 1000 * run + k);
        cp_olc olc = cp_olc_from_velocity(vx_m_s, 201, interval_s);
        assert_int_equal(olc.status, CP_OLC_VALUE);

        // Integrate independently: trapezes up to each time (linear velocity: exact).
        double s[2] = {0}, v[2], time_s[2] = {olc.t1_s, olc.t2_s};
        for (int e = 0; e < 2; e++) {
            int last = (int)(time_s[e] / interval_s);
            for (int k = 0; k < last; k++)
                s[e] += interval_s * (15.0 - 0.5 * (vx_m_s[k] + vx_m_s[k + 1]));
            double rest_s = time_s[e] - last * interval_s;
            v[e] = vx_m_s[last] + (vx_m_s[last + 1] - vx_m_s[last]) * rest_s / interval_s;
            s[e] += rest_s * (15.0 - 0.5 * (vx_m_s[last] + v[e]));
        }
        double olc_m_s2 = olc.olc_g * CP_G0_M_S2, since_s = olc.t2_s - olc.t1_s;
        assert_near(s[0], 0.065, 1e-10);
        assert_near(s[1] - 0.5 * olc_m_s2 * since_s * since_s, 0.300, 1e-10);
        assert_near(olc_m_s2 * since_s, 15.0 - v[1], 1e-10);
    }
}

static void statuses_have_their_database_texts(void **state)
{
    (void)state;
    assert_string_equal(cp_olc_status_text(CP_OLC_VALUE), "value");
    assert_string_equal(cp_olc_status_text(CP_OLC_NOT_FRONT_CONTACT), "not_front_contact");
    assert_string_equal(cp_olc_status_text(CP_OLC_NO_DECELERATION), "no_deceleration");
    assert_string_equal(cp_olc_status_text(CP_OLC_BEYOND_HORIZON), "beyond_0_5_s");
    assert_string_equal(cp_olc_status_text(CP_OLC_SIMULATION_FAILED), "simulation_failed");
}

static void the_scatter_of_several_olc(void **state)
{
    (void)state;
    cp_olc olc[3] = {{CP_OLC_VALUE, 10.0, 0.0, 0.0},
                     {CP_OLC_VALUE, 13.0, 0.0, 0.0},
                     {CP_OLC_VALUE, 16.0, 0.0, 0.0}};
    assert_near(cp_olc_sd(olc, 3), 3.0, 1e-12);
    olc[0] = (cp_olc){CP_OLC_NO_DECELERATION, NAN, NAN, NAN};
    assert_near(cp_olc_sd(olc, 2), 13.0 / sqrt(2.0), 1e-12);
    olc[1].status = CP_OLC_SIMULATION_FAILED;
    assert_true(isnan(cp_olc_sd(olc, 3)));
    assert_true(isnan(cp_olc_sd(olc, 1)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constant_deceleration_gives_1_27660_times_it),
        cmocka_unit_test(the_starting_speed_does_not_matter),
        cmocka_unit_test(a_car_at_rest_before_t2_follows_the_closed_form),
        cmocka_unit_test(half_sines_reach_their_published_figures),
        cmocka_unit_test(a_record_cut_short_counts_as_coasting),
        cmocka_unit_test(a_mild_pulse_is_beyond_the_horizon),
        cmocka_unit_test(the_horizon_is_exactly_half_a_second),
        cmocka_unit_test(a_car_that_never_slows_down_has_no_deceleration),
        cmocka_unit_test(a_broken_record_is_a_failed_simulation),
        cmocka_unit_test(the_defining_equations_hold_on_random_pulses),
        cmocka_unit_test(statuses_have_their_database_texts),
        cmocka_unit_test(the_scatter_of_several_olc),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
