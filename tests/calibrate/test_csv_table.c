/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "suite_text.h"

#include "core/csv_table.h"

static cp_status load(const char *text, cp_csv_table *table, cp_error *error)
{
    char path[32];
    suite_text_write(text, path);
    cp_status status = cp_csv_table_load(path, table, error);
    unlink(path);
    return status;
}

static void comments_and_blank_lines_do_not_count(void **state)
{
    (void)state;
    cp_csv_table table;
    cp_error error = {0};
    assert_int_equal(
        load("# source: a, b\nname,mass_kg\r\n\nvan,2000\r\n# half way\ncar,\n", &table, &error),
        CP_OK);
    assert_int_equal(table.row_count, 2);
    const char *name = NULL;
    double mass_kg = 0.0;
    assert_int_equal(cp_csv_table_text(&table, 1, "name", &name, &error), CP_OK);
    assert_string_equal(name, "car");
    assert_int_equal(cp_csv_table_number(&table, 0, "mass_kg", 0, 5000, false, &mass_kg, &error),
                     CP_OK);
    assert_near(mass_kg, 2000.0, 0.0);
    assert_int_equal(cp_csv_table_number(&table, 1, "mass_kg", 0, 5000, true, &mass_kg, &error),
                     CP_OK);
    assert_true(isnan(mass_kg));
    cp_csv_table_destroy(&table);
}

static void forms_of_spreadsheets_are_read(void **state)
{
    (void)state;
    static const char *const FORM[] = {"\xef\xbb\xbfname,mass_kg\r\nvan,2000.5\r\n",
                                       "name;mass_kg\nvan;2000.5\n",
                                       "\"name\",\"mass_kg\"\n\"van\",2000.5\n"};
    for (size_t k = 0; k < sizeof FORM / sizeof *FORM; k++) {
        cp_csv_table table;
        cp_error error = {0};
        const char *name = NULL;
        double mass_kg = 0.0;
        assert_int_equal(load(FORM[k], &table, &error), CP_OK);
        assert_int_equal(cp_csv_table_text(&table, 0, "name", &name, &error), CP_OK);
        assert_string_equal(name, "van");
        assert_int_equal(
            cp_csv_table_number(&table, 0, "mass_kg", 0, 5000, false, &mass_kg, &error), CP_OK);
        assert_near(mass_kg, 2000.5, 0.0);
        cp_csv_table_destroy(&table);
    }
}

static void errors_name_line_and_column(void **state)
{
    (void)state;
    cp_csv_table table;
    cp_error error = {0};
    double mass_kg = 0.0;
    const char *name = NULL;
    assert_int_equal(load("# one\nname,mass_kg\nvan,2000\ncar,heavy\n", &table, &error), CP_OK);
    assert_int_equal(cp_csv_table_number(&table, 1, "mass_kg", 0, 5000, false, &mass_kg, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, ":4: mass_kg must be a number between 0 and 5000, found "
                                       "'heavy'"));
    assert_int_equal(cp_csv_table_number(&table, 0, "mass_kg", 0, 1999, false, &mass_kg, &error),
                     CP_BAD_INPUT);
    assert_int_equal(cp_csv_table_text(&table, 0, "width_m", &name, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "column width_m is missing"));
    cp_csv_table_destroy(&table);

    assert_int_equal(load("name,mass_kg\nvan\n", &table, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, ":2: 1 fields, but the header has 2"));
    cp_csv_table_destroy(&table);
    assert_int_equal(load("name,mass_kg\n", &table, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "no row"));
    cp_csv_table_destroy(&table);
    assert_int_equal(load("a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,v,w,x,y,z,1,2,3,4,5,6,7\n"
                          ",,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,\n",
                          &table, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, ":1: must have at most 32 columns, found 33"));
    cp_csv_table_destroy(&table);
    assert_int_equal(cp_csv_table_load("/nowhere/table.csv", &table, &error), CP_BAD_INPUT);
    cp_csv_table_destroy(&table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(comments_and_blank_lines_do_not_count),
        cmocka_unit_test(forms_of_spreadsheets_are_read),
        cmocka_unit_test(errors_name_line_and_column),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
