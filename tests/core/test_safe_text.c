/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/safe_text.h"

#include "core/file.h"
#include "core/yaml_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void nothing_acts_on_a_terminal(void **state)
{
    (void)state;
    static const char *const CASE[][2] = {
        {"plain, größer, 汽车, 🚗", "plain, größer, 汽车, 🚗"},
        {"\033[2Jgone", "\\x1b[2Jgone"},
        {"a\nb\tc\rd", "a\\x0ab\\x09c\\x0dd"},
        {"\x7f", "\\x7f"},
        {"\xc2\x9b"
         "31m",
         "\\xc2\\x9b31m"},          // CSI in eight bits
        {"\xff\xc3", "\\xff\\xc3"}, // not UTF-8
        {"\xc0\x80", "\\xc0\\x80"}, // zero the long way
        {"\xe2\x80\xae"
         "txt",
         "\\xe2\\x80\\xaetxt"},               // right to left
        {"\xed\xa0\x80", "\\xed\\xa0\\x80"}}; // half a surrogate pair
    for (size_t k = 0; k < sizeof CASE / sizeof *CASE; k++) {
        char result[128];
        assert_string_equal(cp_text_for_terminal(CASE[k][0], "", result, sizeof result),
                            CASE[k][1]);
        assert_int_equal(cp_text_is_plain(CASE[k][0]), k == 0);
        if (k > 0)
            assert_int_equal(cp_text_width(CASE[k][0]), strlen(CASE[k][1]));
    }
    assert_int_equal(cp_text_width("größer 汽车"), 9);
    char result[8];
    assert_string_equal(cp_text_for_terminal("a\nb\033", "\n", result, sizeof result), "a\nb\\x1b");
    // Whole pieces only where there is no room.
    assert_string_equal(cp_text_for_terminal("abcdef\033", "", result, sizeof result), "abcdef");
}

typedef struct yaml_text {
    char *text;
} yaml_text;

static const cyaml_schema_field_t FIELDS[] = {
    CYAML_FIELD_STRING_PTR("text", CYAML_FLAG_POINTER, yaml_text, text, 0, CYAML_UNLIMITED),
    CYAML_FIELD_END};
static const cyaml_schema_value_t VALUE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, yaml_text, FIELDS)};

static void yaml_reads_back_what_was_written(void **state)
{
    (void)state;
    static const char *const TEXT[] = {"honda_accord_2014",
                                       "2014 Honda: \"fitted\"",
                                       "a\nvehicle: other",
                                       "# no comment",
                                       "x, value: 3}",
                                       "\\",
                                       "yes",
                                       "null",
                                       " blank ",
                                       "$(touch x) `id`",
                                       "'",
                                       "größer",
                                       "- item",
                                       "&a *b !c"};
    for (size_t k = 0; k < sizeof TEXT / sizeof *TEXT; k++) {
        char *content = NULL;
        size_t size = 0;
        FILE *stream = open_memstream(&content, &size);
        assert_non_null(stream);
        fputs("text: ", stream);
        cp_text_write_yaml(stream, TEXT[k]);
        fputc('\n', stream);
        fclose(stream);
        cp_error error = {0};
        cp_yaml_file file = {0};
        if (cp_yaml_parse("made", content, size, &VALUE, &file, &error) != CP_OK)
            fail_msg("%s: %s", content, error.text);
        assert_string_equal(((const yaml_text *)file.data)->text, TEXT[k]);
        cp_yaml_close(&file);
        free(content);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(nothing_acts_on_a_terminal),
                                       cmocka_unit_test(yaml_reads_back_what_was_written)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
