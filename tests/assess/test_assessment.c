/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "assess/assessment.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "exchange/written_file.h"

#include "core/units.h"

#include <math.h>
#include <string.h>

static cp_status assess(const char *list, bool strict, cp_assessment *assessment, cp_error *error)
{
    const cp_assessment_request request = {.configurations_path = write_file(list),
                                           .vehicle = "mid_size",
                                           .name = "a test",
                                           .strict = strict};
    return cp_assessment_make(&request, assessment, error);
}

static cp_assessment assessed(const char *list)
{
    cp_assessment assessment;
    cp_error error = {0};
    if (assess(list, false, &assessment, &error) != CP_OK)
        fail_msg("%s", error.text);
    return assessment;
}

// Two equal cars as fast as each other: each loses and gains alike, and a mirrored place changes
// nothing but the side.
static void equal_cars_are_alike_and_sides_mirrored(void **state)
{
    (void)state;
    cp_assessment a = assessed("id,speed_a_km_h,speed_b_km_h,offset_mm,angle_deg\n"
                               "even,50,50,0,0\n"
                               "left,50,50,600,0\n"
                               "right,50,50,-600,0\n");
    assert_int_equal(a.count.listed, 3);
    assert_int_equal(a.count.crashes, 3);
    assert_int_equal(a.results.crash_count, 3);
    const cp_crash_row *even = &a.results.crash[0];
    assert_string_equal(even->vehicle[0].sumo_id, "even.a");
    assert_near(even->description.closing_speed_m_s, cp_m_s_from_km_h(100.0), 1e-9);
    assert_near(even->vehicle[0].severity.delta_v_m_s, even->vehicle[1].severity.delta_v_m_s, 1e-9);
    // At least the speed each car had: it is stopped, and thrown back a little.
    assert_true(even->vehicle[0].severity.delta_v_m_s > cp_m_s_from_km_h(50.0));
    assert_true(even->vehicle[0].severity.delta_v_m_s < 1.3 * cp_m_s_from_km_h(50.0));
    const cp_crash_row *left = &a.results.crash[1], *right = &a.results.crash[2];
    for (int role = 0; role < 2; role++) {
        assert_near(left->vehicle[role].severity.delta_v_m_s,
                    right->vehicle[role].severity.delta_v_m_s, 1e-6);
        assert_near(left->vehicle[role].severity.delta_v_y_m_s,
                    -right->vehicle[role].severity.delta_v_y_m_s, 1e-6);
        // No database is asked for: no pulse is kept.
        assert_null(left->vehicle[role].pulse);
    }
    cp_assessment_destroy(&a);
}

// Where two cars are before they meet says as much as offset and angle do.
static void poses_say_what_descriptions_say(void **state)
{
    (void)state;
    cp_assessment a = assessed("speed_a_km_h,speed_b_km_h,offset_mm,angle_deg\n40,60,0,0\n");
    cp_assessment b = assessed("x_a_m,y_a_m,heading_a_deg,speed_a_km_h,x_b_m,y_b_m,heading_b_deg,"
                               "speed_b_km_h\n0,0,0,40,12,0,180,60\n");
    assert_int_equal(b.count.crashes, 1);
    const cp_crash_row *one = &a.results.crash[0], *other = &b.results.crash[0];
    assert_near(other->description.closing_speed_m_s, one->description.closing_speed_m_s, 1e-9);
    assert_near(other->description.lateral_offset_m, 0.0, 1e-9);
    assert_near(other->description.angle_rad, 0.0, 1e-9);
    for (int role = 0; role < 2; role++)
        assert_near(other->vehicle[role].severity.delta_v_m_s,
                    one->vehicle[role].severity.delta_v_m_s, 0.02);
    cp_assessment_destroy(&a);
    cp_assessment_destroy(&b);
}

// Cars that pass each other are a bad row: left out and counted, or the end where strict.
static void a_bad_row_is_left_out_or_the_end(void **state)
{
    (void)state;
    static const char LIST[] = "x_a_m,y_a_m,heading_a_deg,speed_a_km_h,x_b_m,y_b_m,heading_b_deg,"
                               "speed_b_km_h\n"
                               "0,0,0,40,12,6,180,60\n"
                               "0,0,0,40,12,0,180,60\n";
    cp_assessment a = assessed(LIST);
    assert_int_equal(a.count.bad, 1);
    assert_int_equal(a.count.crashes, 1);
    assert_string_equal(a.results.crash[0].vehicle[1].sumo_id, "2.b");
    cp_assessment_destroy(&a);
    cp_error error = {0};
    assert_int_equal(assess(LIST, true, &a, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, ":2: the two must meet"));
    cp_assessment_destroy(&a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_cars_are_alike_and_sides_mirrored),
        cmocka_unit_test(poses_say_what_descriptions_say),
        cmocka_unit_test(a_bad_row_is_left_out_or_the_end),
    };
    return cmocka_run_group_tests(tests, written_begin, written_end);
}
