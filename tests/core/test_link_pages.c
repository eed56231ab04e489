/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/link_pages.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Resident pages of files, kB.
static long file_kb(void)
{
    FILE *status = fopen("/proc/self/status", "r");
    assert_non_null(status);
    char line[256];
    long kb = -1;
    while (fgets(line, sizeof line, status) != NULL)
        if (strncmp(line, "RssFile:", 8) == 0)
            kb = strtol(line + 8, NULL, 10);
    fclose(status);
    return kb;
}

static const char CONSTANT[] = "read again after it was given back";

static void memory_falls_and_all_of_it_still_reads(void **state)
{
    (void)state;
    volatile const char *text = CONSTANT;
    assert_int_equal(text[0], 'r');
    long before_kb = file_kb();
    assert_true(cp_link_pages_release() > 0);
    assert_true(file_kb() < before_kb);
    assert_string_equal(CONSTANT, "read again after it was given back");

    // Numbers to and from text read tables of the C library.
    char number[32];
    snprintf(number, sizeof number, "%.3f", strtod("2.125", NULL));
    assert_string_equal(number, "2.125");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(memory_falls_and_all_of_it_still_reads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
