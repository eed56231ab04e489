/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/sumo_list.h"

#include "core/file.h"
#include "study/input_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void assert_names(const char *text, const char *const *names)
{
    cp_sumo_list list;
    cp_error error = {0};
    assert_int_equal(cp_sumo_list_create(text, "a list", &list, &error), CP_OK);
    for (size_t k = 0; names[k] != NULL; k++) {
        const char *name = cp_sumo_list_next(&list);
        assert_non_null(name);
        assert_string_equal(name, names[k]);
    }
    assert_null(cp_sumo_list_next(&list));
    assert_null(cp_sumo_list_next(&list));
    cp_sumo_list_destroy(&list);
}

static void names_are_split_at_commas(void **state)
{
    (void)state;
    assert_names("", (const char *const[]){NULL});
    assert_names(" , ,\t\n,", (const char *const[]){NULL});
    assert_names("a.xml", (const char *const[]){"a.xml", NULL});
    assert_names(" a b.xml ,,\n\tc.xml\r\n, d",
                 (const char *const[]){"a b.xml", "c.xml", "d", NULL});
    // Not here: what a .sumocfg encodes is undone name by name.
    assert_names("a%2Cb", (const char *const[]){"a%2Cb", NULL});
}

static void the_environment_is_put_in(void **state)
{
    (void)state;
    assert_int_equal(setenv("CP_TEST_LIST", "x,y", 1), 0);
    assert_int_equal(unsetenv("CP_TEST_NONE"), 0);
    assert_names("${CP_TEST_LIST}/a,b", (const char *const[]){"x", "y/a", "b", NULL});
    assert_names("${CP_TEST_NONE}/a,${", (const char *const[]){"${CP_TEST_NONE}/a", "${", NULL});
}

static void percent_signs_are_undone(void **state)
{
    (void)state;
    char name[] = "a%20b%2c%%zz%4";
    cp_sumo_name_decode(name);
    assert_string_equal(name, "a b,%%zz%4");
}

// Whoever looks for something else does not pay for the hash.
static void a_file_is_hashed_when_asked(void **state)
{
    (void)state;
    char path[] = "/tmp/crashpulse-test-XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    cp_error error = {0};
    const char text[] = "<routes><!-- not this --><vType id='car'/></routes>";
    assert_int_equal(cp_file_write(path, text, strlen(text), &error), CP_OK);
    cp_input_file found = {0};
    const cp_input_search types = {.types = true}, hash = {.hash = true};
    assert_int_equal(cp_input_file_read(path, &types, &found, &error), CP_OK);
    assert_string_equal(found.hash, "");
    assert_int_equal(found.type_count, 1);
    cp_input_file_destroy(&found);
    assert_int_equal(cp_input_file_read(path, &hash, &found, &error), CP_OK);
    // SHA-256 of the text without its comment.
    const char plain[] = "<routes><vType id='car'/></routes>";
    char expected[CP_HASH_TEXT_SIZE];
    cp_hash_bytes(plain, strlen(plain), expected);
    assert_string_equal(found.hash, expected);
    assert_int_equal(found.type_count, 0);
    cp_input_file_destroy(&found);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_split_at_commas),
        cmocka_unit_test(the_environment_is_put_in),
        cmocka_unit_test(percent_signs_are_undone),
        cmocka_unit_test(a_file_is_hashed_when_asked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
