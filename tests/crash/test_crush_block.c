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

static const cp_crush_law LAW = {.points = 2,
                                 .s_m = {0.05, 0.45},
                                 .force_n = {20e3, 60e3},
                                 .stop_n_m = 4e6,
                                 .plateau_n = 2e6,
                                 .unload_n_m = 4e6,
                                 .unload_end_n_m = 4e6};

static void it_resists_as_its_law_and_its_rate_say(void **state)
{
    (void)state;
    cp_crush_block block = {.law = LAW, .s_m = 0.25, .share_1 = 1.0};
    assert_near(cp_crush_block_resistance(&block, 0.0, 0.0005).force_n, 40e3, 1e-6);
    assert_near(cp_crush_block_resistance(&block, 0.1, 0.0005).force_n, 50e3, 1e-6);

    // 5 mm within 0.5 ms is 10 m/s: a tenth of the 40 kN more.
    block.rate_gain_1 = 0.1;
    assert_near(cp_crush_block_resistance(&block, 0.005, 0.0005).force_n, 40.5e3 + 4000.0, 1e-6);

    // The stop has no rate: only what still collapses counts.
    block.s_m = 0.5;
    assert_near(cp_crush_block_resistance(&block, 0.005, 0.0005).force_n, 60e3 + 220e3 + 6000.0,
                1e-6);

    // Pressed on over half of its face it resists by half.
    block.share_1 = 0.5;
    assert_near(cp_crush_block_resistance(&block, 0.005, 0.0005).force_n, 0.5 * (280e3 + 6000.0),
                1e-6);
}

static void its_slope_is_that_of_its_resistance(void **state)
{
    (void)state;
    static const double AT_M[] = {0.01, 0.2, 0.44, 0.6};
    for (size_t k = 0; k < sizeof AT_M / sizeof *AT_M; k++) {
        cp_crush_block block = {.law = LAW, .s_m = AT_M[k], .rate_gain_1 = 0.3, .share_1 = 0.7};
        double more = cp_crush_block_resistance(&block, 0.0020001, 0.0005).force_n;
        double less = cp_crush_block_resistance(&block, 0.0019999, 0.0005).force_n;
        assert_near(cp_crush_block_resistance(&block, 0.002, 0.0005).slope_n_m,
                    (more - less) / 2e-7, 1e-4 * more / 0.002);
    }
}

static void settling_counts_every_joule_once(void **state)
{
    (void)state;
    cp_crush_block block = {.law = LAW, .rate_gain_1 = 0.2, .share_1 = 0.25};
    double rate_j = 0.0;
    for (int k = 0; k < 600; k++) {
        block.slip_m = 0.001;
        double force_n = cp_crush_block_resistance(&block, 0.001, 0.0005).force_n;
        double collapse_n = 0.25 * cp_crush_loading_force(&block.law, block.s_m + 0.001);
        rate_j += (force_n - collapse_n) * 0.001;
        cp_crush_block_settle(&block, 0.0005);
        assert_near(block.slip_m, 0.0, 0.0);
    }
    assert_near(block.s_m, 0.6, 1e-12);
    assert_near(block.plastic_j, 0.25 * cp_crush_loading_work(&LAW, 0.6), 1e-6);
    assert_near(block.rate_j, rate_j, 1e-6);
    assert_true(rate_j > 0.0);
}

// Pushed aside and back it resists both ways, and both are lost.
static void sideways_it_yields_both_ways(void **state)
{
    (void)state;
    cp_crush_block block = {.law = LAW, .side_law = LAW, .share_1 = 1.0};
    const double slip_m[] = {0.25, -0.1, 0.05};
    for (size_t k = 0; k < 3; k++) {
        block.side_slip_m = slip_m[k];
        cp_crush_block_settle(&block, 0.0005);
    }
    assert_near(block.side_m, 0.2, 1e-12);
    assert_near(block.side_way_m, 0.4, 1e-12);
    assert_near(block.plastic_j, cp_crush_loading_work(&LAW, 0.4), 1e-9);
    assert_near(cp_crush_block_side_resistance(&block, -0.02).force_n,
                cp_crush_loading_force(&LAW, 0.42), 1e-9);
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
    car.longitudinal_collapse_middle_kn = 10.0;
    car.strain_rate_gain_1 = 0.0;
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

// A wall half as wide meets half of the force, in strips or not. Of one piece, 0.51 m of a half
// between its roundings and 0.23 m of them covered, and a dent that spreads over 0.12 m: 0.56 of
// its force.
static void half_of_the_width_is_half_of_the_force(void **state)
{
    (void)state;
    double v = 4.0;
    for (int strips = 1; strips <= 4; strips += 3) {
        cp_vehicle_model car = car_of_upper_load_path(strips);
        car.barrier.width_m = 0.5 * car.width_m - car.corner_width_m - 0.02;
        car.barrier.corner_radius_m = 0.01;
        double force_n = strips == 1 ? 10e3 + 0.564 * 300e3 : 160e3;
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
        cmocka_unit_test(sideways_it_yields_both_ways),
        cmocka_unit_test(a_car_is_stopped_by_its_blocks_alone),
        cmocka_unit_test(half_of_the_width_is_half_of_the_force),
        cmocka_unit_test(behind_used_up_blocks_the_cell_gives_way),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
