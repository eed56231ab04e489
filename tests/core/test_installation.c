/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/installation.h"

#include <limits.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

// What lies beside the program is taken; what does not has its place in the installation.
static void parts_lie_beside_the_program_or_in_their_folders(void **state)
{
    (void)state;
    char program[PATH_MAX], path[PATH_MAX];
    cp_error error = {0};
    assert_int_equal(cp_installation_program(program, sizeof program, &error), CP_OK);
    const char *name = strrchr(program, '/') + 1;
    assert_int_equal(cp_installation_find(CP_INSTALLED_WORKER, name, path, sizeof path, &error),
                     CP_OK);
    assert_string_equal(path, program);
    assert_int_equal(
        cp_installation_find(CP_INSTALLED_DATA, "no such part", path, sizeof path, &error), CP_OK);
    assert_non_null(strstr(path, "/../"));
    assert_non_null(strstr(path, "/crashpulse/no such part"));
}

static void a_path_without_room_is_an_error(void **state)
{
    (void)state;
    char path[8];
    cp_error error = {0};
    assert_int_equal(cp_installation_program(path, sizeof path, &error), CP_IO_FAILED);
    assert_int_equal(cp_installation_find(CP_INSTALLED_DATA, "db", path, sizeof path, &error),
                     CP_IO_FAILED);
    assert_non_null(strstr(error.text, "too long"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_lie_beside_the_program_or_in_their_folders),
        cmocka_unit_test(a_path_without_room_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
