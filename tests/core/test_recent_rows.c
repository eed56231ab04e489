/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/recent_rows.h"

#include "core/rng.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void set(cp_recent_rows *rows, uint32_t number, uint32_t row)
{
    cp_error error = {0};
    assert_int_equal(cp_recent_rows_set(rows, number, row, &error), CP_OK);
}

static void it_finds_what_was_set_and_nothing_else(void **state)
{
    (void)state;
    cp_recent_rows rows = {0};
    assert_int_equal(cp_recent_rows_get(&rows, 0), CP_NO_ROW);
    cp_recent_rows_clear(&rows, 7);
    set(&rows, 1000, 3);
    set(&rows, 5, 4); // before the first
    set(&rows, 0, 6);
    set(&rows, 100000, 5);
    assert_int_equal(cp_recent_rows_get(&rows, 1000), 3);
    assert_int_equal(cp_recent_rows_get(&rows, 5), 4);
    assert_int_equal(cp_recent_rows_get(&rows, 0), 6);
    assert_int_equal(cp_recent_rows_get(&rows, 100000), 5);
    assert_int_equal(cp_recent_rows_get(&rows, 6), CP_NO_ROW);
    assert_int_equal(cp_recent_rows_get(&rows, UINT32_MAX), CP_NO_ROW);
    cp_recent_rows_clear(&rows, 1000);
    assert_int_equal(cp_recent_rows_get(&rows, 1000), CP_NO_ROW);
    cp_recent_rows_destroy(&rows);
}

// A million vehicles, a hundred at a time, each as long as it likes; and one comes back.
static void room_is_for_those_between_the_oldest_and_the_newest(void **state)
{
    (void)state;
    enum { ALL = 1000000, LONGEST = 200 };
    cp_recent_rows rows = {0};
    cp_rng_key key = cp_rng_key_seed(3);
    static unsigned char stays[ALL];
    for (uint32_t number = 0; number < ALL; number++) {
        stays[number] = (unsigned char)(1 + cp_rng_uniform(key, number) * (LONGEST - 1));
        set(&rows, number, number % 1000);
        for (uint32_t k = number > LONGEST ? number - LONGEST : 0; k <= number; k++)
            if (number - k == stays[k])
                cp_recent_rows_clear(&rows, k);
        uint32_t asked = number - (number < 150 ? 0 : 150);
        assert_int_equal(cp_recent_rows_get(&rows, asked),
                         number - asked < stays[asked] ? asked % 1000 : CP_NO_ROW);
    }
    assert_true(rows.room <= 4 * LONGEST);
    set(&rows, ALL - 10 * LONGEST, 9);
    assert_int_equal(cp_recent_rows_get(&rows, ALL - 10 * LONGEST), 9);
    assert_int_equal(cp_recent_rows_get(&rows, ALL - 1), (ALL - 1) % 1000);
    cp_recent_rows_destroy(&rows);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_finds_what_was_set_and_nothing_else),
        cmocka_unit_test(room_is_for_those_between_the_oldest_and_the_newest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
