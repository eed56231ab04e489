/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "calibrate/suite_quantity.h"
#include "core/units.h"

#include <math.h>

static const double INTERVAL_S = 0.0005;
enum { SAMPLES = 641 };

// A car that decelerates evenly from v_m_s to -rebound_m_s within time_s, is pushed to the right by
// push_m_s and turned by yaw_rate_rad_s meanwhile, then coasts.
typedef struct even_crash {
    double v_m_s;
    double rebound_m_s;
    double time_s;
    double push_m_s;
    double yaw_rate_rad_s;
} even_crash;

static void fill(const even_crash *crash, cp_pulse *pulse, cp_severity *severity)
{
    cp_error error = {0};
    assert_int_equal(cp_pulse_create(pulse, SAMPLES, INTERVAL_S, &error), CP_OK);
    for (size_t k = 0; k < SAMPLES; k++) {
        double share = fmin(1.0, (double)k * INTERVAL_S / crash->time_s);
        pulse->channel[CP_CHANNEL_VX][k] =
            crash->v_m_s - share * (crash->v_m_s + crash->rebound_m_s);
        pulse->channel[CP_CHANNEL_VY][k] = -share * crash->push_m_s;
        pulse->channel[CP_CHANNEL_YAW_RATE][k] = share * crash->yaw_rate_rad_s;
        pulse->channel[CP_CHANNEL_AX][k] =
            share < 1.0 ? -(crash->v_m_s + crash->rebound_m_s) / crash->time_s : 0.0;
    }
    assert_int_equal(cp_severity_of_pulse(pulse, crash->time_s, 1, severity, &error), CP_OK);
}

static double quantity(cp_suite_quantity which, double time_s, double side_1,
                       const cp_crash_result *result, const cp_crash_result *wall)
{
    cp_suite_look look = {.quantity = which,
                          .time_s = time_s,
                          .side_1 = side_1,
                          .mass_kg = {1500.0, 3000.0},
                          .cell_mass_kg = {1200.0, 2500.0},
                          .wall = wall};
    return cp_suite_quantity_of(&look, result);
}

static void an_even_crash_has_closed_forms(void **state)
{
    (void)state;
    const even_crash crash = {15.0, 1.5, 0.11, 3.0, 2.0};
    cp_crash_result result = {.vehicle_count = 1};
    fill(&crash, &result.pulse[0], &result.severity[0]);

    // a = 150 m/s2: it stands after v / a, having gone v^2 / 2 a; rebounding adds nothing.
    assert_near(quantity(CP_SUITE_crush_mm, 0, 1, &result, NULL), 750.0, 0.1);
    assert_near(quantity(CP_SUITE_peak_g, 0, 1, &result, NULL), 150.0 / CP_G0_M_S2, 1.5);
    assert_near(quantity(CP_SUITE_cell_force_kn, 0, 1, &result, NULL),
                1.2 * CP_G0_M_S2 * quantity(CP_SUITE_peak_g, 0, 1, &result, NULL), 1e-9);
    assert_near(quantity(CP_SUITE_dvx_m_s, 0.06, 1, &result, NULL), 9.0, 1e-9);
    assert_near(quantity(CP_SUITE_dvx_m_s, 0.15, 1, &result, NULL), 16.5, 1e-9);
    assert_near(quantity(CP_SUITE_restitution_1, 0, 1, &result, NULL), 0.1, 1e-9);
    assert_near(quantity(CP_SUITE_yaw_rate_deg_s, 0, 1, &result, NULL), cp_deg_from_rad(2.0), 1e-9);
    assert_near(quantity(CP_SUITE_olc_g, 0, 1, &result, NULL), result.severity[0].olc.olc_g, 0.0);

    // Pushed to the right is away from what stands to the left, and the other way round.
    assert_near(quantity(CP_SUITE_dvy_away_m_s, 0.055, 1, &result, NULL), 1.5, 1e-9);
    assert_near(quantity(CP_SUITE_dvy_away_m_s, 0.055, -1, &result, NULL), -1.5, 1e-9);
    assert_near(quantity(CP_SUITE_yaw_rate_deg_s, 0, -1, &result, NULL), -cp_deg_from_rad(2.0),
                1e-9);

    // At separation in the axes of the first heading; the yaw channel says that it has not turned.
    assert_near(quantity(CP_SUITE_separation_dvx_m_s, 0, 1, &result, NULL), 16.5, 1e-9);
    assert_near(quantity(CP_SUITE_separation_dvy_m_s, 0, 1, &result, NULL), 3.0, 1e-9);
    assert_near(quantity(CP_SUITE_separation_vx_m_s, 0, 1, &result, NULL), -1.5, 1e-9);

    // Beyond the record there is nothing.
    assert_true(isnan(quantity(CP_SUITE_dvx_m_s, 0.4, 1, &result, NULL)));
    cp_crash_result_destroy(&result);
}

static void pairs_are_compared_with_each_other_and_a_wall(void **state)
{
    (void)state;
    const even_crash light = {10.0, 2.0, 0.1, 0.0, 0.0}, heavy = {5.0, 1.0, 0.1, 0.0, 0.0};
    const even_crash against_wall = {10.0, 2.0, 0.08, 0.0, 0.0};
    cp_crash_result pair = {.vehicle_count = 2}, wall = {.vehicle_count = 1};
    fill(&light, &pair.pulse[0], &pair.severity[0]);
    fill(&heavy, &pair.pulse[1], &pair.severity[1]);
    fill(&against_wall, &wall.pulse[0], &wall.severity[0]);

    // 12 and 6 m/s of 1500 and 3000 kg; 18 m/s of 15 closing.
    assert_near(quantity(CP_SUITE_momentum_ratio_1, 0, 1, &pair, &wall), 1.0, 1e-12);
    assert_near(quantity(CP_SUITE_restitution_1, 0, 1, &pair, &wall), 0.2, 1e-12);
    assert_near(quantity(CP_SUITE_delta_v_m_s, 0, 1, &pair, &wall), 12.0, 1e-9);

    // 120 against 150 m/s2, farthest apart when the wall's car has rebounded for good (80 ms) and
    // the pair's has lost 9.6 m/s of 12.
    assert_near(quantity(CP_SUITE_wall_difference_pct, 0, 1, &pair, &wall), 24.0, 1e-6);
    cp_crash_result_destroy(&wall);

    // Rebounding at 5 instead of 2 m/s counts.
    const even_crash bouncing = {10.0, 5.0, 0.1, 0.0, 0.0};
    wall = (cp_crash_result){.vehicle_count = 1};
    fill(&bouncing, &wall.pulse[0], &wall.severity[0]);
    assert_near(quantity(CP_SUITE_wall_difference_pct, 0, 1, &pair, &wall), 30.0, 1e-6);
    cp_crash_result_destroy(&pair);
    cp_crash_result_destroy(&wall);
}

static void names_are_found(void **state)
{
    (void)state;
    assert_int_equal(cp_suite_quantity_find("crush_mm"), CP_SUITE_crush_mm);
    assert_int_equal(cp_suite_quantity_find("crush"), CP_SUITE_QUANTITY_COUNT);
    assert_true(cp_suite_quantity_is_timed(CP_SUITE_dvx_m_s));
    assert_false(cp_suite_quantity_is_timed(CP_SUITE_olc_g));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_even_crash_has_closed_forms),
        cmocka_unit_test(pairs_are_compared_with_each_other_and_a_wall),
        cmocka_unit_test(names_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
