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

#include "crash/crush_block.h"

static const cp_crush_law LAW = {.begin_m = 0.05,
                                 .begin_n = 20e3,
                                 .end_m = 0.45,
                                 .end_n = 60e3,
                                 .unload_n_m = 4e6,
                                 .stop_n_m = 4e6};

static void it_resists_as_its_law_and_its_rate_say(void **state)
{
    (void)state;
    cp_crush_block block = {.law = LAW, .s_m = 0.25};
    assert_near(cp_crush_block_resistance(&block, 0.0, 0.0005), 40e3, 1e-6);
    assert_near(cp_crush_block_resistance(&block, 0.1, 0.0005), 50e3, 1e-6);

    // 0.5 mm within 0.5 ms is 1 m/s: the damper, and a tenth of the 40 kN.
    block.damping_n_s_m = 500.0;
    block.rate_s_m = 0.1;
    assert_near(cp_crush_block_resistance(&block, 0.0005, 0.0005), 40.05e3 + 500.0 + 4000.0, 1e-6);

    // The stop has no rate: only what still collapses counts.
    block.s_m = 0.5;
    assert_near(cp_crush_block_resistance(&block, 0.0005, 0.0005), 60e3 + 202e3 + 500.0 + 6000.0,
                1e-6);
}

static void its_slope_is_that_of_its_resistance(void **state)
{
    (void)state;
    static const double AT_M[] = {0.01, 0.2, 0.44, 0.6};
    for (size_t k = 0; k < sizeof AT_M / sizeof *AT_M; k++) {
        cp_crush_block block = {.law = LAW, .s_m = AT_M[k], .damping_n_s_m = 300, .rate_s_m = 0.02};
        double more = cp_crush_block_resistance(&block, 0.0011, 0.0005);
        double less = cp_crush_block_resistance(&block, 0.0010, 0.0005);
        assert_near(cp_crush_block_slope(&block, 0.001, 0.0005), (more - less) / 0.0001,
                    1e-6 * more / 0.0001);
    }
}

static void settling_counts_every_joule_once(void **state)
{
    (void)state;
    cp_crush_block block = {.law = LAW, .damping_n_s_m = 200.0};
    double damped_j = 0.0;
    for (int k = 0; k < 600; k++) {
        block.slip_m = 0.001;
        damped_j += 200.0 * 0.001 / 0.0005 * 0.001;
        cp_crush_block_settle(&block, 0.0005);
        assert_near(block.slip_m, 0.0, 0.0);
    }
    assert_near(block.s_m, 0.6, 1e-12);
    assert_near(block.plastic_j, cp_crush_loading_work(&LAW, 0.6), 1e-6);
    assert_near(block.damping_j, damped_j, 1e-9);
}

// A car whose front is its upper load path alone, two halves of 150 kN, beside boxes of 5 kN each.
static cp_vehicle_model car_of_upper_load_path(double strips_1)
{
    cp_vehicle_model car = cp_vehicle_model_default();
    car.upper_strips_1 = strips_1;
    car.upper_gap_m = 0.0;
    car.corner_gap_m = 0.4;
    car.cross_member_depth_m = 0.12;
    car.upper_collapse_begin_m = 0.005;
    car.upper_collapse_begin_kn = 150.0;
    car.upper_collapse_end_kn = 150.0;
    car.upper_collapse_end_m = 0.9;
    car.longitudinal_collapse_begin_kn = 10.0;
    car.longitudinal_collapse_end_kn = 10.0;
    car.crash_box_collapse_begin_kn = 5.0;
    car.crash_box_collapse_end_kn = 5.0;
    car.member_damping_kn_s_m = 0.0;
    cp_error error = {0};
    if (cp_vehicle_model_validate(&car, &error) != CP_OK)
        fail_msg("%s", error.text);
    return car;
}

static double deepest_m(const cp_vehicle_model *car, double speed_m_s)
{
    cp_crash_configuration crash =
        crash_builder_configuration(car, NULL, 3.6 * speed_m_s, 0.0, 0, 0);
    cp_crash_options options = cp_crash_options_default();
    cp_crash_result result = crash_builder_simulate(car, NULL, &crash, &options);
    double deepest_m = 0.0;
    for (size_t k = 0; k < result.pulse[0].sample_count; k++)
        deepest_m = fmax(deepest_m, result.pulse[0].channel[CP_CHANNEL_X][k]);
    cp_crash_result_destroy(&result);
    return deepest_m;
}

// m v^2 / 2 = F s; the weak boxes add 10 kN, the cross member's own momentum goes into the wall
// directly. In however many strips.
static void a_car_is_stopped_by_its_blocks_alone(void **state)
{
    (void)state;
    double v = 5.0;
    for (int strips = 1; strips <= 4; strips++) {
        cp_vehicle_model car = car_of_upper_load_path(strips);
        double expected_m = 0.5 * car.mass_kg * v * v / 310e3, found_m = deepest_m(&car, v);
        assert_true(expected_m < 0.15);
        assert_true(found_m > 0.9 * expected_m && found_m < 1.02 * expected_m);
    }
}

// A wall as wide as the inner one of two strips of each half meets half of the force.
static void half_of_the_width_is_half_of_the_force(void **state)
{
    (void)state;
    double v = 4.0;
    for (int strips = 1; strips <= 4; strips += 3) {
        cp_vehicle_model car = car_of_upper_load_path(strips);
        car.barrier.width_m = 0.5 * car.width_m - car.corner_width_m - 0.02;
        car.barrier.corner_radius_m = 0.01;
        double force_n = strips == 1 ? 310e3 : 160e3;
        double expected_m = 0.5 * car.mass_kg * v * v / force_n, found_m = deepest_m(&car, v);
        assert_true(found_m > 0.88 * expected_m && found_m < 1.02 * expected_m);
    }
}

// Blocks used up after 0.1 m at next to no force rest on the passenger cell, which gives way by its
// own stiffness behind each half and keeps the dent: m v^2 / 2 = F s + k (s - 0.1)^2, k of one
// half.
static void behind_used_up_blocks_the_cell_gives_way(void **state)
{
    (void)state;
    double v = 4.0;
    for (double k_kn_m = 350.0; k_kn_m <= 1400.0; k_kn_m *= 2.0) {
        cp_vehicle_model car = car_of_upper_load_path(2);
        car.upper_collapse_begin_kn = 10.0;
        car.upper_collapse_end_kn = 10.0;
        car.upper_collapse_end_m = 0.1;
        car.body_stiffness_kn_m = k_kn_m;
        double energy_j = 0.5 * car.mass_kg * v * v - 30e3 * 0.1;
        double beyond_m = (-30e3 + sqrt(30e3 * 30e3 + 4e3 * k_kn_m * energy_j)) / (2e3 * k_kn_m);
        double expected_m = 0.1 + beyond_m, found_m = deepest_m(&car, v);
        assert_true(beyond_m > 0.05);
        assert_true(found_m > 0.92 * expected_m && found_m < 1.05 * expected_m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_resists_as_its_law_and_its_rate_say),
        cmocka_unit_test(its_slope_is_that_of_its_resistance),
        cmocka_unit_test(settling_counts_every_joule_once),
        cmocka_unit_test(a_car_is_stopped_by_its_blocks_alone),
        cmocka_unit_test(half_of_the_width_is_half_of_the_force),
        cmocka_unit_test(behind_used_up_blocks_the_cell_gives_way),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
