/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/output_files.h"

#include "core/file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <sys/stat.h>
#include <unistd.h>

static char before[4096];

// Each test within a folder of its own that holds a file "in", a link to it and a second name.
static int enter_folder(void **state)
{
    char template[] = "test_output_files.XXXXXX";
    char *folder = mkdtemp(template);
    if (folder == NULL || getcwd(before, sizeof before) == NULL)
        return 1;
    *state = strdup(folder);
    return chdir(folder) != 0 || cp_file_write("in", "x", 1, NULL) != CP_OK ||
           symlink("in", "link") != 0 || link("in", "twin") != 0 || mkdir("sub", 0777) != 0 ||
           symlink("..", "sub/up") != 0;
}

static int leave_folder(void **state)
{
    unlink("sub/up");
    rmdir("sub");
    unlink("twin");
    unlink("link");
    unlink("in");
    int failed = chdir(before) != 0 || rmdir(*state) != 0;
    free(*state);
    return failed;
}

static cp_status check(const char *output, const char *input, cp_error *error)
{
    return cp_output_files_check(&output, 1, &input, 1, error);
}

static void an_input_is_no_output_by_any_name(void **state)
{
    (void)state;
    static const char *const SAME[] = {"in", "./in", "sub/../in", "twin", "in-wal", "./in-journal"};
    for (size_t k = 0; k < sizeof SAME / sizeof *SAME; k++) {
        cp_error error = {0};
        assert_int_equal(check(SAME[k], "in", &error), CP_BAD_INPUT);
        assert_non_null(strstr(error.text, "is read too"));
    }
    cp_error error = {0};
    assert_int_equal(check("in", "link", &error), CP_BAD_INPUT);
    assert_int_equal(check("link", "other", &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "symbolic link"));
    // An old result, a new one, none.
    assert_int_equal(check("in", "other", &error), CP_OK);
    assert_int_equal(check("new", "in", &error), CP_OK);
    assert_int_equal(check("sub/in", "in", &error), CP_OK);
    assert_int_equal(check(NULL, "in", &error), CP_OK);
    assert_int_equal(check("new", NULL, &error), CP_OK);
}

static void two_outputs_have_two_places(void **state)
{
    (void)state;
    cp_error error = {0};
    const char *const outputs[] = {"a", NULL, "sub/../a"}, *const apart[] = {"a", "b", "sub/a"};
    assert_int_equal(cp_output_files_check(outputs, 3, NULL, 0, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "two results"));
    assert_int_equal(cp_output_files_check(apart, 3, NULL, 0, &error), CP_OK);
}

static void a_place_that_cannot_be_written_is_known_at_once(void **state)
{
    (void)state;
    cp_error error = {0};
    assert_int_equal(check("none/new", "in", &error), CP_IO_FAILED);
    assert_int_equal(check("sub", "in", &error), CP_BAD_INPUT);
    assert_int_equal(check("sub/", "in", &error), CP_BAD_INPUT);
    assert_int_equal(check("/dev/null", "in", &error), CP_BAD_INPUT);
}

static void a_configuration_file_writes_below_itself(void **state)
{
    (void)state;
    static const char *const GOOD[] = {"new.yaml", "sub/new.yaml", "./new.yaml", "..new.yaml"};
    static const char *const BAD[] = {
        "",       "/tmp/new.yaml",  "../new.yaml",  "sub/../../new.yaml",
        "sub/..", "sub/up/../../x", "none/new.yaml"};
    cp_error error = {0};
    for (size_t k = 0; k < sizeof GOOD / sizeof *GOOD; k++)
        assert_int_equal(cp_output_file_check_below("in", GOOD[k], &error), CP_OK);
    for (size_t k = 0; k < sizeof BAD / sizeof *BAD; k++)
        assert_int_equal(cp_output_file_check_below("in", BAD[k], &error), CP_BAD_INPUT);
    // A link within leads out.
    assert_int_equal(cp_output_file_check_below("sub/in", "up/new.yaml", &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "leads to"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(an_input_is_no_output_by_any_name, enter_folder,
                                        leave_folder),
        cmocka_unit_test_setup_teardown(two_outputs_have_two_places, enter_folder, leave_folder),
        cmocka_unit_test_setup_teardown(a_place_that_cannot_be_written_is_known_at_once,
                                        enter_folder, leave_folder),
        cmocka_unit_test_setup_teardown(a_configuration_file_writes_below_itself, enter_folder,
                                        leave_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
