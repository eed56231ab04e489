/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "builders/ev5_folder.h"

#include "core/file.h"
#include "core/units.h"
#include "exchange/ev5_pulse.h"

#include <math.h>
#include <sys/stat.h>

#define SECOND_CAR                                                                                 \
    "2|16|03|2018|M1|4S|VIN|4CIF|2.5|AF|1600|1400|2700|4500|1800|1200|UN|UNK|P|"                   \
    "|1|2|3|4|5|6|7|8|9|10|11|12|13|14|15|16|17|18|19|20|21|0|0|0|DE\n"

// The EV5 file as it is with its first from replaced by to.
static void change(const ev5_folder *shop, const char *from, const char *to)
{
    char path[128], *content = NULL, *changed = NULL;
    size_t size = 0;
    cp_error error = {0};
    snprintf(path, sizeof path, "%s/t1.EV5", shop->path);
    assert_int_equal(cp_file_read(path, &content, &size, &error), CP_OK);
    char *at = strstr(content, from);
    assert_non_null(at);
    changed = malloc(size + strlen(to) + 1);
    assert_non_null(changed);
    *at = '\0';
    sprintf(changed, "%s%s%s", content, to, at + strlen(from));
    ev5_folder_write(shop, "t1.EV5", changed);
    free(changed);
    free(content);
}

static cp_status read_pulse(const ev5_folder *shop, const int curve[], size_t count,
                            cp_pulse_record *record, cp_error *error)
{
    cp_pulse_request request = cp_pulse_request_default(shop->path);
    request.curve_count = count;
    for (size_t k = 0; k < count; k++)
        request.curve[k] = curve[k];
    *error = (cp_error){0};
    return cp_ev5_pulse_read(&request, record, error);
}

static void must_refuse(const ev5_folder *shop, int curve, const char *words)
{
    cp_pulse_record record;
    cp_error error;
    assert_int_equal(read_pulse(shop, &curve, 1, &record, &error), CP_BAD_INPUT);
    if (strstr(error.text, words) == NULL)
        fail_msg("'%s' does not hold '%s'", error.text, words);
    assert_null(record.pulse.channel[0]);
}

// Without a choice the primary sensors on the structure are taken: 7 and 10 of the made-up test.
static void the_structure_is_found(void **state)
{
    (void)state;
    ev5_folder shop = ev5_folder_open();
    cp_pulse_record record;
    cp_error error;
    if (read_pulse(&shop, NULL, 0, &record, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_string_equal(record.source, "t1.EV5, channels 7 and 10");
    assert_string_equal(record.vehicle, "1");
    assert_near(record.mass_kg, 1500.0, 0.0);
    assert_false(record.against_car);
    assert_true(isnan(record.separation_s));
    assert_int_equal(record.pulse.sample_count, EV5_POST);
    assert_near(record.pulse.channel[CP_CHANNEL_AX][50], -15.0 * CP_G0_M_S2, 1e-9);
    assert_near(record.pulse.channel[CP_CHANNEL_VX][40], 10.0 - 0.6 * CP_G0_M_S2, 1e-9);
    assert_true(record.known[CP_CHANNEL_VX] && !record.known[CP_CHANNEL_VY]);
    cp_pulse_record_destroy(&record);

    // A redundant one is not.
    change(&shop, "AM|P|RIGHT", "AM|R|RIGHT");
    assert_int_equal(read_pulse(&shop, NULL, 0, &record, &error), CP_OK);
    assert_string_equal(record.source, "t1.EV5, channel 7");
    cp_pulse_record_destroy(&record);
    change(&shop, "AM|P|LEFT", "CF|P|LEFT");
    assert_int_equal(read_pulse(&shop, NULL, 0, &record, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "has no longitudinal accelerometer on the structure"));
    ev5_folder_close(&shop);
}

static void what_is_not_the_car_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *from, *to, *words;
    } CASES[] = {
        {"|7|AC|NA|FLLR|XG|SEC|G'S|2800|MFG|12/APR/2017|800|21|36.0|-50|99|1000|AM|P|LEFT SILL X",
         "|7|AC|01|HDCG|XL|SEC|G'S|2800|MFG|12/APR/2017|800|21|36.0|-50|99|1000|AM|P|DRIVER HEAD X",
         "t1.EV5:10: curve 7 must sit on the structure of the car (centre of gravity, floor pan, "
         "sill, pillar, cross-member), found attachment HDCG of the occupant on seat 01 (DRIVER "
         "HEAD X)"},
        {"|7|AC|NA|FLLR", "|7|AC|02|FLLR", "of the occupant on seat 02"},
        {"|FLLR|XG", "|ENGN|XG", "found attachment ENGN"},
        {"|FLLR|XG|SEC|G'S|2800|MFG|12/APR/2017|800|21|36.0|-50|99|1000|AM|P|LEFT SILL X",
         "|OTHR|XG|SEC|G'S|2800|MFG|12/APR/2017|800|21|36.0|-50|99|1000|AM|P|LEFT",
         "found attachment OTHR (LEFT)"},
        {"LEFT SILL X", "TOP OF ENGINE", "(TOP OF ENGINE)"},
        {"|FLLR|XG|SEC|G'S", "|FLLR|XG|SEC|MS2", "field 8 (unit): 'MS2' is none of G'S"},
        {"|7|AC", "|7|AV", "is no longitudinal accelerometer"},
    };
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        ev5_folder shop = ev5_folder_open();
        change(&shop, CASES[k].from, CASES[k].to);
        must_refuse(&shop, 7, CASES[k].words);
        ev5_folder_close(&shop);
    }
    // A comment tells where the code does not.
    ev5_folder shop = ev5_folder_open();
    change(&shop, "|FLLR|XG", "|OTHR|XG");
    cp_pulse_record record;
    cp_error error;
    int curve = 7;
    assert_int_equal(read_pulse(&shop, &curve, 1, &record, &error), CP_OK);
    cp_pulse_record_destroy(&record);
    ev5_folder_close(&shop);
}

static void two_cars_are_not_averaged(void **state)
{
    (void)state;
    ev5_folder shop = ev5_folder_open();
    change(&shop, "----- OCCUPANT", SECOND_CAR "----- OCCUPANT");
    change(&shop, "1|10|AC", "2|10|AC");
    const int both[] = {7, 10};
    cp_pulse_record record;
    cp_error error;
    assert_int_equal(read_pulse(&shop, both, 2, &record, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "curves 7 and 10 must sit on one vehicle, found vehicles 1 "
                                       "and 2"));
    // Without a choice it is the first car's alone.
    assert_int_equal(read_pulse(&shop, NULL, 0, &record, &error), CP_OK);
    assert_string_equal(record.source, "t1.EV5, channel 7");
    assert_true(record.against_car);
    cp_pulse_record_destroy(&record);
    // The other stood: its speed of 0 is one.
    cp_ev5_test test;
    assert_int_equal(cp_ev5_load(shop.path, &test, &error), CP_OK);
    assert_near(cp_ev5_speed_m_s(&test, 7), 10.0, 1e-12);
    assert_near(cp_ev5_speed_m_s(&test, 10), 0.0, 0.0);
    cp_ev5_destroy(&test);
    ev5_folder_close(&shop);
}

static void a_blank_speed_is_the_closing_speed(void **state)
{
    (void)state;
    static const char *const BLANK[] = {"|21||0|0|DE", "|21|0|0|0|DE"};
    for (int k = 0; k < 2; k++) {
        ev5_folder shop = ev5_folder_open();
        change(&shop, "|21|36.0|0|0|DE", BLANK[k]);
        cp_pulse_record record;
        cp_error error;
        if (read_pulse(&shop, NULL, 0, &record, &error) != CP_OK)
            fail_msg("%s", error.text);
        assert_near(record.pulse.channel[CP_CHANNEL_VX][0], 10.0, 1e-12);
        cp_pulse_record_destroy(&record);
        // Neither is told.
        change(&shop, "|OTH|36.0|", "|OTH||");
        assert_int_equal(read_pulse(&shop, NULL, 0, &record, &error), CP_BAD_INPUT);
        assert_non_null(strstr(error.text, "tells no speed at first contact"));
        ev5_folder_close(&shop);
    }
}

static void reversed_polarity_is_told(void **state)
{
    (void)state;
    ev5_folder shop = ev5_folder_open();
    ev5_folder_write_curve(&shop, "t1.007", 0.0, 20.0);
    must_refuse(&shop, 7, "t1.EV5, channel 7: the acceleration makes the car faster, by 19.");
    must_refuse(&shop, 7, "reversed polarity?");
    cp_pulse_request request = cp_pulse_request_default(shop.path);
    request.curve_count = 1;
    request.curve[0] = 7;
    request.is_reversed = true;
    cp_pulse_record record;
    cp_error error = {0};
    assert_int_equal(cp_ev5_pulse_read(&request, &record, &error), CP_OK);
    assert_near(record.pulse.channel[CP_CHANNEL_AX][50], -20.0 * CP_G0_M_S2, 1e-9);
    cp_pulse_record_destroy(&record);
    request.is_reversed = false;
    request.may_gain = true;
    assert_int_equal(cp_ev5_pulse_read(&request, &record, &error), CP_OK);
    assert_true(record.pulse.channel[CP_CHANNEL_VX][50] > 19.0);
    cp_pulse_record_destroy(&record);
    ev5_folder_close(&shop);
}

// NHTSA test 10146: the driver's head and the engine are no pulse of the car.
static void the_real_test_has_two_sensors(void **state)
{
    (void)state;
    char folder[512];
    const char *source = getenv("CRASHPULSE_SOURCE");
    struct stat entry;
    snprintf(folder, sizeof folder, "%s/../shared/reference/nhtsa_v10146_camry_2018",
             source != NULL ? source : ".");
    if (stat(folder, &entry) != 0) {
        print_message("%s is not there: not tried\n", folder);
        skip();
    }
    cp_ev5_test test;
    cp_error error = {0};
    int curve[CP_PULSE_CURVES_MAX];
    size_t count = 0;
    assert_int_equal(cp_ev5_load(folder, &test, &error), CP_OK);
    assert_int_equal(cp_ev5_find_structure(&test, 0, curve, &count, &error), CP_OK);
    assert_int_equal(count, 2);
    assert_true(curve[0] == 93 && curve[1] == 94);
    cp_ev5_channel mean;
    const int head = 1, engine = 95;
    assert_int_equal(cp_ev5_mean_of_structure(&test, &head, 1, &mean, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "DRIVER HEAD X"));
    assert_int_equal(cp_ev5_mean_of_structure(&test, &engine, 1, &mean, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "TOP OF ENGINE X"));
    cp_ev5_destroy(&test);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_structure_is_found),
        cmocka_unit_test(what_is_not_the_car_is_refused),
        cmocka_unit_test(two_cars_are_not_averaged),
        cmocka_unit_test(a_blank_speed_is_the_closing_speed),
        cmocka_unit_test(reversed_polarity_is_told),
        cmocka_unit_test(the_real_test_has_two_sensors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
