/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/sumo_fcd.h"

#include "core/units.h"
#include "exchange/sumo_types.h"

#include "written_file.h"

#include <math.h>

static cp_listed_collision listed[1] = {
    {.time_s = 0.3, .id = {"a", "b"}, .type = {"car", "car"}, .kind = "junction"}};
static const cp_collision_list LIST = {.collision = listed, .count = 1};

static const char GOOD[] =
    "<fcd-export>\n"
    "  <timestep time=\"0.10\"/>\n"
    "  <timestep time=\"0.20\">\n"
    "    <vehicle id=\"a\" x=\"1\" y=\"2\" angle=\"90\" speed=\"10\" pos=\"3\" lane=\"e_0\"/>\n"
    "    <vehicle id=\"c\" x=\"1\" y=\"2\" angle=\"90\" speed=\"10\"/>\n"
    "  </timestep>\n"
    "  <timestep time=\"0.30\">\n"
    "    <vehicle id=\"a\" x=\"2\" y=\"2\" angle=\"0\" speed=\"10\" pos=\"4\"/>\n"
    "    <vehicle id=\"b\" x=\"9\" y=\"2\" angle=\"270\" speed=\"5\"/>\n"
    "    <person id=\"p\" x=\"0\" y=\"0\"/>\n"
    "  </timestep>\n"
    "  <timestep time=\"0.40\">\n"
    "    <vehicle id=\"b\" x=\"8.5\" y=\"2\" angle=\"270\" speed=\"5\"/>\n"
    "  </timestep>\n"
    "</fcd-export>\n";

static void tracks_and_exposure(void **unused)
{
    (void)unused;
    cp_fcd_record record;
    cp_error error = {0};
    if (cp_sumo_fcd_read(write_file(GOOD), &LIST, 1.0, 0.05, &record, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_true(fabs(record.step_length_s - 0.1) < 1e-12);
    assert_true(fabs(record.simulated_s - 0.3) < 1e-12);
    assert_int_equal(record.departed, 3);
    assert_true(fabs(record.vehicle_km - 0.1 * 40.0 / 1000.0) < 1e-12);
    assert_true(fabs(record.vehicle_h - 0.1 * 5.0 / 3600.0) < 1e-12);

    // North is pi / 2, west pi; b's last sample is later than was asked for.
    const cp_fcd_track *a = &record.track[0][0], *b = &record.track[0][1];
    assert_int_equal(a->count, 2);
    assert_int_equal(b->count, 1);
    assert_true(a->sample[0].yaw_rad == 0.0 && a->sample[0].front_m.x == 1.0);
    assert_true(a->sample[1].yaw_rad == cp_rad_from_deg(90.0) && a->sample[1].time_s == 0.3);
    assert_true(a->sample[1].lane_position_m == 4.0);
    assert_string_equal(record.lanes[a->sample[0].lane], "e_0");
    assert_true(record.lane_count == 1);
    assert_true(b->sample[0].yaw_rad == cp_rad_from_deg(180.0) && b->sample[0].speed_m_s == 5.0);
    assert_true(isnan(b->sample[0].lane_position_m));
    assert_true(b->sample[0].lane == CP_FCD_NO_LANE);
    cp_fcd_record_destroy(&record);
}

static void bad_files_are_told_by_line(void **unused)
{
    (void)unused;
    static const struct {
        const char *old, *replacement, *message;
    } BAD[] = {
        {"angle=\"90\"", "angle=\"east\"",
         "file:4: angle of <vehicle> must be a number, found 'east'"},
        {"x=\"1\"", "", "file:4: <vehicle> must have the attribute x"},
        {"speed=\"10\"", "speed=\"1e9\"", "file:4: speed of <vehicle> must be between"},
        {"time=\"0.30\"", "time=\"0.15\"",
         "file:7: time of <timestep> must rise, found 0.15 after 0.2"},
        {"time=\"0.40\"", "time=\"0.56\"",
         "file:12: <timestep> must follow the one before after 0.1 s"},
        {"<fcd-export>", "<fcd>", "file:1: must be <fcd-export>, found <fcd>"},
    };
    for (size_t k = 0; k < sizeof BAD / sizeof *BAD; k++) {
        cp_fcd_record record;
        cp_error error = {0};
        char *text = with(GOOD, BAD[k].old, BAD[k].replacement);
        assert_int_equal(cp_sumo_fcd_read(write_file(text), &LIST, 1.0, 1.0, &record, &error),
                         CP_BAD_INPUT);
        if (strstr(error.text, BAD[k].message) == NULL)
            fail_msg("'%s' does not hold '%s'", error.text, BAD[k].message);
        assert_null(record.track);
        free(text);
    }
}

// Steps without vehicles may be missing; the mean step is that of all.
static void gaps_of_whole_steps_are_gaps(void **unused)
{
    (void)unused;
    cp_fcd_record record;
    cp_error error = {0};
    char *text = with(GOOD, "time=\"0.40\"", "time=\"0.60\"");
    assert_int_equal(cp_sumo_fcd_read(write_file(text), &LIST, 1.0, 1.0, &record, &error), CP_OK);
    assert_true(fabs(record.step_length_s - 0.1) < 1e-12);
    assert_true(fabs(record.vehicle_h - 0.1 * 5.0 / 3600.0) < 1e-12);
    cp_fcd_record_destroy(&record);
    free(text);
}

// A pair that is reported for long is looked at all the time.
static void the_record_reaches_to_the_last_report(void **unused)
{
    (void)unused;
    cp_listed_collision one = listed[0];
    one.last_s = one.time_s;
    for (int later = 0; later < 2; later++) {
        one.last_s = one.time_s + (later ? 5.0 : 0.0);
        cp_collision_list list = {.collision = &one, .count = 1};
        cp_fcd_record record;
        cp_error error = {0};
        assert_int_equal(cp_sumo_fcd_read(write_file(GOOD), &list, 1.0, 0.05, &record, &error),
                         CP_OK);
        assert_int_equal(record.track[0][1].count, later ? 2 : 1);
        cp_fcd_record_destroy(&record);
    }
}

// One step in ten of SUMO's: what happens between is not known.
static void a_record_coarser_than_the_steps_is_told_or_refused(void **unused)
{
    (void)unused;
    static const double PERIOD_S[] = {0.2, 1.0};
    for (int k = 0; k < 2; k++) {
        cp_listed_collision one = listed[0];
        one.time_s = one.last_s = 2.1;
        cp_collision_list list = {.collision = &one, .count = 1};
        char text[4096];
        size_t used = (size_t)snprintf(text, sizeof text, "<fcd-export>");
        for (int step = 0; step < 20; step++)
            used += (size_t)snprintf(text + used, sizeof text - used,
                                     "<timestep time=\"%.2f\"><vehicle id=\"a\" x=\"%g\" "
                                     "y=\"0\" angle=\"90\" speed=\"20\"/></timestep>",
                                     PERIOD_S[k] * step, 20.0 * PERIOD_S[k] * step);
        snprintf(text + used, sizeof text - used, "</fcd-export>");
        cp_fcd_record record;
        cp_error error = {0};
        cp_status status = cp_sumo_fcd_read(write_file(text), &list, 5.0, 1.0, &record, &error);
        assert_int_equal(status, k == 0 ? CP_OK : CP_BAD_INPUT);
        if (status == CP_OK)
            cp_fcd_record_destroy(&record);
        else
            assert_non_null(strstr(error.text, "found one every 1 s and a collision at 2.1 s"));
    }
}

// Degrees in place of metres.
static void geographic_positions_are_refused(void **unused)
{
    (void)unused;
    cp_listed_collision one = listed[0];
    one.time_s = 2.0;
    cp_collision_list list = {.collision = &one, .count = 1};
    char text[4096];
    size_t used = (size_t)snprintf(text, sizeof text, "<fcd-export>");
    for (int k = 0; k < 20; k++)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "<timestep time=\"%.1f\"><vehicle id=\"a\" x=\"%.6f\" y=\"44.5\" "
                                 "angle=\"90\" speed=\"20\"/></timestep>",
                                 0.1 * k, 11.3 + 0.00002 * k);
    snprintf(text + used, sizeof text - used, "</fcd-export>");
    cp_fcd_record record;
    cp_error error = {0};
    assert_int_equal(cp_sumo_fcd_read(write_file(text), &list, 5.0, 1.0, &record, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "--fcd-output.geo?"));
}

static void sizes_of_types(void **unused)
{
    (void)unused;
    cp_vtypes types = {0};
    cp_error error = {0};
    static const char ROUTES[] = "<routes>\n<vTypeDistribution id=\"mix\">\n"
                                 "<vType id=\"small\" length=\"3.9\" width=\"1.7\">\n"
                                 "<param key=\"crashpulse.model\" value=\"small_car\"/></vType>\n"
                                 "<vType id=\"any\"/>\n"
                                 "</vTypeDistribution>\n</routes>";
    if (cp_vtypes_read(write_file(ROUTES), &types, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(types.count, 2);
    assert_true(cp_vtypes_find(&types, "small")->length_m == 3.9);
    assert_true(cp_vtypes_find(&types, "small")->width_m == 1.7);
    assert_string_equal(cp_vtypes_find(&types, "small")->model, "small_car");
    assert_true(cp_vtypes_find(&types, "any")->length_m == 5.0);
    assert_string_equal(cp_vtypes_find(&types, "any")->vehicle_class, "passenger");
    assert_null(cp_vtypes_find(&types, "mix"));
    char *text = with(ROUTES, "3.9", "-3.9");
    assert_int_equal(cp_vtypes_read(write_file(text), &types, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "file:3: length of <vType> must be between 0.1 and 500"));
    free(text);
    text = with(ROUTES, "<vType id=\"any\"/>", "<vType id=\"any\" vClass=\"bus\"/>");
    cp_vtypes_destroy(&types);
    assert_int_equal(cp_vtypes_read(write_file(text), &types, &error), CP_OK);
    assert_true(cp_vtypes_find(&types, "any")->length_m == 12.0);
    assert_true(cp_vtypes_find(&types, "any")->width_m == 2.5);
    free(text);
    cp_vtypes_destroy(&types);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tracks_and_exposure),
        cmocka_unit_test(bad_files_are_told_by_line),
        cmocka_unit_test(gaps_of_whole_steps_are_gaps),
        cmocka_unit_test(the_record_reaches_to_the_last_report),
        cmocka_unit_test(a_record_coarser_than_the_steps_is_told_or_refused),
        cmocka_unit_test(geographic_positions_are_refused),
        cmocka_unit_test(sizes_of_types),
    };
    return cmocka_run_group_tests(tests, written_begin, written_end);
}
