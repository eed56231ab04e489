/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "core/yaml_lines.h"

#include "core/yaml_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// What a file may hold is no matter here: everything is passed over by libcyaml.
static const cyaml_schema_field_t ANY_FIELDS[] = {CYAML_FIELD_IGNORE("base", CYAML_FLAG_OPTIONAL),
                                                  CYAML_FIELD_IGNORE("list", CYAML_FLAG_OPTIONAL),
                                                  CYAML_FIELD_IGNORE("copy", CYAML_FLAG_OPTIONAL),
                                                  CYAML_FIELD_END};
typedef struct nothing {
    char unused;
} nothing;
static const cyaml_schema_value_t ANY = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, nothing, ANY_FIELDS)};

static cp_status parse(const char *text, cp_yaml_file *file, cp_error *error)
{
    return cp_yaml_parse("a.yaml", text, strlen(text), &ANY, file, error);
}

// Text of the value at a key path, or NULL; its line.
static const char *value_at(const cp_yaml_file *file, const char *path, size_t *line)
{
    for (size_t k = 0; k < file->line_count; k++)
        if (strcmp(file->lines[k].path, path) == 0) {
            *line = file->lines[k].line;
            return file->lines[k].scalar;
        }
    return NULL;
}

static void expect(const cp_yaml_file *file, const char *path, const char *text, size_t line)
{
    size_t found_line = 0;
    const char *found = value_at(file, path, &found_line);
    if (found == NULL || strcmp(found, text) != 0 || found_line != line)
        fail_msg("%s: expected '%s' of line %zu, found '%s' of line %zu", path, text, line,
                 found != NULL ? found : "nothing", found_line);
}

static void an_alias_stands_for_what_its_anchor_marks(void **state)
{
    (void)state;
    cp_yaml_file file;
    cp_error error = {0};
    assert_int_equal(parse("base: &all\n"
                           "  - &first {a: 1, b: &deep [2, 3]}\n"
                           "  - &number 4\n"
                           "list: *all\n"
                           "copy: {one: *first, two: *number, three: [*deep, *number]}\n",
                           &file, &error),
                     CP_OK);
    expect(&file, "list[0].a", "1", 2);
    expect(&file, "list[0].b[1]", "3", 2);
    expect(&file, "list[1]", "4", 3);
    expect(&file, "copy.one.a", "1", 2);
    expect(&file, "copy.one.b[0]", "2", 2);
    expect(&file, "copy.two", "4", 3);
    expect(&file, "copy.three[0][1]", "3", 2);
    expect(&file, "copy.three[1]", "4", 3);
    cp_yaml_close(&file);
}

static void an_alias_means_the_last_anchor_before_it(void **state)
{
    (void)state;
    cp_yaml_file file;
    cp_error error = {0};
    assert_int_equal(parse("base: [&x 1, *x, &x 2, *x]\n", &file, &error), CP_OK);
    expect(&file, "base[1]", "1", 1);
    expect(&file, "base[3]", "2", 1);
    cp_yaml_close(&file);
}

static void what_is_not_read_is_refused_by_file_and_line(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        const char *words;
    } CASES[] = {
        {"base: 1\nlist: *no\n", "a.yaml:2: there is no anchor before the alias *no"},
        {"base:\n  &a [1,\n  *a]\n", "a.yaml:3: an alias must not stand inside"},
        {"base: &a {x: 1}\ncopy:\n  <<: *a\n", "a.yaml:3: merge keys (<<) are not read"},
        {"base: &a copy\n*a : 1\n", "a.yaml:2: an alias must not stand in place of a key: *a"},
        {"base: 1\n---\nbase: 2\n", "a.yaml:2: a second document begins"},
    };
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        cp_yaml_file file;
        cp_error error = {0};
        assert_int_equal(parse(CASES[k].text, &file, &error), CP_BAD_INPUT);
        if (strstr(error.text, CASES[k].words) == NULL)
            fail_msg("expected '%s' in: %s", CASES[k].words, error.text);
    }
}

static void aliases_of_aliases_do_not_fill_the_memory(void **state)
{
    (void)state;
    char text[4096] = "base:\n  - &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
    for (int k = 1; k < 9; k++) {
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used,
                 "  - &a%d [*a%d, *a%d, *a%d, *a%d, *a%d, *a%d, *a%d, *a%d, *a%d]\n", k, k - 1,
                 k - 1, k - 1, k - 1, k - 1, k - 1, k - 1, k - 1, k - 1);
    }
    cp_yaml_file file;
    cp_error error = {0};
    assert_int_equal(parse(text, &file, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "more than 100,000 values"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_alias_stands_for_what_its_anchor_marks),
        cmocka_unit_test(an_alias_means_the_last_anchor_before_it),
        cmocka_unit_test(what_is_not_read_is_refused_by_file_and_line),
        cmocka_unit_test(aliases_of_aliases_do_not_fill_the_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
