/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/sumo_collisions.h"

#include "written_file.h"

#include <math.h>

static const char GOOD[] =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<!-- written by SUMO -->\n"
    "<collisions>\n"
    "    <collision time=\"20.55\" type=\"junction\" lane=\":c_2_0\" pos=\"14.3\" collider=\"t.0\" "
    "victim=\"l.0\" colliderType=\"car\" victimType=\"van\" colliderSpeed=\"13.9\" "
    "victimSpeed=\"9.7\"/>\n"
    "    <collision time=\"20.60\" type=\"frontal\" lane=\":c_2_0\" pos=\"15.0\" collider=\"l.0\" "
    "victim=\"t.0\" colliderType=\"van\" victimType=\"car\" colliderSpeed=\"13.9\" "
    "victimSpeed=\"9.7\"/>\n"
    "    <collision time=\"21.00\" type=\"sharedLane\" lane=\"x\" pos=\"1\" collider=\"t.1\" "
    "victim=\"ped0\" colliderType=\"car\" victimType=\"DEFAULT_PEDTYPE\" colliderSpeed=\"1\" "
    "victimSpeed=\"1\"/>\n"
    "    <collision time=\"31.00\" type=\"collision\" lane=\"x\" pos=\"1\" collider=\"t.0\" "
    "victim=\"&lt;2&gt;\" colliderType=\"car\" victimType=\"car\" colliderSpeed=\"1\" "
    "victimSpeed=\"1\"/>\n"
    "</collisions>\n";

static void a_pair_is_listed_once_at_its_first_report(void **unused)
{
    (void)unused;
    cp_collision_list list;
    cp_error error = {0};
    if (cp_sumo_collisions_read(write_file(GOOD), &list, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(list.count, 2);
    assert_int_equal(list.reports, 3);
    const cp_listed_collision *first = &list.collision[0];
    assert_int_equal(first->line, 4);
    assert_true(first->time_s == 20.55);
    assert_string_equal(first->id[0], "t.0");
    assert_string_equal(first->id[1], "l.0");
    assert_string_equal(first->type[1], "van");
    assert_string_equal(first->kind, "junction");
    assert_string_equal(list.collision[1].id[1], "<2>");
    cp_collision_list_destroy(&list);
}

static void a_vehicle_that_collides_with_itself_is_passed_over(void **unused)
{
    (void)unused;
    cp_collision_list list, without;
    cp_error error = {0};
    char *text = with(GOOD, "</collisions>",
                      "<collision time=\"30\" type=\"collision\" collider=\"train\" "
                      "victim=\"train\" colliderType=\"x\" victimType=\"x\"/>\n</collisions>");
    assert_int_equal(cp_sumo_collisions_read(write_file(GOOD), &without, &error), CP_OK);
    assert_int_equal(cp_sumo_collisions_read(write_file(text), &list, &error), CP_OK);
    assert_int_equal(list.count, without.count);
    assert_int_equal(list.with_themselves, 1);
    assert_int_equal(without.with_themselves, 0);
    cp_collision_list_destroy(&list);
    cp_collision_list_destroy(&without);
    free(text);
}

static void times_may_be_clock_times(void **unused)
{
    (void)unused;
    cp_collision_list list;
    cp_error error = {0};
    char *text = with(GOOD, "time=\"20.55\"", "time=\"1:02:03:20.55\"");
    assert_int_equal(cp_sumo_collisions_read(write_file(text), &list, &error), CP_OK);
    assert_true(fabs(list.collision[0].time_s - (86400 + 2 * 3600 + 3 * 60 + 20.55)) < 1e-9);
    cp_collision_list_destroy(&list);
    free(text);
    static const char *const BAD[] = {"1:", ":1", "0:0:0:0:1", "1:-2:3", "00:00:21x"};
    for (size_t k = 0; k < sizeof BAD / sizeof *BAD; k++) {
        char time[64];
        snprintf(time, sizeof time, "time=\"%s\"", BAD[k]);
        text = with(GOOD, "time=\"20.55\"", time);
        assert_int_equal(cp_sumo_collisions_read(write_file(text), &list, &error), CP_BAD_INPUT);
        assert_non_null(strstr(error.text, "file:4: time of <collision> must be a time in s or"));
        free(text);
    }
}

static void bad_files_are_told_by_line(void **unused)
{
    (void)unused;
    static const struct {
        const char *old, *replacement, *message;
    } BAD[] = {
        {"time=\"20.55\"", "time=\"now\"",
         "file:4: time of <collision> must be a number, found 'now'"},
        {"time=\"20.55\"", "time=\"nan\"", "file:4: time of <collision> must be a number"},
        {"time=\"20.55\"", "", "file:4: <collision> must have the attribute time, found none"},
        {"victim=\"l.0\"", "", "file:4: <collision> must have the attribute victim"},
        {"<collisions>", "<fcd-export>", "file:3: must be <collisions>, found <fcd-export>"},
        {"</collisions>\n", "", "is not XML: no element found"},
        {"type=\"junction\"", "type=junction", "file:4: is not XML"},
    };
    for (size_t k = 0; k < sizeof BAD / sizeof *BAD; k++) {
        cp_collision_list list;
        cp_error error = {0};
        char *text = with(GOOD, BAD[k].old, BAD[k].replacement);
        assert_int_equal(cp_sumo_collisions_read(write_file(text), &list, &error), CP_BAD_INPUT);
        if (strstr(error.text, BAD[k].message) == NULL)
            fail_msg("'%s' does not hold '%s'", error.text, BAD[k].message);
        assert_null(list.collision);
        free(text);
    }
    cp_collision_list list;
    cp_error error = {0};
    assert_int_equal(cp_sumo_collisions_read("nowhere.xml", &list, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "nowhere.xml: cannot be read: No such file"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pair_is_listed_once_at_its_first_report),
        cmocka_unit_test(a_vehicle_that_collides_with_itself_is_passed_over),
        cmocka_unit_test(times_may_be_clock_times),
        cmocka_unit_test(bad_files_are_told_by_line),
    };
    return cmocka_run_group_tests(tests, written_begin, written_end);
}
