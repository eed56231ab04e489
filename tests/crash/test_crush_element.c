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
static const cp_crush_law LAW = {0.01, 1e5, 0.21, 2e5, 3e7, 5e6};

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
        cmocka_unit_test(a_hinge_yields_and_springs_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
