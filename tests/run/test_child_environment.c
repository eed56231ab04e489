/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/child_environment.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

// The environment that comes of another is this one, word for word.
static void assert_becomes(char *const *given, const char *const *expected)
{
    char **made = cp_child_environment(given);
    assert_non_null(made);
    size_t k = 0;
    for (; expected[k] != NULL; k++) {
        assert_non_null(made[k]);
        assert_string_equal(made[k], expected[k]);
    }
    assert_null(made[k]);
    cp_child_environment_free(made);
}

static void a_worker_asks_for_huge_pages(void **state)
{
    (void)state;
    char *given[] = {"PATH=/bin", "LANG=C", NULL};
    const char *expected[] = {"GLIBC_TUNABLES=glibc.malloc.hugetlb=1", "PATH=/bin", "LANG=C", NULL};
    assert_becomes(given, expected);
    char *none[] = {NULL};
    const char *alone[] = {"GLIBC_TUNABLES=glibc.malloc.hugetlb=1", NULL};
    assert_becomes(none, alone);
}

static void other_tunables_stay(void **state)
{
    (void)state;
    char *given[] = {"A=1", "GLIBC_TUNABLES=glibc.malloc.check=3", "GLIBC_TUNABLES_X=y", NULL};
    const char *expected[] = {"GLIBC_TUNABLES=glibc.malloc.check=3:glibc.malloc.hugetlb=1", "A=1",
                              "GLIBC_TUNABLES_X=y", NULL};
    assert_becomes(given, expected);
    char *empty[] = {"GLIBC_TUNABLES=", NULL};
    const char *alone[] = {"GLIBC_TUNABLES=glibc.malloc.hugetlb=1", NULL};
    assert_becomes(empty, alone);
}

static void who_says_what_pages_he_wants_gets_them(void **state)
{
    (void)state;
    char *given[] = {"GLIBC_TUNABLES=glibc.malloc.hugetlb=0", "A=1", NULL};
    const char *expected[] = {"GLIBC_TUNABLES=glibc.malloc.hugetlb=0", "A=1", NULL};
    assert_becomes(given, expected);
}

int main(void)
{
    cp_child_environment_free(NULL);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_worker_asks_for_huge_pages),
        cmocka_unit_test(other_tunables_stay),
        cmocka_unit_test(who_says_what_pages_he_wants_gets_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
