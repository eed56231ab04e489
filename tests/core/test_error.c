/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/error.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void a_failure_carries_its_status_and_words(void **state)
{
    (void)state;
    cp_error error = {0};
    assert_int_equal(
        cp_fail(&error, CP_BAD_INPUT, "%s:%d: ttc_s must be > 0, found %g", "a.yaml", 14, -1.5),
        CP_BAD_INPUT);
    assert_int_equal(error.status, CP_BAD_INPUT);
    assert_string_equal(error.text, "a.yaml:14: ttc_s must be > 0, found -1.5");
}

static void nobody_needs_to_listen(void **state)
{
    (void)state;
    assert_int_equal(cp_fail(NULL, CP_IO_FAILED, "unheard"), CP_IO_FAILED);
    assert_int_equal(cp_fail_memory(NULL, "unheard"), CP_NO_MEMORY);
}

static void memory_says_what_was_asked_for(void **state)
{
    (void)state;
    cp_error error = {0};
    assert_int_equal(cp_fail_memory(&error, "vehicle states"), CP_NO_MEMORY);
    assert_string_equal(error.text, "out of memory: vehicle states");
}

static void context_goes_in_front(void **state)
{
    (void)state;
    cp_error error = {0};
    (void)cp_fail(&error, CP_BAD_INPUT, "unknown key ttc");
    assert_int_equal(cp_error_prefix(&error, "%s: variant %d: ", "study.yaml", 2), CP_BAD_INPUT);
    assert_string_equal(error.text, "study.yaml: variant 2: unknown key ttc");
}

static void a_long_message_is_cut_at_its_end(void **state)
{
    (void)state;
    cp_error error = {0};
    char longest[2 * sizeof error.text];
    memset(longest, 'x', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    (void)cp_fail(&error, CP_BAD_INPUT, "%s", longest);
    assert_int_equal(strlen(error.text), sizeof error.text - 1);
    (void)cp_error_prefix(&error, "here: ");
    assert_int_equal(strlen(error.text), sizeof error.text - 1);
    assert_memory_equal(error.text, "here: xxx", 9);
    (void)cp_error_prefix(&error, "%s", longest); // a prefix has its limit too
    assert_true(strlen(error.text) < sizeof error.text);
    assert_memory_equal(error.text, "xxxxxxxxx", 9);
}

static void exit_codes_are_the_contract_with_users(void **state)
{
    (void)state;
    assert_int_equal(cp_status_exit_code(CP_OK), 0);
    assert_int_equal(cp_status_exit_code(CP_BAD_INPUT), 2);
    static const cp_status FAILED[] = {CP_NO_MEMORY,    CP_IO_FAILED,    CP_TRAFFIC_FAILED,
                                       CP_CRASH_FAILED, CP_STORE_FAILED, CP_BUSY,
                                       CP_RUN_FAILED,   CP_INTERRUPTED};
    for (size_t k = 0; k < sizeof FAILED / sizeof FAILED[0]; k++)
        assert_int_equal(cp_status_exit_code(FAILED[k]), 1);
    assert_string_equal(cp_status_text(CP_BAD_INPUT), "bad input");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_failure_carries_its_status_and_words),
        cmocka_unit_test(nobody_needs_to_listen),
        cmocka_unit_test(memory_says_what_was_asked_for),
        cmocka_unit_test(context_goes_in_front),
        cmocka_unit_test(a_long_message_is_cut_at_its_end),
        cmocka_unit_test(exit_codes_are_the_contract_with_users),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
