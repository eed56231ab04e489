/* SPDX-License-Identifier: GPL-3.0-or-later */
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
#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

/* A folder of its own for each test. */
static int make_folder(void **state)
{
    char template[] = "test_core_file.XXXXXX";
    char *folder = mkdtemp(template);
    *state = folder != NULL ? strdup(folder) : NULL;
    return *state == NULL;
}

static int remove_folder(void **state)
{
    int failed = rmdir(*state); // empty: nothing is left behind
    free(*state);
    return failed;
}

static void what_is_written_is_read_back(void **state)
{
    // Zero bytes inside, and longer than the first buffer.
    char path[64];
    snprintf(path, sizeof path, "%s/data", (char *)*state);
    static const size_t SIZE[] = {0, 1, 65535, 65536, 65537, 300000};
    for (size_t k = 0; k < sizeof SIZE / sizeof SIZE[0]; k++) {
        char *out = malloc(SIZE[k] + 1), *in = NULL;
        assert_non_null(out);
        for (size_t b = 0; b < SIZE[k]; b++)
            out[b] = (char)(b * 7 % 251);
        size_t size = 99;
        assert_int_equal(cp_file_write(path, out, SIZE[k], NULL), CP_OK);
        assert_int_equal(cp_file_read(path, &in, &size, NULL), CP_OK);
        assert_int_equal(size, SIZE[k]);
        assert_memory_equal(in, out, size);
        assert_int_equal(in[size], '\0');
        free(in);
        free(out);
    }
    unlink(path);
}

static void a_missing_file_and_a_folder_are_bad_input(void **state)
{
    char path[64], *content = NULL;
    size_t size;
    cp_error error = {0};
    snprintf(path, sizeof path, "%s/none", (char *)*state);
    assert_int_equal(cp_file_read(path, &content, &size, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, path));
    assert_non_null(strstr(error.text, "No such file"));
    assert_int_equal(cp_file_read(*state, &content, &size, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "it is a folder"));
    assert_null(content);
}

static void a_failed_write_leaves_nothing_behind(void **state)
{
    char path[64];
    cp_error error = {0};
    snprintf(path, sizeof path, "%s/no/where", (char *)*state);
    assert_int_equal(cp_file_write(path, "x", 1, &error), CP_IO_FAILED);
    assert_non_null(strstr(error.text, path));

    DIR *folder = opendir(*state);
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;)
        assert_int_equal(entry->d_name[0], '.');
    closedir(folder);
}

// A pipe nobody writes into and a device without end do not hold a command up.
static void what_has_no_end_is_not_read(void **state)
{
    char path[64], *content = NULL;
    size_t size = 0;
    cp_error error = {0};
    snprintf(path, sizeof path, "%s/pipe", (char *)*state);
    assert_int_equal(mkfifo(path, 0666), 0);
    assert_int_equal(cp_file_read(path, &content, &size, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "it is a pipe"));
    unlink(path);
    assert_int_equal(cp_file_read("/dev/zero", &content, &size, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "it is a device"));

    // 3 GiB that take no place on the disk.
    snprintf(path, sizeof path, "%s/large", (char *)*state);
    assert_int_equal(cp_file_write(path, "", 0, &error), CP_OK);
    assert_int_equal(truncate(path, (off_t)3 << 30), 0);
    assert_int_equal(cp_file_read(path, &content, &size, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "larger than 2 GiB"));
    unlink(path);
}

static void text_has_no_zero_bytes(void **state)
{
    static const struct {
        const char *bytes;
        size_t size;
        const char *read, *what;
    } CASE[] = {{"a\nb\n", 4, "a\nb\n", NULL},
                {"\xef\xbb\xbf"
                 "a,b",
                 6, "a,b", NULL},
                {"\xef\xbb\xbf", 3, "", NULL},
                {"", 0, "", NULL},
                {"a\nb\n\0c\n", 7, NULL, ":3: holds a zero byte"},
                {"\0", 1, NULL, ":1: holds a zero byte"},
                {"\xff\xfe"
                 "a\0",
                 4, NULL, "UTF-16"}};
    char path[64];
    snprintf(path, sizeof path, "%s/text", (char *)*state);
    for (size_t k = 0; k < sizeof CASE / sizeof *CASE; k++) {
        cp_error error = {0};
        char *content = NULL;
        size_t size = 0;
        assert_int_equal(cp_file_write(path, CASE[k].bytes, CASE[k].size, &error), CP_OK);
        cp_status status = cp_file_read_text(path, &content, &size, &error);
        assert_int_equal(status, CASE[k].read != NULL ? CP_OK : CP_BAD_INPUT);
        if (CASE[k].read != NULL) {
            assert_string_equal(content, CASE[k].read);
            assert_int_equal(size, strlen(CASE[k].read));
        } else {
            assert_non_null(strstr(error.text, CASE[k].what));
            assert_null(content);
        }
        free(content);
    }
    unlink(path);
}

// What is no regular file is left alone, whatever the rights of the user.
static void only_regular_files_are_replaced(void **state)
{
    char path[64], other[64], *content = NULL;
    size_t size = 0;
    cp_error error = {0};
    snprintf(path, sizeof path, "%s/target", (char *)*state);
    snprintf(other, sizeof other, "%s/other", (char *)*state);
    assert_int_equal(mkdir(path, 0777), 0);
    assert_int_equal(cp_file_write(path, "x", 1, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "a folder"));
    rmdir(path);
    assert_int_equal(mkfifo(path, 0666), 0);
    assert_int_equal(cp_file_write(path, "x", 1, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "a pipe"));
    unlink(path);
    assert_int_equal(cp_file_write("/dev/null", "x", 1, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "a device"));

    // A link: neither it nor what it leads to.
    assert_int_equal(cp_file_write(other, "kept", 4, &error), CP_OK);
    assert_int_equal(symlink("other", path), 0);
    assert_int_equal(cp_file_write(path, "x", 1, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "a symbolic link"));
    assert_int_equal(cp_file_read(other, &content, &size, &error), CP_OK);
    assert_string_equal(content, "kept");
    free(content);
    unlink(path);
    unlink(other);
}

static void neighbours_are_found_beside_the_base(void **state)
{
    (void)state;
    static const char *const CASE[][3] = {{"a/study.yaml", "x.cfg", "a/x.cfg"},
                                          {"a/study.yaml", "../b.cfg", "a/../b.cfg"},
                                          {"/r/a/study.yaml", "x/y.cfg", "/r/a/x/y.cfg"},
                                          {"study.yaml", "x.cfg", "x.cfg"},
                                          {"/study.yaml", "x.cfg", "/x.cfg"},
                                          {"a/study.yaml", "/etc/x.cfg", "/etc/x.cfg"}};
    for (size_t k = 0; k < sizeof CASE / sizeof CASE[0]; k++) {
        char *beside = cp_file_beside(CASE[k][0], CASE[k][1]);
        assert_string_equal(beside, CASE[k][2]);
        free(beside);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(what_is_written_is_read_back, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(a_missing_file_and_a_folder_are_bad_input, make_folder,
                                        remove_folder),
        cmocka_unit_test_setup_teardown(a_failed_write_leaves_nothing_behind, make_folder,
                                        remove_folder),
        cmocka_unit_test_setup_teardown(what_has_no_end_is_not_read, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(text_has_no_zero_bytes, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(only_regular_files_are_replaced, make_folder,
                                        remove_folder),
        cmocka_unit_test(neighbours_are_found_beside_the_base),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
