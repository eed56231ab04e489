/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/pair_set.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void a_pair_is_found_in_either_order_and_no_other(void **state)
{
    (void)state;
    cp_pair_set set = {0};
    assert_false(cp_pair_set_contains(&set, 0, 1));
    assert_int_equal(cp_pair_set_add(&set, 7, 0, NULL), CP_OK);
    assert_true(cp_pair_set_contains(&set, 0, 7));
    assert_true(cp_pair_set_contains(&set, 7, 0));
    assert_false(cp_pair_set_contains(&set, 0, 6));
    assert_false(cp_pair_set_contains(&set, 7, 1));
    cp_pair_set_destroy(&set);
    assert_false(cp_pair_set_contains(&set, 0, 7));
}

static void thousands_of_pairs_stay_apart(void **state)
{
    (void)state;
    cp_pair_set set = {0};
    for (uint32_t low = 0; low < 100; low++)
        for (uint32_t high = low + 1; high < 100; high++)
            if ((low + high) % 3 == 0)
                assert_int_equal(cp_pair_set_add(&set, high, low, NULL), CP_OK);
    size_t count = set.pair_count;
    assert_int_equal(cp_pair_set_add(&set, 1, 2, NULL), CP_OK); // already in
    assert_int_equal(set.pair_count, count);
    for (uint32_t low = 0; low < 100; low++)
        for (uint32_t high = low + 1; high < 100; high++)
            assert_int_equal(cp_pair_set_contains(&set, low, high), (low + high) % 3 == 0);
    cp_pair_set_destroy(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pair_is_found_in_either_order_and_no_other),
        cmocka_unit_test(thousands_of_pairs_stay_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
