/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/cross_validation.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define CASES 96
#define ANGLES 4

/* 4 speeds, 6 offsets, 4 angles, in disorder. */
static cp_fit fit_of_a_table(cp_reference_case cases[CASES], uint32_t seed)
{
    for (size_t k = 0; k < CASES; k++) {
        size_t place = k * 35 % CASES; // 35 and 96 have no divisor in common
        cases[k] = (cp_reference_case){.speed_km_h = 25.0 + 10.0 * (double)(place / (6 * ANGLES)),
                                       .offset_mm = -700.0 + 350.0 * (double)(place / ANGLES % 6),
                                       .angle_deg = 10.0 * (double)(place % ANGLES)};
    }
    return (cp_fit){.reference = {.cases = cases, .count = CASES},
                    .seed = seed,
                    .folds = 5,
                    .neighbour_folds = 5};
}

// Every fold gets its fifth.
static void assert_even(const size_t *part)
{
    size_t size[5] = {0};
    for (size_t k = 0; k < CASES; k++) {
        assert_true(part[k] < 5);
        size[part[k]]++;
    }
    for (int fold = 0; fold < 5; fold++)
        assert_true(size[fold] == 19 || size[fold] == 20);
}

// Cases of one fold that differ in nothing but one step of the angle.
static size_t neighbours_together(const cp_fit *fit, const size_t *part)
{
    const cp_reference_case *cases = fit->reference.cases;
    size_t together = 0;
    for (size_t k = 0; k < CASES; k++)
        for (size_t j = 0; j < CASES; j++)
            together += part[k] == part[j] && cases[k].speed_km_h == cases[j].speed_km_h &&
                        cases[k].offset_mm == cases[j].offset_mm &&
                        cases[k].angle_deg + 10.0 == cases[j].angle_deg;
    return together;
}

static void neighbours_come_into_different_folds(void **state)
{
    (void)state;
    cp_reference_case cases[CASES];
    size_t at_random = 0, apart = 0, part[CASES];
    for (uint32_t seed = 0; seed < 20; seed++) {
        cp_fit fit = fit_of_a_table(cases, seed);
        assert_int_equal(cp_cross_deal(&fit, CP_CROSS_FOLDS, part), 5);
        assert_even(part);
        at_random += neighbours_together(&fit, part);
        assert_int_equal(cp_cross_deal(&fit, CP_CROSS_NEIGHBOURS, part), 5);
        assert_even(part);
        apart += neighbours_together(&fit, part);
    }
    // Of 72 such pairs a fifth by chance; else only where one block of five ends.
    assert_true(at_random > 20 * 10);
    assert_true(apart < 20 * 5);
}

static void a_seed_deals_its_own_folds(void **state)
{
    (void)state;
    cp_reference_case cases[CASES];
    size_t one[CASES], again[CASES], other[CASES];
    for (int kind = 0; kind < 2; kind++) {
        cp_cross_kind folds = kind == 0 ? CP_CROSS_FOLDS : CP_CROSS_NEIGHBOURS;
        cp_fit fit = fit_of_a_table(cases, 7);
        cp_cross_deal(&fit, folds, one);
        cp_cross_deal(&fit, folds, again);
        assert_memory_equal(one, again, sizeof one);
        fit.seed = 8;
        cp_cross_deal(&fit, folds, other);
        assert_memory_not_equal(one, other, sizeof one);
    }
}

static void a_level_is_a_part(void **state)
{
    (void)state;
    cp_reference_case cases[CASES];
    cp_fit fit = fit_of_a_table(cases, 7);
    size_t part[CASES];
    assert_int_equal(cp_cross_deal(&fit, CP_CROSS_SPEED, part), 4);
    assert_int_equal(cp_cross_deal(&fit, CP_CROSS_ANGLE, part), 4);
    assert_int_equal(cp_cross_deal(&fit, CP_CROSS_OFFSET, part), 6);
    for (size_t k = 0; k < CASES; k++)
        for (size_t j = 0; j < CASES; j++)
            assert_int_equal(part[k] == part[j], cases[k].offset_mm == cases[j].offset_mm);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(neighbours_come_into_different_folds),
        cmocka_unit_test(a_seed_deals_its_own_folds),
        cmocka_unit_test(a_level_is_a_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
