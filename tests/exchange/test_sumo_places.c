/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/sumo_places.h"

#include "written_file.h"

#include <math.h>

#define ROW(time, front, back)                                                                     \
    "<collision time=\"" time "\" type=\"junction\" collider=\"a\" victim=\"b\" "                  \
    "colliderType=\"car\" victimType=\"car\" colliderSpeed=\"12\" victimSpeed=\"7\" "              \
    "colliderFront=\"" front "\" colliderBack=\"" back "\" victimFront=\"12,0\" "                  \
    "victimBack=\"16.5,0\"/>\n"

static const char REPORTS[] = "<collisions>\n" ROW("1.00", "10,1", "10,-3.5")
    ROW("1.25", "10,2", "10,-2.5") "</collisions>\n";

static void reports_alone_are_a_record(void **unused)
{
    (void)unused;
    cp_collision_list list;
    cp_fcd_record record;
    cp_error error = {0};
    assert_int_equal(cp_sumo_collisions_read(write_file(REPORTS), &list, &error), CP_OK);
    if (cp_sumo_places_record("file", &list, &record, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_true(record.of_places && record.step_length_s == 0.25 && record.vehicle_km == 0.0);
    const cp_fcd_track *a = &record.track[0][0], *b = &record.track[0][1];
    assert_true(a->count == 2 && b->count == 2);
    assert_true(a->sample[1].front_m.y == 2.0 && a->sample[1].speed_m_s == 12.0);
    assert_true(a->sample[1].lane == CP_FCD_NO_LANE);
    assert_true(fabs(a->sample[0].yaw_rad - acos(0.0)) < 1e-12);             // north
    assert_true(fabs(fabs(b->sample[0].yaw_rad) - 2.0 * acos(0.0)) < 1e-12); // west
    cp_fcd_record_destroy(&record);
    cp_collision_list_destroy(&list);
}

static void what_is_missing_is_told(void **unused)
{
    (void)unused;
    static const struct {
        const char *old, *replacement, *message;
    } BAD[] = {
        {"colliderFront=\"10,1\" colliderBack=\"10,-3.5\" victimFront=\"12,0\" "
         "victimBack=\"16.5,0\"",
         "", "file:2: without --fcd every <collision> must have colliderFront"},
        {"victimType=\"car\"", "", "file:2: without --fcd <collision> must have colliderType"},
    };
    for (size_t k = 0; k < sizeof BAD / sizeof *BAD; k++) {
        cp_collision_list list;
        cp_fcd_record record;
        cp_error error = {0};
        char *text = with(REPORTS, BAD[k].old, BAD[k].replacement);
        assert_int_equal(cp_sumo_collisions_read(write_file(text), &list, &error), CP_OK);
        assert_int_equal(cp_sumo_places_record("file", &list, &record, &error), CP_BAD_INPUT);
        if (strstr(error.text, BAD[k].message) == NULL)
            fail_msg("'%s' does not hold '%s'", error.text, BAD[k].message);
        cp_collision_list_destroy(&list);
        free(text);
    }
}

// What the record has of the step of a report, in which SUMO had put a elsewhere, is replaced; the
// step that is missing is put in between.
static void reports_go_before_the_record(void **unused)
{
    (void)unused;
    static cp_fcd_sample samples[] = {
        {.time_s = 0.75, .front_m = {10, -1}, .speed_m_s = 8},
        {.time_s = 1.0, .front_m = {90, 0}, .speed_m_s = 8, .lane = 3},
        {.time_s = 1.5, .front_m = {91, 0}, .speed_m_s = 8}};
    cp_collision_list list;
    cp_error error = {0};
    assert_int_equal(cp_sumo_collisions_read(write_file(REPORTS), &list, &error), CP_OK);
    cp_fcd_record record = {.step_length_s = 0.25, .collision_count = 1};
    record.track = calloc(1, sizeof *record.track);
    assert_non_null(record.track);
    for (size_t k = 0; k < 3; k++)
        assert_int_equal(cp_fcd_track_append(&record.track[0][0], samples[k], &error), CP_OK);
    assert_int_equal(cp_sumo_places_add(&list, &record, &error), CP_OK);
    const cp_fcd_track *a = &record.track[0][0];
    assert_int_equal(a->count, 4);
    assert_true(a->sample[1].lane == 3 && a->sample[2].lane == CP_FCD_NO_LANE);
    const double time_s[] = {0.75, 1.0, 1.25, 1.5}, x_m[] = {10, 10, 10, 91};
    for (size_t k = 0; k < 4; k++)
        assert_true(a->sample[k].time_s == time_s[k] && a->sample[k].front_m.x == x_m[k]);
    assert_int_equal(record.track[0][1].count, 2);
    cp_fcd_record_destroy(&record);
    cp_collision_list_destroy(&list);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reports_alone_are_a_record),
        cmocka_unit_test(what_is_missing_is_told),
        cmocka_unit_test(reports_go_before_the_record),
    };
    return cmocka_run_group_tests(tests, written_begin, written_end);
}
