/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "crash/crush_element.h"

#include <math.h>

// A law with round numbers: 100 kN at 10 mm, 200 kN at 210 mm, stop 5 MN/m, unloading 30 MN/m.
static const cp_crush_law LAW = {.points = 2,
                                 .s_m = {0.01, 0.21},
                                 .force_n = {1e5, 2e5},
                                 .stop_n_m = 5e6,
                                 .plateau_n = INFINITY,
                                 .unload_n_m = 3e7,
                                 .unload_end_n_m = 3e7};
// Four points with a valley, a stop that yields at 300 kN, unloading steeper the deeper: 20 MN/m at
// 10 mm, 60 MN/m from 210 mm on.
static const cp_crush_law DEEP = {.points = 4,
                                  .s_m = {0.01, 0.05, 0.11, 0.21},
                                  .force_n = {1e5, 0.4e5, 1.2e5, 2e5},
                                  .stop_n_m = 1e7,
                                  .plateau_n = 3e5,
                                  .unload_n_m = 2e7,
                                  .unload_end_n_m = 6e7};

static void force_follows_the_three_lines(void **state)
{
    (void)state;
    assert_near(cp_crush_loading_force(&LAW, -0.01), 0.0, 0.0);
    assert_near(cp_crush_loading_force(&LAW, 0.005), 5e4, 1e-6);
    assert_near(cp_crush_loading_force(&LAW, 0.11), 1.5e5, 1e-6);
    assert_near(cp_crush_loading_force(&LAW, 0.22), 2e5 + 5e4, 1e-6);
}

static void work_is_the_area_under_the_force(void **state)
{
    (void)state;
    double work_j = 0.0;
    const int pieces = 250000;
    for (int k = 0; k < pieces; k++)
        work_j += cp_crush_loading_force(&LAW, 0.25 * (k + 0.5) / pieces) * 0.25 / pieces;
    assert_near(cp_crush_loading_work(&LAW, 0.25), work_j, 1e-6 * work_j);
}

static void unloading_is_steep_and_never_pulls(void **state)
{
    (void)state;
    cp_crush_state crush = {0};
    assert_near(cp_crush_force(&LAW, &crush, 0.11), 1.5e5, 1e-6);
    assert_near(cp_crush_force(&LAW, &crush, 0.108), 1.5e5 - 3e7 * 0.002, 1e-6);
    assert_near(cp_crush_force(&LAW, &crush, 0.10), 0.0, 0.0);
    assert_near(cp_crush_force(&LAW, &crush, -1.0), 0.0, 0.0);
    // Reloading runs up the same line and goes on along the loading curve.
    assert_near(cp_crush_force(&LAW, &crush, 0.108), 1.5e5 - 3e7 * 0.002, 1e-6);
    assert_near(cp_crush_force(&LAW, &crush, 0.12), 1.55e5, 1e-6);
}

static void a_cycle_dissipates_exactly_the_plastic_energy(void **state)
{
    (void)state;
    // Load to 0.15, back to zero force, again to 0.18 and back: the loop's area is what is lost.
    cp_crush_state crush = {0};
    const double way[] = {0.0, 0.15, 0.10, 0.18, 0.10};
    double work_j = 0.0, s_m = 0.0;
    for (int leg = 1; leg < 5; leg++) {
        for (int k = 0; k < 100000; k++) {
            double next_m = way[leg - 1] + (way[leg] - way[leg - 1]) * (k + 1) / 100000.0;
            double middle_n = cp_crush_force(&LAW, &crush, 0.5 * (s_m + next_m));
            work_j += middle_n * (next_m - s_m);
            s_m = next_m;
        }
    }
    assert_near(cp_crush_elastic_energy(&LAW, &crush, s_m), 0.0, 1e-9);
    assert_near(cp_crush_plastic_energy(&LAW, &crush), work_j, 1e-5 * work_j);
}

static void a_law_follows_all_its_points_then_stop_and_plateau(void **state)
{
    (void)state;
    const double at_m[] = {0.005, 0.03, 0.08, 0.16, 0.215, 0.22, 0.25, 1.0};
    const double force_n[] = {0.5e5, 0.7e5, 0.8e5, 1.6e5, 2.5e5, 3e5, 3e5, 3e5};
    for (size_t k = 0; k < sizeof at_m / sizeof *at_m; k++)
        assert_near(cp_crush_loading_force(&DEEP, at_m[k]), force_n[k], 1e-6);
    assert_near(cp_crush_loading_at(&DEEP, 0.03).slope_n_m, -0.6e5 / 0.04, 1e-6);
    assert_near(cp_crush_loading_at(&DEEP, 0.215).slope_n_m, 1e7, 1e-6);
    assert_near(cp_crush_loading_at(&DEEP, 0.5).slope_n_m, 0.0, 0.0);
    assert_near(cp_crush_collapse_force(&DEEP), 2e5, 0.0);

    // The work is the area, over all pieces.
    double work_j = 0.0;
    const int pieces = 400000;
    for (int k = 0; k < pieces; k++)
        work_j += cp_crush_loading_force(&DEEP, 0.4 * (k + 0.5) / pieces) * 0.4 / pieces;
    assert_near(cp_crush_loading_work(&DEEP, 0.4), work_j, 1e-6 * work_j);
}

static void pulled_it_holds_then_is_drawn_out_and_all_is_accounted_for(void **state)
{
    (void)state;
    cp_crush_law law = LAW;
    law.pull_n = 5e4;
    cp_crush_state crush = {0};

    // Undeformed it holds 50 kN along its unloading slope, then gives way at that.
    assert_near(cp_crush_force(&law, &crush, -0.001), -3e4, 1e-6);
    assert_near(cp_crush_force(&law, &crush, -0.01), -5e4, 1e-6);
    assert_near(crush.pulled_m, 0.01 - 5e4 / 3e7, 1e-12);

    // Crushed, pulled, pressed together again and beyond: work is elastic plus dissipated.
    crush = (cp_crush_state){0};
    const double way[] = {0.0, 0.15, 0.05, 0.12, 0.02, 0.2, 0.17};
    double work_j = 0.0, s_m = 0.0;
    for (int leg = 1; leg < 7; leg++) {
        for (int k = 0; k < 200000; k++) {
            double next_m = way[leg - 1] + (way[leg] - way[leg - 1]) * (k + 1) / 200000.0;
            work_j += cp_crush_force(&law, &crush, 0.5 * (s_m + next_m)) * (next_m - s_m);
            s_m = next_m;
        }
    }
    double found_j =
        cp_crush_elastic_energy(&law, &crush, s_m) + cp_crush_plastic_energy(&law, &crush);
    assert_near(found_j, work_j, 1e-4 * work_j);
    assert_true(crush.pulled_j > 0.0);
}

static void the_deeper_it_was_crushed_the_less_springs_back(void **state)
{
    (void)state;
    assert_near(cp_crush_unloading_slope(&DEEP, 0.005), 2e7, 0.0);
    assert_near(cp_crush_unloading_slope(&DEEP, 0.11), 4e7, 1.0);
    assert_near(cp_crush_unloading_slope(&DEEP, 0.6), 6e7, 0.0);
    cp_crush_state crush = {0};
    cp_crush_force(&DEEP, &crush, 0.3);
    assert_near(cp_crush_force(&DEEP, &crush, 0.299), 3e5 - 6e4, 1e-6);

    // What it dissipates never shrinks, whatever way it goes.
    double before_j = 0.0;
    crush = (cp_crush_state){0};
    for (double s_m = 0.0; s_m < 0.4; s_m += 0.001) {
        cp_crush_force(&DEEP, &crush, s_m);
        double now_j = cp_crush_plastic_energy(&DEEP, &crush);
        assert_true(now_j >= before_j - 1e-9);
        before_j = now_j;
    }
}

static void strain_rate_follows_the_fifth_root_up_to_its_limit(void **state)
{
    (void)state;
    assert_near(cp_strain_rate_factor(0.25, -3.0), 1.0, 0.0);
    assert_near(cp_strain_rate_factor(0.25, 0.0), 1.0, 0.0);
    assert_near(cp_strain_rate_factor(0.25, 10.0), 1.25, 1e-12);
    assert_near(cp_strain_rate_factor(0.25, 3.2), 1.0 + 0.25 * pow(0.32, 0.2), 1e-12);
    assert_near(cp_strain_rate_factor(0.25, 0.5), 1.0 + 0.125 * pow(0.1, 0.2), 1e-12);
    assert_near(cp_strain_rate_factor(0.4, 40.0), CP_STRAIN_RATE_LARGEST, 0.0);
    for (double rate_m_s = 0.1; rate_m_s < 30.0; rate_m_s *= 1.37) {
        double more = cp_strain_rate_factor(0.2, rate_m_s + 1e-6);
        double less = cp_strain_rate_factor(0.2, rate_m_s - 1e-6);
        assert_near(cp_strain_rate_at(0.2, rate_m_s).slope_s_m, (more - less) / 2e-6, 1e-6);
    }
}

static void a_hinge_yields_and_springs_back(void **state)
{
    (void)state;
    const cp_bending_law law = {1e4, 2e5};
    cp_bending_state bend = {0};
    assert_near(cp_bending_moment(&law, &bend, 0.04), 8e3, 1e-9);
    assert_near(bend.plastic_j, 0.0, 0.0);
    assert_near(cp_bending_moment(&law, &bend, 0.15), 1e4, 1e-9);
    assert_near(bend.plastic_rad, 0.10, 1e-12);
    assert_near(bend.plastic_j, 1e4 * 0.10, 1e-9);
    assert_near(cp_bending_moment(&law, &bend, 0.10), 0.0, 1e-9);
    // Bent back the other way it yields at minus the same moment.
    assert_near(cp_bending_moment(&law, &bend, -0.05), -1e4, 1e-9);
    assert_near(bend.plastic_j, 1e4 * 0.20, 1e-9);
    assert_near(cp_bending_elastic_energy(&law, &bend, -0.05), 250.0, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(force_follows_the_three_lines),
        cmocka_unit_test(work_is_the_area_under_the_force),
        cmocka_unit_test(unloading_is_steep_and_never_pulls),
        cmocka_unit_test(a_cycle_dissipates_exactly_the_plastic_energy),
        cmocka_unit_test(a_law_follows_all_its_points_then_stop_and_plateau),
        cmocka_unit_test(pulled_it_holds_then_is_drawn_out_and_all_is_accounted_for),
        cmocka_unit_test(the_deeper_it_was_crushed_the_less_springs_back),
        cmocka_unit_test(strain_rate_follows_the_fifth_root_up_to_its_limit),
        cmocka_unit_test(a_hinge_yields_and_springs_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
