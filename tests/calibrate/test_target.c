/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "builders/crash_builder.h"
#include "builders/crash_library.h"

#include "calibrate/target.h"

#include <math.h>

static void values_of(const cp_target *targets, size_t count, int threads, double *value)
{
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_error error = {0};
    if (cp_target_values(targets, count, &car, 0.0005, threads, value, &error) != CP_OK)
        fail_msg("%s", error.text);
}

static void excess_and_distance_count_widths(void **state)
{
    (void)state;
    const cp_target_bounds bounds = {.min = 10.0, .max = 20.0, .aim = 12.0};
    assert_near(cp_target_excess(&bounds, 15.0), 0.0, 0.0);
    assert_near(cp_target_excess(&bounds, 23.0), 0.3, 1e-12);
    assert_near(cp_target_excess(&bounds, 5.0), -0.5, 1e-12);
    assert_true(cp_target_excess(&bounds, NAN) >= 1.0);
    assert_near(cp_target_distance(&bounds, 12.0), 0.0, 0.0);
    assert_near(cp_target_distance(&bounds, 17.0), 0.5, 1e-12);
    assert_near(cp_target_distance(&bounds, 99.0), 0.8, 1e-12);
    assert_near(cp_target_distance(&bounds, -99.0), -0.2, 1e-12);
}

// A wall off to the right gives the mirror image of one to the left: the same quantities.
static void quantities_are_towards_and_away_from_the_struck_side(void **state)
{
    (void)state;
    static const cp_target_bounds BOUNDS[] = {{.quantity = CP_SUITE_dvx_m_s, .at_s = 0.1},
                                              {.quantity = CP_SUITE_dvy_away_m_s, .at_s = 0.1},
                                              {.quantity = CP_SUITE_yaw_rate_at_deg_s, .at_s = 0.1},
                                              {.quantity = CP_SUITE_olc_g}};
    cp_target targets[2] = {0};
    for (int k = 0; k < 2; k++) {
        targets[k] = (cp_target){.speed_km_h = 64.0,
                                 .offset_mm = k == 0 ? 1400.0 : -1400.0,
                                 .has_barrier = true,
                                 .barrier = cp_barrier_default(),
                                 .bound_count = 4};
        for (int b = 0; b < 4; b++)
            targets[k].bound[b] = BOUNDS[b];
    }
    double one[2 * CP_TARGET_BOUNDS_MAX], two[2 * CP_TARGET_BOUNDS_MAX];
    values_of(targets, 2, 1, one);
    values_of(targets, 2, 2, two);
    for (int b = 0; b < 4; b++) {
        assert_near(one[b], one[CP_TARGET_BOUNDS_MAX + b], 1e-4 * fabs(one[b]));
        assert_near(one[b], two[b], 0.0);
    }
    assert_true(one[0] > 1.0); // slower
    assert_true(one[1] > 0.0); // pushed away from the wall
    assert_true(one[2] > 0.0); // its nose turns to the wall
}

// Restitution is that of whole cars: against the barrier it is what the momentum says.
static void restitution_is_by_momentum(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_target target = {
        .speed_km_h = 20.0, .bound_count = 1, .bound = {{.quantity = CP_SUITE_restitution_1}}};
    double wall[CP_TARGET_BOUNDS_MAX], cars[CP_TARGET_BOUNDS_MAX];
    values_of(&target, 1, 1, wall);
    cp_crash_configuration crash = crash_builder_configuration(&car, NULL, 20.0, 0.0, 0, 0);
    cp_crash_options options = cp_crash_options_default();
    cp_crash_result result = crash_builder_simulate(&car, NULL, &crash, &options);
    double after_m_s = result.momentum_end.linear_kg_m_s.x / car.mass_kg;
    assert_near(wall[0], -after_m_s / (20.0 / 3.6), 1e-9);
    cp_crash_result_destroy(&result);

    // Two like cars part as each parts from the wall, nearly.
    target.against_itself = true;
    values_of(&target, 1, 1, cars);
    assert_true(wall[0] > 0.0 && wall[0] < 1.0);
    assert_near(cars[0], wall[0], 0.06);
}

// A crash that cannot be has no values.
static void a_miss_has_no_value(void **state)
{
    (void)state;
    cp_target target = {.speed_km_h = 50.0,
                        .offset_mm = 3000.0,
                        .has_barrier = true,
                        .barrier = cp_barrier_default(),
                        .bound_count = 1,
                        .bound = {{.quantity = CP_SUITE_peak_g}}};
    double value[CP_TARGET_BOUNDS_MAX];
    values_of(&target, 1, 1, value);
    assert_true(isnan(value[0]));
}

// What a fit aims at is what a suite compares: one pulse, both measure the same.
static void fits_measure_as_suites_do(void **state)
{
    (void)state;
    char keys[CP_TARGET_KEYS_SIZE];
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_target target = {.speed_km_h = 50.0, .bound_count = 3};
    target.bound[0].quantity = cp_target_kind_find("crush_mm")->quantity;
    target.bound[1].quantity = cp_target_kind_find("t_v0_ms")->quantity;
    target.bound[2] =
        (cp_target_bounds){.quantity = cp_target_kind_find("loss_x_m_s")->quantity, .at_s = 0.05};
    double value[CP_TARGET_BOUNDS_MAX];
    cp_error error = {0};
    if (cp_target_values(&target, 1, &car, 0.0005, 1, value, &error) != CP_OK)
        fail_msg("%s", error.text);
    cp_crash_options options = cp_crash_options_default();
    options.time_step_s = 0.0005;
    cp_crash_configuration configuration;
    cp_crash_result result;
    double speed_m_s = cp_m_s_from_km_h(50.0);
    assert_int_equal(cp_crash_configuration_from_description(&car, NULL, NULL, speed_m_s, speed_m_s,
                                                             0.0, 0.0, &configuration, &error),
                     CP_OK);
    assert_int_equal(cp_crash_simulate(&car, NULL, &configuration, &options, &result, &error),
                     CP_OK);
    for (size_t b = 0; b < 3; b++) {
        const cp_suite_look look = {
            .quantity = target.bound[b].quantity, .time_s = target.bound[b].at_s, .side_1 = 1.0};
        double per_si = 1.0 / cp_target_kind_of(look.quantity)->si_per_unit;
        assert_near(per_si * value[b], cp_suite_quantity_of(&look, &result), 1e-9);
    }
    // The way of the passenger cell, whose integration lags by half a step of the first speed.
    double way_m = 0.0;
    for (size_t k = 0; k < result.pulse[0].sample_count; k++)
        way_m = fmax(way_m, result.pulse[0].channel[CP_CHANNEL_X][k]);
    assert_near(value[0], way_m + 0.5 * result.pulse[0].sample_interval_s * speed_m_s, 1e-4);
    cp_crash_result_destroy(&result);
    assert_string_equal(cp_target_keys(keys),
                        "olc_g, peak_g, crush_mm, t_v0_ms, rebound_m_s, loss_x_m_s, "
                        "gain_away_m_s, yaw_rate_deg_s or restitution_1");
    assert_null(cp_target_kind_find("crush"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(excess_and_distance_count_widths),
        cmocka_unit_test(quantities_are_towards_and_away_from_the_struck_side),
        cmocka_unit_test(restitution_is_by_momentum),
        cmocka_unit_test(a_miss_has_no_value),
        cmocka_unit_test(fits_measure_as_suites_do),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
