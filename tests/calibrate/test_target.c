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
    static const cp_target_bounds BOUNDS[] = {{.quantity = CP_TARGET_LOSS_X, .at_s = 0.1},
                                              {.quantity = CP_TARGET_GAIN_AWAY, .at_s = 0.1},
                                              {.quantity = CP_TARGET_YAW_RATE, .at_s = 0.1},
                                              {.quantity = CP_TARGET_OLC}};
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
        .speed_km_h = 20.0, .bound_count = 1, .bound = {{.quantity = CP_TARGET_RESTITUTION}}};
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
                        .bound = {{.quantity = CP_TARGET_PEAK}}};
    double value[CP_TARGET_BOUNDS_MAX];
    values_of(&target, 1, 1, value);
    assert_true(isnan(value[0]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(excess_and_distance_count_widths),
        cmocka_unit_test(quantities_are_towards_and_away_from_the_struck_side),
        cmocka_unit_test(restitution_is_by_momentum),
        cmocka_unit_test(a_miss_has_no_value),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
