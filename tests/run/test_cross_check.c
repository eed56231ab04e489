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
    assert_int_equal(cp_cross_check_add_report(&check, 7, 3, "junction", 1.0, 0.2, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_report(&check, 3, 7, "frontal", 1.1, -0.1, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_report(&check, 1, 2, "collision", 1.1, 0.2, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_report(&check, 5, 4, "collision", 1.2, 0.2, &error), CP_OK);
    for (uint32_t k = 100; k > 10; k--)
        assert_int_equal(cp_cross_check_add_contact(&check, k, k + 1, "graze", 0.1 * k, &error),
                         CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 3, 7, "crash", 1.05, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 4, 5, "graze", 1.15, &error), CP_OK);
    cp_cross_check_match(&check);
    assert_int_equal(check.sumo_count, 3);
    assert_string_equal(check.sumo[0].found_as, "crash");
    assert_string_equal(check.sumo[0].type, "junction");
    assert_int_equal(check.sumo[0].collider, 7);
    assert_true(check.sumo[0].time_s == 1.0);
    assert_true(check.sumo[0].gap_m == -0.1);
    assert_string_equal(check.sumo[1].found_as, "no_contact");
    assert_string_equal(check.sumo[2].found_as, "graze");
    cp_cross_check_destroy(&check);
}

static void of_several_contacts_the_crash_or_the_nearest_counts(void **state)
{
    (void)state;
    cp_cross_check check = {0};
    cp_error error = {0};
    assert_int_equal(cp_cross_check_add_report(&check, 1, 2, "junction", 5.0, 0.2, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_report(&check, 3, 4, "junction", 5.0, 0.2, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 2, 1, "graze", 5.0, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 1, 2, "crash", 9.0, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 3, 4, "graze", 1.0, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 4, 3, "long_vehicle_turning", 5.1, &error),
                     CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 3, 4, "graze", 8.0, &error), CP_OK);
    cp_cross_check_match(&check);
    assert_string_equal(check.sumo[0].found_as, "crash");
    assert_string_equal(check.sumo[1].found_as, "long_vehicle_turning");
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
        cmocka_unit_test(of_several_contacts_the_crash_or_the_nearest_counts),
        cmocka_unit_test(nothing_is_fine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
