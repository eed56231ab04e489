/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/cross_check.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define GRAZE cp_found_as_verdict(CP_CONTACT_GRAZE)
#define LONG_TURNING cp_found_as_verdict(CP_CONTACT_LONG_TURNING)

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
        assert_int_equal(cp_cross_check_add_contact(&check, k, k + 1, GRAZE, 0.1 * k, &error),
                         CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 3, 7, CP_FOUND_CRASH, 1.05, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 4, 5, GRAZE, 1.15, &error), CP_OK);
    cp_cross_check_match(&check);
    assert_int_equal(check.sumo_count, 3);
    assert_int_equal(check.sumo[0].found_as, CP_FOUND_CRASH);
    assert_string_equal(check.sumo[0].type, "junction");
    assert_int_equal(check.sumo[0].collider, 7);
    assert_true(check.sumo[0].time_s == 1.0);
    assert_true(check.sumo[0].gap_m == -0.1);
    assert_int_equal(check.sumo[1].found_as, CP_FOUND_NO_CONTACT);
    assert_int_equal(check.sumo[2].found_as, GRAZE);
    cp_cross_check_destroy(&check);
}

static void of_several_contacts_the_crash_or_the_nearest_counts(void **state)
{
    (void)state;
    cp_cross_check check = {0};
    cp_error error = {0};
    assert_int_equal(cp_cross_check_add_report(&check, 1, 2, "junction", 5.0, 0.2, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_report(&check, 3, 4, "junction", 5.0, 0.2, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 2, 1, GRAZE, 5.0, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 1, 2, CP_FOUND_CRASH, 9.0, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 3, 4, GRAZE, 1.0, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 4, 3, LONG_TURNING, 5.1, &error), CP_OK);
    assert_int_equal(cp_cross_check_add_contact(&check, 3, 4, GRAZE, 8.0, &error), CP_OK);
    cp_cross_check_match(&check);
    assert_int_equal(check.sumo[0].found_as, CP_FOUND_CRASH);
    assert_int_equal(check.sumo[1].found_as, LONG_TURNING);
    cp_cross_check_destroy(&check);
}

static void nothing_is_fine(void **state)
{
    (void)state;
    cp_cross_check check = {0};
    cp_error error = {0};
    cp_cross_check_match(&check);
    assert_int_equal(check.sumo_count, 0);
    assert_int_equal(check.our_count, 0);
    // One side alone: contacts that SUMO does not know of are no reports, and the other way round.
    assert_int_equal(cp_cross_check_add_contact(&check, 1, 2, GRAZE, 1.0, &error), CP_OK);
    cp_cross_check_match(&check);
    assert_int_equal(check.sumo_count, 0);
    cp_cross_check_destroy(&check);
    assert_null(check.ours);
    assert_int_equal(check.our_count, 0);
    assert_int_equal(cp_cross_check_add_report(&check, 1, 2, "junction", 1.0, 0.2, &error), CP_OK);
    cp_cross_check_match(&check);
    assert_int_equal(check.sumo_count, 1);
    assert_int_equal(check.sumo[0].found_as, CP_FOUND_NO_CONTACT);
    cp_cross_check_destroy(&check);
    assert_null(check.sumo);
}

// Each text is that of the database, and no two are the same.
static void every_kind_has_a_text_of_its_own(void **state)
{
    (void)state;
    assert_string_equal(cp_found_as_text(CP_FOUND_CRASH), "crash");
    assert_string_equal(cp_found_as_text(CP_FOUND_AFTER_CRASH), "after_crash");
    assert_string_equal(cp_found_as_text(CP_FOUND_WARMUP), "warmup");
    assert_string_equal(cp_found_as_text(CP_FOUND_NO_CONTACT), "no_contact");
    assert_string_equal(cp_found_as_text(GRAZE), "graze");
    assert_string_equal(cp_found_as_text(LONG_TURNING), "long_vehicle_turning");
    for (int k = 0; k < CP_FOUND_AS_COUNT; k++)
        for (int other = 0; other < k; other++)
            assert_string_not_equal(cp_found_as_text((cp_found_as)k),
                                    cp_found_as_text((cp_found_as)other));
    for (int k = 0; k < CP_FOUND_AS_COUNT; k++)
        assert_int_equal(cp_found_as_is_crash((cp_found_as)k),
                         k == CP_FOUND_CRASH || k == CP_FOUND_WARMUP);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_match_in_either_order),
        cmocka_unit_test(of_several_contacts_the_crash_or_the_nearest_counts),
        cmocka_unit_test(nothing_is_fine),
        cmocka_unit_test(every_kind_has_a_text_of_its_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
