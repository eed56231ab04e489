/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/memory_stream.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

/* Requests for memory are refused from here on; the C library's own are behind these. */
static bool refuse;

#ifndef __SANITIZE_ADDRESS__
extern void *__libc_realloc(void *memory, size_t size);

void *realloc(void *memory, size_t size)
{
    return refuse ? NULL : __libc_realloc(memory, size);
}
#endif

static void gives_what_was_written(void **state)
{
    char *content = NULL;
    size_t size = 1;
    (void)state;
    FILE *out = cp_memory_stream(&content, &size);
    assert_non_null(out);
    for (int k = 0; k < 10000; k++)
        assert_true(fprintf(out, "%d,", k) > 0);
    assert_int_equal(ferror(out), 0);
    assert_int_equal(fclose(out), 0);
    assert_int_equal(size, strlen(content));
    assert_int_equal(size, 10 * 2 + 90 * 3 + 900 * 4 + 9000 * 5);
    assert_memory_equal(content, "0,1,2,3,", 8);
    assert_string_equal(content + size - 10, "9998,9999,");
    free(content);
}

static void gives_an_empty_text_for_nothing(void **state)
{
    char *content = NULL;
    size_t size = 1;
    (void)state;
    FILE *out = cp_memory_stream(&content, &size);
    assert_non_null(out);
    assert_int_equal(fclose(out), 0);
    assert_int_equal(size, 0);
    assert_string_equal(content, "");
    free(content);
}

// A piece that found no room is an error even when there is room again for the next.
static void tells_what_is_missing(void **state)
{
    char *content = NULL;
    size_t size = 1;
    (void)state;
#ifdef __SANITIZE_ADDRESS__
    skip();
#endif
    FILE *out = cp_memory_stream(&content, &size);
    assert_non_null(out);
    fputs("first", out);
    assert_int_equal(fflush(out), 0);
    refuse = true;
    for (int k = 0; k < 20000; k++)
        fputc('x', out);
    refuse = false;
    fputs("last", out);
    assert_int_not_equal(fclose(out), 0);
    assert_null(content);
    assert_int_equal(size, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gives_what_was_written),
        cmocka_unit_test(gives_an_empty_text_for_nothing),
        cmocka_unit_test(tells_what_is_missing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
