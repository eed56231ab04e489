/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "calibrate/reference.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static cp_status load_text(const char *text, cp_reference *reference, cp_error *error)
{
    char path[] = "/tmp/reference_XXXXXX";
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, text, strlen(text)), (ssize_t)strlen(text));
    close(descriptor);
    cp_status status = cp_reference_load(path, reference, error);
    unlink(path);
    return status;
}

static void columns_are_found_by_name(void **state)
{
    (void)state;
    cp_reference reference;
    cp_error error = {0};
    assert_int_equal(
        load_text("note,olc_g,angle_deg,offset_mm,speed_kmh\r\nx,12.5,10,-350,45\r\n\n", &reference,
                  &error),
        CP_OK);
    assert_int_equal(reference.count, 1);
    assert_near(reference.cases[0].speed_km_h, 45.0, 0.0);
    assert_near(reference.cases[0].offset_mm, -350.0, 0.0);
    assert_near(reference.cases[0].angle_deg, 10.0, 0.0);
    assert_near(reference.cases[0].olc_g, 12.5, 0.0);
    cp_reference_destroy(&reference);
}

static void errors_name_line_and_column(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        const char *words;
    } CASES[] = {
        {"speed_kmh,offset_mm,angle_deg\n1,2,3\n", ":1: column olc_fe_g is missing"},
        {"speed_kmh,offset_mm,angle_deg,olc_g\n56,0,0,fast\n",
         ":2: olc_fe_g must be a number between 0 and 200, found 'fast'"},
        {"speed_kmh,offset_mm,angle_deg,olc_g\n56,0,0,5\n-56,0,0,5\n", ":3: speed_kmh"},
        {"speed_kmh,offset_mm,angle_deg,olc_g\n56,0,0\n", ":2: must have a field for each"},
        {"speed_kmh,offset_mm,angle_deg,olc_g\n56,0,0,23,9\n", "found 5 (is the decimal sign"},
        {"speed_kmh,offset_mm,angle_deg,olc_g\n56,0,0,0x10\n", "found '0x10'"},
        {"speed_kmh,offset_mm,angle_deg,olc_g,olc_fe_g\n56,0,0,9,8\n", "is given twice"},
        {"speed_kmh,offset_mm,angle_deg,olc_g\n", "no configuration"},
    };
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        cp_reference reference;
        cp_error error = {0};
        assert_int_equal(load_text(CASES[k].text, &reference, &error), CP_BAD_INPUT);
        if (strstr(error.text, CASES[k].words) == NULL)
            fail_msg("expected '%s' in: %s", CASES[k].words, error.text);
    }
}

static void the_table_of_the_paper_has_96_rows(void **state)
{
    (void)state;
    char path[4096];
    snprintf(path, sizeof path, "%s/db/reference/olc_accord_2014.csv", getenv("CRASHPULSE_SOURCE"));
    cp_reference reference;
    cp_error error = {0};
    if (cp_reference_load(path, &reference, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(reference.count, 96);
    double sum_g = 0.0;
    for (size_t k = 0; k < reference.count; k++)
        sum_g += reference.cases[k].olc_g;
    assert_near(reference.cases[95].olc_g, 21.39, 1e-12);
    assert_true(sum_g > 1000.0 && sum_g < 2000.0);
    cp_reference_destroy(&reference);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_are_found_by_name),
        cmocka_unit_test(errors_name_line_and_column),
        cmocka_unit_test(the_table_of_the_paper_has_96_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
