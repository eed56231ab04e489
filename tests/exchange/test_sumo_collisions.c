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
    assert_true(fabs(list.step_s - 0.05) < 1e-12);
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

// As SUMO 1.24 writes them; the second report names the two the other way round.
static void places_of_later_versions(void **unused)
{
    (void)unused;
    cp_collision_list list;
    cp_error error = {0};
    char *one = with(GOOD, "pos=\"14.3\"",
                     "colliderFront=\"10.00,2.00\" colliderBack=\"5.50,2.00\" "
                     "victimFront=\"11.00,3.50,0.20\" victimBack=\"15.00,3.50,0.20\"");
    char *text = with(one, "pos=\"15.0\"",
                      "colliderFront=\"10.50,3.5\" colliderBack=\"14.5,3.5\" "
                      "victimFront=\"10.7,2\" victimBack=\"6.2,2\"");
    if (cp_sumo_collisions_read(write_file(text), &list, &error) != CP_OK)
        fail_msg("%s", error.text);
    const cp_listed_collision *first = &list.collision[0];
    assert_int_equal(list.without_places, 1); /* the last one */
    assert_int_equal(first->places_count, 2);
    assert_int_equal(list.collision[1].places_count, 0);
    assert_true(first->speed_m_s[0] == 13.9 && first->speed_m_s[1] == 9.7);
    assert_true(first->places[0].front_m[0].x == 10.0 && first->places[0].back_m[1].x == 15.0);
    assert_true(first->places[1].front_m[0].x == 10.7 && first->places[1].back_m[0].x == 6.2);
    assert_true(first->places[1].front_m[1].y == 3.5 && first->places[1].speed_m_s[0] == 9.7);
    cp_collision_list_destroy(&list);
    free(text);
    free(one);

    // Types are older than the rest of a row, and not everywhere.
    text = with(GOOD, "colliderType=\"car\" victimType=\"van\"", "");
    assert_int_equal(cp_sumo_collisions_read(write_file(text), &list, &error), CP_OK);
    assert_true(list.collision[0].type[0] == NULL && list.collision[0].type[1] == NULL);
    cp_collision_list_destroy(&list);
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
        {"colliderSpeed=\"13.9\"", "colliderSpeed=\"fast\"",
         "file:4: colliderSpeed of <collision> must be a number, found 'fast'"},
        {"pos=\"14.3\"", "colliderFront=\"1;2\"",
         "file:4: colliderFront of <collision> must be x,y in m, found '1;2'"},
        {"pos=\"14.3\"", "victimBack=\"1\"",
         "file:4: victimBack of <collision> must be x,y in m, found '1'"},
        {"pos=\"14.3\"", "victimBack=\"1,nan\"", "must be x,y in m, found '1,nan'"},
        {"pos=\"14.3\"", "victimBack=\"1,2\"",
         "file:4: <collision> must have all of colliderFront, colliderBack"},
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
        cmocka_unit_test(places_of_later_versions),
        cmocka_unit_test(a_vehicle_that_collides_with_itself_is_passed_over),
        cmocka_unit_test(times_may_be_clock_times),
        cmocka_unit_test(bad_files_are_told_by_line),
    };
    return cmocka_run_group_tests(tests, written_begin, written_end);
}
