/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/cross_check.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void pairs_match_in_either_order(void **state)
{
    (void)state;
    cp_cross_check check = {0};
    cp_error error = {0};
    // SUMO is early for one pair, repeats it with swapped roles, and sees one that we do not.
    assert_int_equal(cp_cross_check_add_report(&check, 7, 3, "junction", 1.0, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_report(&check, 3, 7, "frontal", 1.1, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_report(&check, 1, 2, "collision", 1.1, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_report(&check, 5, 4, "collision", 1.2, &error), CP_OK);
    for (uint32_t k = 100; k > 10; k--)
        assert_int_equal(cp_cross_check_add_contact(&check, k, k + 1, "graze", &error), CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 3, 7, "crash", &error), CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 4, 5, "graze", &error), CP_OK);
    cp_cross_check_match(&check);
    assert_int_equal(check.sumo_count, 3);
    assert_string_equal(check.sumo[0].found_as, "crash");
    assert_string_equal(check.sumo[0].type, "junction");
    assert_int_equal(check.sumo[0].collider, 7);
    assert_true(check.sumo[0].time_s == 1.0);
    assert_string_equal(check.sumo[1].found_as, "no_contact");
    assert_string_equal(check.sumo[2].found_as, "graze");
    cp_cross_check_destroy(&check);
}

static void nothing_is_fine(void **state)
{
    (void)state;
    cp_cross_check check = {0};
    cp_cross_check_match(&check);
    cp_cross_check_destroy(&check);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_match_in_either_order),
        cmocka_unit_test(nothing_is_fine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
