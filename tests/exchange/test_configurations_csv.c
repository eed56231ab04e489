/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/configurations_csv.h"

#include "core/units.h"

#include "written_file.h"

static const char RELATIVE[] = "# cases\n"
                               "angle_deg, id, speed_a_km_h, speed_b_km_h, offset_mm, vehicle_b\r\n"
                               "10, first, 50, 36, -300, van.yaml\r\n"
                               "\n"
                               "0, second, 36, 0, 0,\r\n";
static const char POSES[] = "x_a_m,y_a_m,heading_a_deg,speed_a_km_h,x_b_m,y_b_m,heading_b_deg,"
                            "speed_b_km_h,yaw_rate_b_deg_s\n"
                            "1,2,90,36,3,4,-90,72,45\n";

static void reads_both_kinds(void **unused)
{
    (void)unused;
    cp_configuration_list list;
    cp_error error = {0};
    if (cp_configurations_csv_read(write_file(RELATIVE), true, &list, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(list.count, 2);
    assert_false(list.has_poses);
    assert_string_equal(list.row[0].id, "first");
    assert_string_equal(list.row[0].vehicle[1], "van.yaml");
    assert_null(list.row[0].vehicle[0]);
    assert_null(list.row[1].vehicle[1]);
    assert_true(list.row[0].speed_m_s[1] == 10.0 && list.row[0].offset_m == -0.3);
    assert_true(list.row[0].angle_rad == cp_rad_from_deg(10.0));
    assert_int_equal(list.row[1].line, 5);
    cp_configuration_list_destroy(&list);

    if (cp_configurations_csv_read(write_file(POSES), true, &list, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_true(list.has_poses);
    assert_string_equal(list.row[0].id, "1");
    assert_true(list.row[0].pose[1].position_m.x == 3.0 && list.row[0].pose[0].position_m.y == 2.0);
    assert_true(list.row[0].pose[1].yaw_rad == cp_rad_from_deg(-90.0));
    assert_true(list.row[0].yaw_rate_rad_s[0] == 0.0);
    assert_true(list.row[0].yaw_rate_rad_s[1] == cp_rad_from_deg(45.0));
    cp_configuration_list_destroy(&list);
}

static void bad_lists_are_told_by_line_and_column(void **unused)
{
    (void)unused;
    static const struct {
        const char *text, *old, *replacement, *message;
    } BAD[] = {
        {RELATIVE, "50", "fast", "file:3: speed_a_km_h must be a number, found 'fast'"},
        {RELATIVE, "50", "inf", "file:3: speed_a_km_h must be a number, found 'inf'"},
        {RELATIVE, "50", "-50", "file:3: speed_a_km_h must be between 0 and 400, found -50"},
        {RELATIVE, "36, 0, 0,", "0, 0, 0,", "file:5: speed_a_km_h or speed_b_km_h must be > 0"},
        {RELATIVE, "second", "first", "file:5: id 'first' is given twice"},
        {RELATIVE, "0, second", "second", "file:5: must have 6 fields, found 5"},
        {RELATIVE, "offset_mm", "offset_m", "file:2: unknown column 'offset_m'; there are id, "},
        {RELATIVE, "offset_mm", "angle_deg", "file:2: the column angle_deg is given twice"},
        {RELATIVE, ", offset_mm", "", "file:2: the column offset_mm is missing"},
        {RELATIVE, "offset_mm", "x_a_m", "file:2: must give either offset_mm and angle_deg or"},
        {POSES, "heading_b_deg", "id", "file:1: the column heading_b_deg is missing"},
        {POSES, "1,2,90,36,3,4,-90,72,45\n", "", "and at least one configuration, found none"},
    };
    for (size_t k = 0; k < sizeof BAD / sizeof *BAD; k++) {
        cp_configuration_list list;
        cp_error error = {0};
        char *text = with(BAD[k].text, BAD[k].old, BAD[k].replacement);
        assert_int_equal(cp_configurations_csv_read(write_file(text), true, &list, &error),
                         CP_BAD_INPUT);
        if (strstr(error.text, BAD[k].message) == NULL)
            fail_msg("'%s' does not hold '%s'", error.text, BAD[k].message);
        assert_null(list.row);
        free(text);
    }
}

// Lists as spreadsheets write them, read as the same list.
static void forms_of_spreadsheets_are_read(void **unused)
{
    (void)unused;
    static const char *const FORM[] = {
        "id,speed_a_km_h,speed_b_km_h,offset_mm,angle_deg\none,50,36,-300.5,10\n",
        "\xef\xbb\xbfid,speed_a_km_h,speed_b_km_h,offset_mm,angle_deg\r\none,50,36,-300.5,10\r\n",
        "id;speed_a_km_h;speed_b_km_h;offset_mm;angle_deg\none;50;36;-300.5;10\n",
        "\"id\",\"speed_a_km_h\",\"speed_b_km_h\",\"offset_mm\",\"angle_deg\"\n\"one\",50,36,-300."
        "5,10",
        "\xef\xbb\xbf\"id\";\"speed_a_km_h\" ; speed_b_km_h;offset_mm;angle_deg\r\none; 50;36 "
        ";-300.5;10",
    };
    for (size_t k = 0; k < sizeof FORM / sizeof *FORM; k++) {
        cp_configuration_list list;
        cp_error error = {0};
        if (cp_configurations_csv_read(write_file(FORM[k]), true, &list, &error) != CP_OK)
            fail_msg("form %zu: %s", k, error.text);
        assert_int_equal(list.count, 1);
        assert_string_equal(list.row[0].id, "one");
        assert_true(list.row[0].speed_m_s[0] == cp_m_s_from_km_h(50.0));
        assert_true(list.row[0].offset_m == -0.3005);
        assert_true(list.row[0].angle_rad == cp_rad_from_deg(10.0));
        cp_configuration_list_destroy(&list);
    }
    // A decimal comma is no point: never another number without a word.
    static const char *const COMMA[] = {
        "id;speed_a_km_h;speed_b_km_h;offset_mm;angle_deg\none;50;36;-300,5;10\n",
        "id,speed_a_km_h,speed_b_km_h,offset_mm,angle_deg\none,50,36,-300,5,10\n"};
    for (size_t k = 0; k < 2; k++) {
        cp_configuration_list list;
        cp_error error = {0};
        assert_int_equal(cp_configurations_csv_read(write_file(COMMA[k]), true, &list, &error),
                         CP_BAD_INPUT);
        assert_non_null(strstr(error.text, k == 0 ? "offset_mm must be a number, found '-300,5'"
                                                  : "must have 5 fields, found 6"));
    }
}

static void bad_rows_are_left_out(void **unused)
{
    (void)unused;
    static const char LIST[] = "id,speed_a_km_h,speed_b_km_h,offset_mm,angle_deg\n"
                               "one,50,36,0,0\ntwo,fast,36,0,0\none,50,36,0,0\nfour,50,36,0,0\n"
                               "five,50,36\n";
    cp_configuration_list list;
    cp_error error = {0};
    assert_int_equal(cp_configurations_csv_read(write_file(LIST), false, &list, &error), CP_OK);
    assert_int_equal(list.count, 2);
    assert_string_equal(list.row[1].id, "four");
    assert_int_equal(list.bad_count, 3);
    assert_non_null(strstr(list.bad[0], "file:3: speed_a_km_h must be a number, found 'fast'"));
    assert_non_null(strstr(list.bad[1], "file:4: id 'one' is given twice"));
    assert_non_null(strstr(list.bad[2], "file:6: must have 5 fields, found 3"));
    cp_configuration_list_destroy(&list);

    // Not one is right: the first says why.
    static const char NONE[] = "id,speed_a_km_h,speed_b_km_h,offset_mm,angle_deg\n"
                               "two,fast,36,0,0\nthree,50,fast,0,0\n";
    assert_int_equal(cp_configurations_csv_read(write_file(NONE), false, &list, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "file:2: speed_a_km_h"));
    assert_null(list.bad);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_both_kinds),
        cmocka_unit_test(forms_of_spreadsheets_are_read),
        cmocka_unit_test(bad_rows_are_left_out),
        cmocka_unit_test(bad_lists_are_told_by_line_and_column),
    };
    return cmocka_run_group_tests(tests, written_begin, written_end);
}
