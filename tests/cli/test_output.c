/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/output.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static char *printed(cp_format format)
{
    static const char *const COLUMN[] = {"name", "count", "value"};
    char *text = NULL;
    size_t size = 0;
    cp_error error = {0};
    FILE *file = open_memstream(&text, &size);
    cp_table table;
    cp_table_begin(&table, COLUMN, 3);
    cp_table_text(&table, "Überholen, \"risky\"");
    cp_table_integer(&table, 12);
    cp_table_real(&table, 0.1);
    cp_table_text(&table, "x");
    cp_table_null(&table);
    cp_table_real(&table, NAN);
    assert_int_equal(cp_table_print(&table, format, file, &error), CP_OK);
    cp_table_destroy(&table);
    fclose(file);
    return text;
}

static void table_is_aligned_by_characters(void **state)
{
    (void)state;
    char *text = printed(CP_FORMAT_TABLE);
    assert_string_equal(text, "name                count  value\n"
                              "------------------  -----  -----\n"
                              "Überholen, \"risky\"     12    0.1\n"
                              "x                               \n");
    free(text);
}

static void csv_quotes_and_keeps_all_digits(void **state)
{
    (void)state;
    char *text = printed(CP_FORMAT_CSV);
    assert_string_equal(text, "name,count,value\n"
                              "\"Überholen, \"\"risky\"\"\",12,0.10000000000000001\n"
                              "x,,\n");
    free(text);
}

static void json_gives_the_same_bits_back(void **state)
{
    (void)state;
    char *text = printed(CP_FORMAT_JSON);
    json_t *rows = json_loads(text, 0, NULL);
    assert_int_equal(json_array_size(rows), 2);
    double value = json_real_value(json_object_get(json_array_get(rows, 0), "value"));
    assert_true(value == 0.1);
    assert_true(json_is_null(json_object_get(json_array_get(rows, 1), "value")));
    json_decref(rows);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_is_aligned_by_characters),
        cmocka_unit_test(csv_quotes_and_keeps_all_digits),
        cmocka_unit_test(json_gives_the_same_bits_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
