/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "calibrate/descent_journal.h"
#include "core/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { DIMENSION = 3 };

/* A journal in a folder of its own. */
typedef struct desk {
    char folder[64];
    char path[128];
} desk;

static desk open_desk(void)
{
    desk d;
    strcpy(d.folder, "/tmp/journal_XXXXXX");
    assert_non_null(mkdtemp(d.folder));
    snprintf(d.path, sizeof d.path, "%s/state", d.folder);
    return d;
}

static void close_desk(const desk *d)
{
    unlink(d->path);
    rmdir(d->folder);
}

static const double POINT[2][DIMENSION] = {{0.1, 1.0 / 3.0, 1.0}, {0.0, 2.0 / 3.0, 0.7}};

// Two descents noted, the file closed.
static void note_two(const desk *d)
{
    cp_descent_journal journal;
    cp_error error = {0};
    assert_int_equal(cp_descent_journal_open(&journal, d->path, DIMENSION, &error), CP_OK);
    for (size_t k = 0; k < 2; k++)
        assert_int_equal(
            cp_descent_journal_add(&journal, 100 + k, 1.0 / (3.0 + (double)k), POINT[k], &error),
            CP_OK);
    cp_descent_journal_close(&journal);
}

static void what_was_noted_comes_back_to_the_bit(void **state)
{
    (void)state;
    desk d = open_desk();
    note_two(&d);
    cp_descent_journal journal;
    cp_error error = {0};
    double point[DIMENSION] = {0.5, 0.5, 0.5};
    bool known = false;
    assert_int_equal(cp_descent_journal_open(&journal, d.path, DIMENSION, &error), CP_OK);
    for (size_t k = 0; k < 2; k++) {
        assert_int_equal(cp_descent_journal_recall(&journal, 100 + k, 1.0 / (3.0 + (double)k),
                                                   point, &known, &error),
                         CP_OK);
        assert_true(known);
        assert_memory_equal(point, POINT[k], sizeof point);
    }

    // The third is to be gone.
    assert_int_equal(cp_descent_journal_recall(&journal, 800, 0.2, point, &known, &error), CP_OK);
    assert_false(known);
    assert_memory_equal(point, POINT[1], sizeof point);
    cp_descent_journal_close(&journal);
    close_desk(&d);
}

static void another_fit_is_refused(void **state)
{
    (void)state;
    desk d = open_desk();
    note_two(&d);
    static const struct {
        size_t evaluations;
        double before;
    } CASES[] = {{101, 1.0 / 3.0}, {100, 0.33}};
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        cp_descent_journal journal;
        cp_error error = {0};
        double point[DIMENSION];
        bool known = false;
        assert_int_equal(cp_descent_journal_open(&journal, d.path, DIMENSION, &error), CP_OK);
        assert_int_equal(cp_descent_journal_recall(&journal, CASES[k].evaluations, CASES[k].before,
                                                   point, &known, &error),
                         CP_BAD_INPUT);
        assert_non_null(strstr(error.text, "state:1: is of another fit"));
        cp_descent_journal_close(&journal);
    }
    close_desk(&d);
}

static void a_file_of_something_else_is_refused(void **state)
{
    (void)state;
    static const char *const SECOND_LINE[] = {"words", "100 0.5 0.1 0.2", "100 0.5 0.1 0.2 0.3 0.4",
                                              "100 0.5 0.1 0.2 1.5", "100 nan 0.1 0.2 0.3"};
    for (size_t k = 0; k < sizeof SECOND_LINE / sizeof *SECOND_LINE; k++) {
        desk d = open_desk();
        char text[128];
        snprintf(text, sizeof text, "100 0.5 0.1 0.2 0.3\n%s\n", SECOND_LINE[k]);
        cp_error error = {0};
        assert_int_equal(cp_file_write(d.path, text, strlen(text), &error), CP_OK);
        cp_descent_journal journal;
        assert_int_equal(cp_descent_journal_open(&journal, d.path, DIMENSION, &error),
                         CP_BAD_INPUT);
        assert_non_null(strstr(error.text, "state:2: must have evaluations, a value and 3 "
                                           "coordinates"));
        cp_descent_journal_close(&journal);
        close_desk(&d);
    }
}

static void a_folder_that_is_gone_is_named(void **state)
{
    (void)state;
    cp_descent_journal journal;
    cp_error error = {0};
    assert_int_equal(
        cp_descent_journal_open(&journal, "/tmp/no_such_folder/state", DIMENSION, &error), CP_OK);
    assert_int_not_equal(cp_descent_journal_add(&journal, 1, 0.0, POINT[0], &error), CP_OK);
    assert_non_null(strstr(error.text, "no_such_folder"));
    cp_descent_journal_close(&journal);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_noted_comes_back_to_the_bit),
        cmocka_unit_test(another_fit_is_refused),
        cmocka_unit_test(a_file_of_something_else_is_refused),
        cmocka_unit_test(a_folder_that_is_gone_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
