/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/hash.h"

#include "core/file.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <unistd.h>

/* FIPS 180-4 examples. */
#define SHA256_ABC "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
#define SHA256_NOTHING "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"

static void bytes_hash_as_the_standard_says(void **state)
{
    (void)state;
    char hex[CP_HASH_TEXT_SIZE];
    cp_hash_bytes("abc", 3, hex);
    assert_string_equal(hex, SHA256_ABC);
    cp_hash_bytes("", 0, hex);
    assert_string_equal(hex, SHA256_NOTHING);
    cp_hash_bytes("abc\0tail", 3, hex);
    assert_string_equal(hex, SHA256_ABC);
}

static void files_hash_as_sha256sum_does(void **state)
{
    (void)state;
    char path[] = "test_core_hash.XXXXXX", hex[CP_HASH_TEXT_SIZE];
    int handle = mkstemp(path);
    assert_true(handle >= 0);
    assert_int_equal(write(handle, "abc", 3), 3);
    close(handle);
    assert_int_equal(cp_hash_file(path, hex, NULL), CP_OK);
    assert_string_equal(hex, SHA256_ABC);
    unlink(path);
    cp_error error = {0};
    assert_int_equal(cp_hash_file(path, hex, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, path));
}

static void row_ids_are_the_first_42_bits(void **state)
{
    (void)state;
    assert_true(cp_hash_row_id("abc") == INT64_C(0xba7816bf8f0) >> 2);
    assert_true(cp_hash_row_id("") == INT64_C(0xe3b0c44298f) >> 2);
    char text[16];
    for (int k = 0; k < 1000; k++) {
        snprintf(text, sizeof text, "key %d", k);
        int64_t id = cp_hash_row_id(text);
        assert_true(id >= 0 && id < INT64_C(1) << 42); // a double holds it
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bytes_hash_as_the_standard_says),
        cmocka_unit_test(files_hash_as_sha256sum_does),
        cmocka_unit_test(row_ids_are_the_first_42_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
