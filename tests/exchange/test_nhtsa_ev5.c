/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "builders/ev5_folder.h"
#include "core/units.h"
#include "exchange/nhtsa_ev5.h"
#include "pulse/olc.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// ---- a made-up test --------------------------------------------------------------------------

static void records_and_samples_come_in_si(void **state)
{
    (void)state;
    ev5_folder shop = ev5_folder_open();
    cp_ev5_test test;
    cp_error error = {0};
    if (cp_ev5_load(shop.path, &test, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_string_equal(test.name, "t1");
    assert_string_equal(test.title, "MADE-UP TEST");
    assert_near(test.closing_speed_m_s, 10.0, 1e-12);
    assert_int_equal(test.vehicle_count, 1);
    assert_near(test.vehicle[0].mass_kg, 1500.0, 0.0);
    assert_near(test.vehicle[0].length_m, 4.5, 1e-12);
    assert_near(test.vehicle[0].cg_behind_front_axle_m, 1.2, 1e-12);
    assert_near(test.vehicle[0].speed_m_s, 10.0, 1e-12);
    assert_int_equal(test.instrument_count, 4);
    const cp_ev5_instrument *instrument = cp_ev5_find(&test, 7);
    assert_non_null(instrument);
    assert_string_equal(instrument->axis, "XG");
    assert_string_equal(instrument->unit, "G'S");
    assert_near(instrument->interval_s, 1e-3, 1e-15);
    assert_null(cp_ev5_find(&test, 8));

    // The curve rests at 0.5 g before time 0 and at -9.5 g after: 10 g of deceleration.
    cp_ev5_channel channel;
    if (cp_ev5_channel_load(&test, 7, &channel, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(channel.first_sample, -EV5_PRE);
    assert_int_equal(channel.sample_count, EV5_PRE + EV5_POST);
    assert_near(channel.zero_offset, 0.5 * CP_G0_M_S2, 1e-9);
    assert_near(channel.value[EV5_PRE - 1], 0.0, 1e-9);
    assert_near(channel.value[EV5_PRE], -10.0 * CP_G0_M_S2, 1e-9);
    cp_ev5_channel_destroy(&channel);

    // Millimetres become metres.
    assert_int_equal(cp_ev5_channel_load(&test, 1012, &channel, &error), CP_OK);
    assert_near(channel.value[EV5_PRE] + channel.zero_offset, 0.25, 1e-9);
    cp_ev5_channel_destroy(&channel);
    cp_ev5_destroy(&test);
    ev5_folder_close(&shop);
}

static void the_file_itself_may_be_named(void **state)
{
    (void)state;
    ev5_folder shop = ev5_folder_open();
    char path[128];
    snprintf(path, sizeof path, "%s/t1.EV5", shop.path);
    cp_ev5_test test;
    cp_error error = {0};
    assert_int_equal(cp_ev5_load(path, &test, &error), CP_OK);
    char *curve = cp_ev5_curve_path(&test, 7);
    snprintf(path, sizeof path, "%s/t1.007", shop.path);
    assert_string_equal(curve, path);
    free(curve);
    cp_ev5_destroy(&test);

    // Two tests in one folder: which is meant is not for the reader to guess.
    ev5_folder_write(&shop, "t2.ev5", "");
    assert_int_equal(cp_ev5_load(shop.path, &test, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "more than one EV5 file"));
    ev5_folder_close(&shop);
}

// ---- what is wrong with a file ---------------------------------------------------------------

static void malformed_records_are_named(void **state)
{
    (void)state;
    static const struct {
        const char *from; // a piece of the EV5 file ...
        const char *to;   // ... and what stands there instead
        const char *words;
    } CASES[] = {
        {"|1500|", "|heavy|", "t1.EV5:6: field 11 (test weight, kg) must be a number"},
        {"|1500|", "||", "found ''"},
        {"|36.0|0|0|0|3|", "|nan|0|0|0|3|", "t1.EV5:4: field 15 (closing speed, km/h)"},
        {"|-50|99|1000|AM|P|LEFT", "|-50|-99|1000|AM|P|LEFT",
         "t1.EV5:10: field 16 (last sample) must be a number between -50"},
        {"|-50|99|1000|AM|P|LEFT", "|-50|99|0|AM|P|LEFT", "field 17 (interval, microseconds)"},
        {"1|7|AC", "1|x|AC", "t1.EV5:10: field 2 (curve number)"},
        {"1|1012|DS", "1|7|DS", "field 2 (curve number): 7 is given twice"},
        {"|P|CRUSH", "", "t1.EV5:11: field 19 (channel status) is missing"},
        {"----- VEHICLE -----", "----- BARRIER -----", "no record in section VEHICLE"},
        {"----- TEST -----", "nothing", "no record in section TEST"},
    };
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        ev5_folder shop = ev5_folder_open();
        ev5_folder_replace(&shop, CASES[k].from, CASES[k].to);
        cp_ev5_test test;
        cp_error error = {0};
        assert_int_equal(cp_ev5_load(shop.path, &test, &error), CP_BAD_INPUT);
        if (strstr(error.text, CASES[k].words) == NULL)
            fail_msg("expected '%s' in: %s", CASES[k].words, error.text);
        ev5_folder_close(&shop);
    }
}

static void malformed_curves_are_named(void **state)
{
    (void)state;
    static const struct {
        int curve;
        const char *text; // the curve file; NULL: none
        const char *words;
    } CASES[] = {
        {7, NULL, "t1.007: cannot be read"},
        {7, "-0.050 1\n-0.049\n", "t1.007:2: two columns are needed, found '-0.049'"},
        {7, "-0.050 1\n-0.049 one\n", "t1.007:2: column 2 (value) is no number: 'one'"},
        {7, "-0.050 1\nnever 1\n", "t1.007:2: column 1 (time) is no number: 'never'"},
        {7, "-0.050 1\n-0.048 1\n", "t1.007:2: column 1 (time) must be -0.049000 s"},
        {7, "-0.050 1\n-0.049 1\n", "ends after 2 of the 150 samples"},
        {7, "", "ends after 0 of the 150 samples"},
        {8, NULL, "has no curve number 8"},
        {9, NULL, "t1.EV5:12: field 18 (data status): curve 9 holds no data"},
    };
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        ev5_folder shop = ev5_folder_open();
        ev5_folder_remove(&shop, "t1.007");
        if (CASES[k].text != NULL)
            ev5_folder_write(&shop, "t1.007", CASES[k].text);
        cp_ev5_test test;
        cp_ev5_channel channel;
        cp_error error = {0};
        assert_int_equal(cp_ev5_load(shop.path, &test, &error), CP_OK);
        assert_int_equal(cp_ev5_channel_load(&test, CASES[k].curve, &channel, &error),
                         CP_BAD_INPUT);
        if (strstr(error.text, CASES[k].words) == NULL)
            fail_msg("expected '%s' in: %s", CASES[k].words, error.text);
        cp_ev5_destroy(&test);
        ev5_folder_close(&shop);
    }
}

static void an_unknown_unit_is_refused(void **state)
{
    (void)state;
    ev5_folder shop = ev5_folder_open();
    ev5_folder_replace(&shop, "|G'S|", "|FURLONG|");
    cp_ev5_test test;
    cp_ev5_channel channel;
    cp_error error = {0};
    assert_int_equal(cp_ev5_load(shop.path, &test, &error), CP_OK);
    assert_int_equal(cp_ev5_channel_load(&test, 7, &channel, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "t1.EV5:10: field 8 (unit): 'FURLONG'"));
    cp_ev5_destroy(&test);
    ev5_folder_close(&shop);
}

// ---- the real one ----------------------------------------------------------------------------

// OLC of a test curve: impact speed and the integral of its acceleration from time 0 on.
static double olc_of_curve(const cp_ev5_test *test, int curve, double *t_v0_s)
{
    cp_ev5_channel channel;
    cp_error error = {0};
    if (cp_ev5_channel_load(test, curve, &channel, &error) != CP_OK)
        fail_msg("%s", error.text);
    size_t zero = (size_t)-channel.first_sample, count = channel.sample_count - zero;
    double *speed_m_s = malloc(count * sizeof *speed_m_s);
    assert_non_null(speed_m_s);
    speed_m_s[0] = test->vehicle[0].speed_m_s;
    *t_v0_s = NAN;
    for (size_t k = 1; k < count; k++) {
        double mean = 0.5 * (channel.value[zero + k - 1] + channel.value[zero + k]);
        speed_m_s[k] = speed_m_s[k - 1] + mean * channel.interval_s;
        if (isnan(*t_v0_s) && speed_m_s[k] <= 0.0)
            *t_v0_s = (double)k * channel.interval_s;
    }
    cp_olc olc = cp_olc_from_velocity(speed_m_s, count, channel.interval_s);
    free(speed_m_s);
    cp_ev5_channel_destroy(&channel);
    assert_int_equal(olc.status, CP_OLC_VALUE);
    return olc.olc_g;
}

static void a_real_test_is_read(void **state)
{
    (void)state;
    char folder[4096];
    struct stat there;
    snprintf(folder, sizeof folder, "%s/../shared/reference/nhtsa_v10146_camry_2018",
             getenv("CRASHPULSE_SOURCE"));
    if (stat(folder, &there) != 0) {
        print_message("skipped: %s is not there (NHTSA test 10146)\n", folder);
        skip();
    }
    cp_ev5_test test;
    cp_error error = {0};
    if (cp_ev5_load(folder, &test, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_string_equal(test.name, "v10146");
    assert_string_equal(test.laboratory_reference, "BT17100331");
    assert_near(test.vehicle[0].mass_kg, 1719.0, 0.0);
    assert_near(test.vehicle[0].speed_m_s, 57.09 / 3.6, 1e-12);
    assert_near(test.vehicle[0].length_m, 4.896, 1e-12);
    assert_int_equal(test.instrument_count, 634);
    assert_string_equal(cp_ev5_find(&test, 93)->comment, "LEFT REAR SEAT CROSSMEMBER X");

    // OLC and time of standstill of four sensors, computed independently of this program.
    static const struct {
        int curve;
        double olc_g;
        double t_v0_ms;
    } CURVES[] = {{93, 29.25, 74.3}, {94, 29.57, 73.8}, {99, 30.15, 72.5}, {100, 29.49, 73.8}};
    for (size_t k = 0; k < sizeof CURVES / sizeof *CURVES; k++) {
        double t_v0_s = 0.0;
        assert_near(olc_of_curve(&test, CURVES[k].curve, &t_v0_s), CURVES[k].olc_g, 0.02);
        assert_near(1e3 * t_v0_s, CURVES[k].t_v0_ms, 0.15);
    }
    cp_ev5_destroy(&test);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(records_and_samples_come_in_si),
        cmocka_unit_test(the_file_itself_may_be_named),
        cmocka_unit_test(malformed_records_are_named),
        cmocka_unit_test(malformed_curves_are_named),
        cmocka_unit_test(an_unknown_unit_is_refused),
        cmocka_unit_test(a_real_test_is_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
