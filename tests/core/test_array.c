/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/array.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

typedef struct pair {
    int32_t number;
    char letter;
} pair;

// Elements stay what they were while the array grows, and new ones are zero.
static void test_elements_are_added(void **state)
{
    pair *pairs = NULL;
    size_t count = 0;
    (void)state;
    for (int32_t k = 0; k < 1000; k++) {
        pair *added = cp_array_add(pairs, count);
        assert_non_null(added);
        assert_ptr_equal(added, &pairs[k]);
        assert_int_equal(added->number, 0);
        assert_int_equal(added->letter, 0);
        *added = (pair){.number = k, .letter = (char)(k % 100)};
    }
    assert_int_equal(count, 1000);
    for (int32_t k = 0; k < 1000; k++) {
        assert_int_equal(pairs[k].number, k);
        assert_int_equal(pairs[k].letter, k % 100);
    }
    free(pairs);
}

// Room at least doubles, and is what is needed where that is more.
static void test_room_is_reserved(void **state)
{
    double *values = NULL;
    size_t capacity = 0;
    cp_error error = {0};
    (void)state;
    assert_int_equal(cp_array_reserve(values, capacity, 0, "values", &error), CP_OK);
    assert_null(values);
    assert_int_equal(cp_array_reserve(values, capacity, 1, "values", &error), CP_OK);
    assert_int_equal(capacity, 64);
    values[63] = 63.0;
    assert_int_equal(cp_array_reserve(values, capacity, 64, "values", &error), CP_OK);
    assert_int_equal(capacity, 64);
    assert_int_equal(cp_array_reserve(values, capacity, 65, "values", &error), CP_OK);
    assert_int_equal(capacity, 128);
    assert_true(values[63] == 63.0);
    assert_int_equal(cp_array_reserve(values, capacity, 1000, "values", &error), CP_OK);
    assert_int_equal(capacity, 1000);
    free(values);
}

// What no machine has is refused, and leaves everything as it was; no size wraps around.
static void test_memory_is_gone(void **state)
{
    double *values = NULL;
    size_t capacity = 0;
    cp_error error = {0};
    (void)state;
    assert_int_equal(cp_array_reserve(values, capacity, SIZE_MAX / 4, "values", &error),
                     CP_NO_MEMORY);
    assert_non_null(strstr(error.text, "values"));
    assert_null(values);
    assert_int_equal(capacity, 0);
    size_t count = (SIZE_MAX >> 1) + 1; // a power of two: eight times its double is nothing
    assert_null(cp_array_add(values, count));
    assert_true(count == (SIZE_MAX >> 1) + 1);
    assert_null(values);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_elements_are_added),
        cmocka_unit_test(test_room_is_reserved),
        cmocka_unit_test(test_memory_is_gone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
