/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/child.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include <cmocka.h>

// How a shell ends that is started as a worker is.
static cp_child_end run(const char *script)
{
    const char *const arguments[] = {"sh", "-c", script, NULL};
    cp_child child;
    cp_child_end end;
    cp_error error = {0};
    int wait_status = 0;
    if (cp_child_start("/bin/sh", arguments, &child, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(waitpid(child.pid, &wait_status, 0), child.pid);
    cp_child_collect(&child, wait_status, &end);
    return end;
}

static void a_worker_gets_its_environment(void **state)
{
    (void)state;
    assert_int_equal(unsetenv("GLIBC_TUNABLES"), 0);
    assert_int_equal(setenv("CHILD_TEST", "as it was", 1), 0);
    cp_child_end end = run("test \"$GLIBC_TUNABLES\" = glibc.malloc.hugetlb=1 && "
                           "test \"$CHILD_TEST\" = 'as it was' && exit 40");
    assert_int_equal(end.exit_code, 0);
    assert_string_equal(end.reason, "");
}

static void a_failed_worker_says_what_it_wrote_last(void **state)
{
    (void)state;
    cp_child_end end = run("echo first >&2; echo something broke >&2; exit 1");
    assert_int_equal(end.exit_code, 1);
    assert_non_null(strstr(end.reason, "something broke"));
}

// As when a library calls exit(0) in the middle.
static void a_worker_that_only_ends_has_done_nothing(void **state)
{
    (void)state;
    cp_child_end end = run("echo half way >&2; exit 0");
    assert_int_equal(end.exit_code, 1);
    assert_non_null(strstr(end.reason, "ended without a message (exit code 0)"));
    assert_non_null(strstr(end.reason, "half way"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_worker_gets_its_environment),
        cmocka_unit_test(a_failed_worker_says_what_it_wrote_last),
        cmocka_unit_test(a_worker_that_only_ends_has_done_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
