/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "core/yaml_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct yaml_part {
    char *name;
    char *mass_kg;
} yaml_part;

typedef struct yaml_car {
    char *car;
    yaml_part *parts;
    unsigned parts_count;
} yaml_car;

static const cyaml_schema_field_t PART_FIELDS[] = {
    CYAML_FIELD_STRING_PTR("name", CYAML_FLAG_POINTER, yaml_part, name, 0, CYAML_UNLIMITED),
    CYAML_FIELD_STRING_PTR("mass_kg", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, yaml_part, mass_kg,
                           0, CYAML_UNLIMITED),
    CYAML_FIELD_END};
static const cyaml_schema_value_t PART_VALUE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, yaml_part, PART_FIELDS)};
static const cyaml_schema_field_t CAR_FIELDS[] = {
    CYAML_FIELD_STRING_PTR("car", CYAML_FLAG_POINTER, yaml_car, car, 0, CYAML_UNLIMITED),
    CYAML_FIELD_SEQUENCE("parts", CYAML_FLAG_POINTER, yaml_car, parts, &PART_VALUE, 0,
                         CYAML_UNLIMITED),
    CYAML_FIELD_END};
static const cyaml_schema_value_t CAR_VALUE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, yaml_car, CAR_FIELDS)};

static cp_status load_text(const char *text, cp_yaml_file *file, cp_error *error)
{
    char path[] = "/tmp/yaml_XXXXXX";
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, text, strlen(text)), (ssize_t)strlen(text));
    close(descriptor);
    cp_status status = cp_yaml_load(path, &CAR_VALUE, file, error);
    unlink(path);
    return status;
}

static const char TWO_PARTS[] = "# a car\n"
                                "car: one\n"
                                "parts:\n"
                                "  - name: engine\n"
                                "    mass_kg: 260\n"
                                "  - {name: wheel, mass_kg: 1.5garbage}\n";

static void every_key_path_has_its_line(void **state)
{
    (void)state;
    cp_yaml_file file;
    cp_error error = {0};
    assert_int_equal(load_text(TWO_PARTS, &file, &error), CP_OK);
    assert_int_equal(cp_yaml_line_of(&file, "car"), 2);
    assert_int_equal(cp_yaml_line_of(&file, "parts[0].mass_kg"), 5);
    assert_int_equal(cp_yaml_line_of(&file, "parts[1].name"), 6);
    // What is not there is as near as its parent.
    assert_int_equal(cp_yaml_line_of(&file, "parts[1].colour"), 6);
    const yaml_car *car = (const yaml_car *)file.data;
    assert_int_equal(car->parts_count, 2);
    assert_string_equal(car->parts[0].name, "engine");
    cp_yaml_close(&file);
}

static void numbers_are_whole_texts_in_range(void **state)
{
    (void)state;
    cp_yaml_file file;
    cp_error error = {0};
    assert_int_equal(load_text(TWO_PARTS, &file, &error), CP_OK);
    const yaml_car *car = (const yaml_car *)file.data;
    double mass_kg = -1.0;
    assert_int_equal(
        cp_yaml_number(&file, "parts[0].mass_kg", car->parts[0].mass_kg, 0, 1000, &mass_kg, &error),
        CP_OK);
    assert_near(mass_kg, 260.0, 0.0);
    assert_int_equal(
        cp_yaml_number(&file, "parts[0].mass_kg", car->parts[0].mass_kg, 0, 100, &mass_kg, &error),
        CP_BAD_INPUT);
    assert_non_null(
        strstr(error.text, ":5: parts[0].mass_kg must be between 0 and 100, found 260"));
    assert_int_equal(
        cp_yaml_number(&file, "parts[1].mass_kg", car->parts[1].mass_kg, 0, 100, &mass_kg, &error),
        CP_BAD_INPUT);
    assert_non_null(strstr(
        error.text, ":6: parts[1].mass_kg must be a number from 0 to 100, found '1.5garbage'"));
    assert_near(mass_kg, 260.0, 0.0);
    assert_int_equal(cp_yaml_number(&file, "x", NULL, 0, 1, &mass_kg, &error), CP_OK);
    cp_yaml_close(&file);
    double value;
    assert_false(cp_parse_number("nan", &value));
    assert_false(cp_parse_number("inf", &value));
    assert_false(cp_parse_number("", &value));
    assert_true(cp_parse_number("-1e-3", &value));
}

static void complaints_name_the_line_of_the_key(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        const char *words;
    } CASES[] = {
        {"", "the file is empty"},
        {"car: one\nparts: []\ncolour: red\n", ":3: Unexpected key: colour"},
        {"car: one\nparts: []\ncar: two\n", ":3: Mapping field already seen: car"},
        {"parts: []\n", "Missing required mapping field: car"},
        {"car: one\nparts:\n  - name: a\n    wheels: 4\n", ":4: Unexpected key: wheels"},
        {"car: [\n", ":"},
        {"crr: one\nparts: []\n", ":1: Unexpected key: crr; did you mean 'car'?"},
        {"car: one\nparts: []\ncolour: red\n", "colour; allowed are car, parts"},
        {"car: one\nparts: [engine]\n",
         ":2: parts[0] must be a mapping with the keys name, mass_kg; found the text 'engine'; for "
         "example {name: engine}"},
        {"car: one\nparts: engine\n",
         ":2: parts must be a list, found the text 'engine'; for example [{name: engine}]"},
        {"car: one\nparts: {name: engine}\n", ":2: parts must be a list ('- ' in front"},
        {"car: one\nparts:\n  - [name]\n", ":3: parts[0] must be a mapping, found a list"},
        {"car: [one]\nparts: []\n",
         ":1: car must be a text or a number, found a list or a mapping"},
    };
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        cp_yaml_file file;
        cp_error error = {0};
        assert_int_equal(load_text(CASES[k].text, &file, &error), CP_BAD_INPUT);
        if (strstr(error.text, CASES[k].words) == NULL)
            fail_msg("expected '%s' in: %s", CASES[k].words, error.text);
    }
    cp_yaml_file file;
    cp_error error = {0};
    assert_int_equal(cp_yaml_load("no_such_file.yaml", &CAR_VALUE, &file, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "no_such_file.yaml"));
}

// What libcyaml fills in and what stands in the list of lines must be the same.
static void aliases_fill_structure_and_lines_alike(void **state)
{
    (void)state;
    cp_yaml_file file;
    cp_error error = {0};
    assert_int_equal(load_text("car: &n one\n"
                               "parts:\n"
                               "  - &p {name: engine, mass_kg: &m 260}\n"
                               "  - *p\n"
                               "  - {name: *n, mass_kg: *m}\n",
                               &file, &error),
                     CP_OK);
    const yaml_car *car = (const yaml_car *)file.data;
    assert_int_equal(car->parts_count, 3);
    assert_string_equal(car->parts[1].name, "engine");
    assert_string_equal(car->parts[1].mass_kg, "260");
    assert_string_equal(car->parts[2].name, "one");
    assert_string_equal(car->parts[2].mass_kg, "260");
    assert_int_equal(cp_yaml_line_of(&file, "parts[1].mass_kg"), 3);
    cp_yaml_close(&file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_key_path_has_its_line),
        cmocka_unit_test(numbers_are_whole_texts_in_range),
        cmocka_unit_test(complaints_name_the_line_of_the_key),
        cmocka_unit_test(aliases_fill_structure_and_lines_alike),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
