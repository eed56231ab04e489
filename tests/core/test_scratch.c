/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/scratch.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <sys/stat.h>
#include <unistd.h>

static void a_program_works_within_and_nothing_stays(void **state)
{
    (void)state;
    static const char *const COPY[] = {"cp", "in", "`out; $(touch x)", NULL};
    static const char *const FALSE[] = {"false", NULL}, *const NONE[] = {"no such program", NULL};
    const char *const part[] = {"one ", "two"};
    cp_scratch scratch;
    cp_error error = {0};
    char *content = NULL, path[4096];
    size_t size = 0;
    int code = -1;
    assert_int_equal(setenv("TMPDIR", ".", 1), 0);
    assert_int_equal(cp_scratch_open(&scratch, &error), CP_OK);
    strcpy(path, scratch.path);
    struct stat entry;
    assert_int_equal(stat(path, &entry), 0);
    assert_int_equal(entry.st_mode & 0777, 0700);
    assert_int_equal(cp_scratch_write(&scratch, "in", part, 2, &error), CP_OK);
    // A name is never written twice.
    assert_int_equal(cp_scratch_write(&scratch, "in", part, 2, &error), CP_IO_FAILED);
    assert_int_equal(cp_scratch_run(&scratch, COPY, &code, &error), CP_OK);
    assert_int_equal(code, 0);
    assert_int_equal(cp_scratch_read(&scratch, COPY[2], &content, &size, &error), CP_OK);
    assert_string_equal(content, "one two");
    free(content);
    assert_int_equal(cp_scratch_read(&scratch, "x", &content, &size, &error), CP_RUN_FAILED);
    assert_int_equal(cp_scratch_run(&scratch, FALSE, &code, &error), CP_OK);
    assert_int_equal(code, 1);
    assert_int_equal(cp_scratch_run(&scratch, NONE, &code, &error), CP_BAD_INPUT);
    cp_scratch_close(&scratch);
    assert_int_equal(access(path, F_OK), -1);
    FILE *file = cp_scratch_file();
    assert_non_null(file);
    assert_true(fputs("text", file) >= 0 && fseek(file, 0, SEEK_SET) == 0 && fgetc(file) == 't');
    fclose(file);
}

static void a_folder_that_cannot_be_made_is_named(void **state)
{
    (void)state;
    cp_scratch scratch;
    cp_error error = {0};
    assert_int_equal(setenv("TMPDIR", "/no/such/folder", 1), 0);
    assert_int_equal(cp_scratch_open(&scratch, &error), CP_IO_FAILED);
    assert_null(cp_scratch_file());
    assert_non_null(strstr(error.text, "/no/such/folder"));
    cp_scratch_close(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_program_works_within_and_nothing_stays),
                                       cmocka_unit_test(a_folder_that_cannot_be_made_is_named)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
