/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "crash/block_yield.h"

#include <stdlib.h>

static const double STIFFNESS_N_M = 8e6, STEP_S = 0.0005;

// A block that collapses at a constant force.
static cp_crush_block block_of(double force_n)
{
    return (cp_crush_block){.law = {.points = 2,
                                    .s_m = {0.001, 0.5},
                                    .force_n = {force_n, force_n},
                                    .stop_n_m = 4e6,
                                    .plateau_n = 1e6,
                                    .unload_n_m = 1e9,
                                    .unload_end_n_m = 1e9},
                            .s_m = 0.1,
                            .share_1 = 1.0};
}

// Two cars of outlines alone, whose blocks are set by each test.
typedef struct scene {
    cp_car car[2];
    cp_encounter encounter;
} scene;

static int set_up(void **state)
{
    scene *two = calloc(1, sizeof *two);
    if (two == NULL)
        return -1;
    for (int party = 0; party < 2; party++) {
        cp_car *car = &two->car[party];
        car->outline_count = CP_OUTLINE_BLOCKS + 2;
        car->block_count = 2;
        for (int k = 0; k < car->outline_count; k++)
            car->outline[k].block = k < CP_OUTLINE_BLOCKS ? -1 : k - CP_OUTLINE_BLOCKS;
        two->encounter.car[party] = car;
    }
    *state = two;
    return 0;
}

static int tear_down(void **state)
{
    free(*state);
    return 0;
}

// The face of block i of a pressed depth_m into that of block j of b; -1: what is no block.
static cp_encounter_pair *press(scene *two, int i, int j, double depth_m)
{
    cp_touch touch = {{i < 0 ? 0 : CP_OUTLINE_BLOCKS + i, j < 0 ? 0 : CP_OUTLINE_BLOCKS + j}};
    cp_encounter_pair *pair = &two->encounter.pair[touch.outline[0]][touch.outline[1]];
    *pair = (cp_encounter_pair){
        .stiffness_n_m = STIFFNESS_N_M,
        .manifold = {.count = 1, .normal = {1.0, 0.0}, .point = {{.depth_m = depth_m}}},
        .cosine = {i < 0 ? 0.0 : 1.0, j < 0 ? 0.0 : 1.0}};
    two->encounter.touching[two->encounter.touching_count++] = touch;
    return pair;
}

static double pressure_n(const cp_encounter_pair *pair)
{
    return STIFFNESS_N_M * fmax(0.0, pair->manifold.point[0].depth_m - pair->give_m);
}

static void of_two_in_series_the_weaker_gives(void **state)
{
    scene *two = *state;
    two->car[0].block[0] = block_of(20e3);
    two->car[1].block[0] = block_of(60e3);
    cp_encounter_pair *pair = press(two, 0, 0, 0.01);
    cp_yield_blocks(&two->encounter, STEP_S);

    // 20 kN are 2.5 mm of the contact: the rest of the 10 mm is given, all by the weaker.
    assert_near(pressure_n(pair), 20e3, 50.0);
    assert_near(two->car[0].block[0].s_m, 0.1075, 1e-5);
    assert_near(two->car[1].block[0].s_m, 0.1, 0.0);
}

static void equal_ones_share_evenly(void **state)
{
    scene *two = *state;
    for (int party = 0; party < 2; party++) {
        two->car[party].block[0] = block_of(40e3);
        two->car[party].block[0].rate_gain_1 = 0.25;
    }
    cp_encounter_pair *pair = press(two, 0, 0, 0.02);
    cp_yield_blocks(&two->encounter, STEP_S);
    const cp_crush_block *a = &two->car[0].block[0], *b = &two->car[1].block[0];
    assert_near(a->s_m, b->s_m, 1e-15);
    double rate_m_s = (a->s_m - 0.1) / STEP_S;
    assert_near(pressure_n(pair), 40e3 * cp_strain_rate_factor(0.25, rate_m_s), 50.0);
}

static void one_that_faces_two_resists_both(void **state)
{
    scene *two = *state;
    two->car[0].block[0] = block_of(50e3);
    cp_encounter_pair *first = press(two, 0, -1, 0.004);
    two->encounter.touching[1].outline[1] = 1;
    cp_encounter_pair *second = &two->encounter.pair[CP_OUTLINE_BLOCKS][1];
    *second = *first;
    second->manifold.point[0].depth_m = 0.009;
    two->encounter.touching[two->encounter.touching_count++] = (cp_touch){{CP_OUTLINE_BLOCKS, 1}};
    cp_yield_blocks(&two->encounter, STEP_S);

    // The deeper one alone ends up pressing: 6.25 mm are 50 kN, which leaves the other behind.
    assert_near(pressure_n(first) + pressure_n(second), 50e3, 50.0);
    assert_near(two->car[0].block[0].s_m, 0.1 + 0.003375, 1e-5);
}

static void what_presses_less_than_it_resists_moves_nothing(void **state)
{
    scene *two = *state;
    two->car[0].block[0] = block_of(50e3);
    cp_encounter_pair *pair = press(two, 0, -1, 0.006);
    cp_yield_blocks(&two->encounter, STEP_S);
    assert_near(two->car[0].block[0].s_m, 0.1, 0.0);
    assert_near(pair->give_m, 0.0, 0.0);
}

// Roles swapped and pairs in another order: the same.
static void the_order_of_pairs_does_not_matter(void **state)
{
    scene *two = *state;
    double crush_m[2][4];
    for (int swapped = 0; swapped < 2; swapped++) {
        two->encounter.touching_count = 0;
        for (int party = 0; party < 2; party++)
            for (int k = 0; k < 2; k++) {
                two->car[party].block[k] = block_of(2e4 + 1e4 * (2 * (party ^ swapped) + k));
                two->car[party].block[k].rate_gain_1 = 0.2;
            }
        const int order[3][2] = {{0, 0}, {0, 1}, {1, 1}};
        for (int n = 0; n < 3; n++) {
            const int *at = order[swapped ? 2 - n : n];
            press(two, at[swapped], at[1 - swapped], 0.005 + 0.004 * (at[0] + at[1]));
        }
        cp_yield_blocks(&two->encounter, STEP_S);
        for (int k = 0; k < 4; k++)
            crush_m[swapped][k] = two->car[(k / 2) ^ swapped].block[k % 2].s_m;
    }
    for (int k = 0; k < 4; k++)
        assert_near(crush_m[0][k], crush_m[1][k], 2e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(of_two_in_series_the_weaker_gives, set_up, tear_down),
        cmocka_unit_test_setup_teardown(equal_ones_share_evenly, set_up, tear_down),
        cmocka_unit_test_setup_teardown(one_that_faces_two_resists_both, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_presses_less_than_it_resists_moves_nothing, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(the_order_of_pairs_does_not_matter, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
