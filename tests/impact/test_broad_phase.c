/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/broad_phase.h"

#include "core/rng.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define COUNT 1500

static int by_indices(const void *one, const void *other)
{
    const cp_box_pair *a = one, *b = other;
    if (a->first != b->first)
        return a->first < b->first ? -1 : 1;
    return (a->second > b->second) - (a->second < b->second);
}

/* Every overlap that comparing all with all finds, and each once. */
static void assert_same_as_brute_force(cp_broad_phase *phase, const cp_box *box, size_t count)
{
    const cp_box_pair *pair;
    size_t pair_count, expected = 0;
    assert_int_equal(cp_broad_phase_pairs(phase, box, count, &pair, &pair_count, NULL), CP_OK);
    cp_box_pair *sorted = malloc((pair_count + 1) * sizeof *sorted);
    assert_non_null(sorted);
    for (size_t k = 0; k < pair_count; k++)
        sorted[k] = pair[k];
    qsort(sorted, pair_count, sizeof *sorted, by_indices);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j = i + 1; j < count; j++) {
            if (!(box[i].min_x_m <= box[j].max_x_m && box[j].min_x_m <= box[i].max_x_m &&
                  box[i].min_y_m <= box[j].max_y_m && box[j].min_y_m <= box[i].max_y_m))
                continue;
            assert_true(expected < pair_count);
            assert_int_equal(sorted[expected].first, i);
            assert_int_equal(sorted[expected].second, j);
            expected++;
        }
    assert_int_equal(pair_count, expected);
    free(sorted);
}

static void random_boxes_pair_up_as_brute_force_says(void **state)
{
    (void)state;
    cp_broad_phase phase = {0};
    cp_rng_key key = cp_rng_key_seed(11);
    static const double FIELD_M[] = {40.0, 400.0, 4000.0}; // crowded to sparse
    for (int field = 0; field < 3; field++) {
        cp_box box[COUNT];
        size_t count = field == 0 ? 200 : COUNT;
        for (size_t k = 0; k < count; k++) {
            uint64_t draw = ((uint64_t)field * COUNT + k) * 4;
            double x_m = (cp_rng_uniform(key, draw) - 0.5) * FIELD_M[field];
            double y_m = (cp_rng_uniform(key, draw + 1) - 0.5) * FIELD_M[field];
            box[k] = (cp_box){x_m, y_m, x_m + 1.0 + 24.0 * cp_rng_uniform(key, draw + 2),
                              y_m + 1.0 + 9.0 * cp_rng_uniform(key, draw + 3)};
        }
        assert_same_as_brute_force(&phase, box, count);
    }
    cp_broad_phase_destroy(&phase);
}

static void touching_boxes_on_cell_borders_count_once(void **state)
{
    (void)state;
    cp_broad_phase phase = {0};
    cp_box box[] = {{0, 0, 10, 10}, {10, 10, 20, 20}, {-10, 0, 0, 10}, {30, 0, 31, 1}};
    assert_same_as_brute_force(&phase, box, 4);
    cp_broad_phase_destroy(&phase);
}

static void boxes_that_are_nowhere_overlap_nothing(void **state)
{
    (void)state;
    cp_broad_phase phase = {0};
    cp_box box[] = {{0, 0, 1, 1},
                    {NAN, 0, 1, 1},
                    {-INFINITY, -1, INFINITY, 1},
                    {INFINITY, INFINITY, -INFINITY, -INFINITY},
                    {-1073741824.0, -1073741824.0, -1073741823.0, -1073741823.0}};
    const cp_box_pair *pair;
    size_t count = 99;
    assert_int_equal(cp_broad_phase_pairs(&phase, box, 5, &pair, &count, NULL), CP_OK);
    assert_int_equal(count, 0);
    assert_int_equal(cp_broad_phase_pairs(&phase, box, 0, &pair, &count, NULL), CP_OK);
    assert_int_equal(count, 0);
    cp_broad_phase_destroy(&phase);
}

static void once_warm_nothing_is_allocated(void **state)
{
    (void)state;
    cp_broad_phase phase = {0};
    cp_box box[200];
    for (int k = 0; k < 200; k++)
        box[k] = (cp_box){3.0 * k, 0.0, 3.0 * k + 5.0, 2.0};
    const cp_box_pair *pair;
    size_t count;
    assert_int_equal(cp_broad_phase_pairs(&phase, box, 200, &pair, &count, NULL), CP_OK);
    cp_broad_phase warm = phase;
    for (int step = 0; step < 50; step++)
        assert_int_equal(cp_broad_phase_pairs(&phase, box, 200, &pair, &count, NULL), CP_OK);
    assert_memory_equal(&warm, &phase, sizeof warm);
    cp_broad_phase_destroy(&phase);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_boxes_pair_up_as_brute_force_says),
        cmocka_unit_test(touching_boxes_on_cell_borders_count_once),
        cmocka_unit_test(boxes_that_are_nowhere_overlap_nothing),
        cmocka_unit_test(once_warm_nothing_is_allocated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
