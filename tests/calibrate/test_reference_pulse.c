/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "builders/ev5_folder.h"
#include "calibrate/reference_pulse.h"
#include "core/units.h"

#include <sys/stat.h>

static cp_pulse_source source_of(const char *path)
{
    return (cp_pulse_source){
        .path = path, .speed_km_h = NAN, .until_s = NAN, .weight_1 = 1.0, .angle_deg = 5.0};
}

static cp_status load(const cp_pulse_source *source, cp_reference_pulse *pulse, cp_error *error)
{
    *error = (cp_error){0};
    return cp_reference_pulse_load(source, pulse, error);
}

static void sensors_of_a_test_are_averaged(void **state)
{
    (void)state;
    ev5_folder shop = ev5_folder_open();
    cp_pulse_source source = source_of(shop.path);
    source.sensor_count = 2;
    source.sensor[0] = 7;
    source.sensor[1] = 10;
    source.until_s = 0.05;
    cp_reference_pulse pulse;
    cp_error error;
    if (load(&source, &pulse, &error) != CP_OK)
        fail_msg("%s", error.text);

    // Decelerations of 10 and 20 g, from 36 km/h: v = 10 m/s - 15 g t, at rest after 68 ms.
    assert_string_equal(pulse.source, "t1.EV5, channels 7 and 10");
    assert_near(pulse.condition.speed_km_h, 36.0, 1e-9);
    assert_near(pulse.condition.angle_deg, 5.0, 0.0);
    assert_int_equal(pulse.count, 51);
    assert_false(pulse.lateral);
    double a_m_s2 = 15.0 * CP_G0_M_S2;
    assert_near(pulse.vx_m_s[40], 10.0 - 0.040 * a_m_s2, 1e-9);
    assert_near(pulse.ax_g[45], -15.0, 0.01);
    assert_near(pulse.marks.t_v0_s, 10.0 / a_m_s2, 1e-9);
    assert_near(pulse.marks.peak_g, 15.0, 1.5);
    assert_near(pulse.marks.crush_m, 0.5 * 100.0 / a_m_s2, 1e-4);
    // It ends before the virtual occupant moves with the car.
    assert_true(isnan(pulse.marks.olc_g) && pulse.condition.olc_g == 0.0);
    cp_reference_pulse_destroy(&pulse);
    ev5_folder_close(&shop);
}

static void wrong_sensors_are_refused(void **state)
{
    (void)state;
    static const struct {
        int sensor;
        const char *words;
    } CASES[] = {{8, "has no curve number 8"},
                 {1012, "t1.EV5:11: curve 1012 is no longitudinal accelerometer"},
                 {9, "t1.EV5:12: the data status of curve 9 must be AM"}};
    ev5_folder shop = ev5_folder_open();
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        cp_pulse_source source = source_of(shop.path);
        source.sensor_count = 2;
        source.sensor[0] = 7;
        source.sensor[1] = CASES[k].sensor;
        cp_reference_pulse pulse;
        cp_error error;
        assert_int_equal(load(&source, &pulse, &error), CP_BAD_INPUT);
        if (strstr(error.text, CASES[k].words) == NULL)
            fail_msg("expected '%s' in: %s", CASES[k].words, error.text);
    }

    // Two sensors sampled differently have no mean.
    ev5_folder_replace(&shop, "|-50|99|1000|AM|P|RIGHT", "|-50|98|1000|AM|P|RIGHT");
    char samples[8192] = "";
    for (int k = -50; k < 99; k++)
        snprintf(samples + strlen(samples), 32, "%.6f 1\n", 1e-3 * k);
    ev5_folder_write(&shop, "t1.010", samples);
    cp_pulse_source source = source_of(shop.path);
    source.sensor_count = 2;
    source.sensor[0] = 7;
    source.sensor[1] = 10;
    cp_reference_pulse pulse;
    cp_error error;
    assert_int_equal(load(&source, &pulse, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "curves 7 and 10 are sampled differently"));
    ev5_folder_close(&shop);
}

static cp_status load_text(const char *text, cp_pulse_source source, cp_reference_pulse *pulse,
                           cp_error *error)
{
    char path[] = "/tmp/pulse_XXXXXX";
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, text, strlen(text)), (ssize_t)strlen(text));
    close(descriptor);
    source.path = path;
    cp_status status = load(&source, pulse, error);
    unlink(path);
    return status;
}

static void a_file_is_read_by_its_columns(void **state)
{
    (void)state;
    cp_reference_pulse pulse;
    cp_error error;
    const char *text = "vehicle,time_s,ax_m_s2,ay_m_s2,vx_m_s,vy_m_s\n"
                       "a,0,0,0,10,0\r\n"
                       "b,0,1,1,20,1\n"
                       "a,0.01,-980.665,98.0665,5,0.5\n"
                       "a,0.02,-980.665,-147.1,-5,0.25\n\n";
    if (load_text(text, source_of(""), &pulse, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(pulse.count, 3);
    assert_true(pulse.lateral);
    assert_near(pulse.interval_s, 0.01, 1e-15);
    assert_near(pulse.until_s, 0.02, 1e-15);
    assert_near(pulse.ax_g[1], -100.0, 1e-10);
    assert_near(pulse.ay_g[1], 10.0, 1e-10);
    assert_near(pulse.vx_m_s[2], -5.0, 0.0);
    assert_near(pulse.vy_m_s[2], 0.25, 0.0);
    assert_near(pulse.marks.t_v0_s, 0.015, 1e-12);
    assert_near(pulse.condition.speed_km_h, 36.0, 1e-12);
    cp_reference_pulse_destroy(&pulse);

    // Without both lateral columns a pulse is longitudinal.
    text = "time_s,vx_m_s,ax_m_s2,vy_m_s\n0,10,0,1\n0.01,9,-100,2\n";
    assert_int_equal(load_text(text, source_of(""), &pulse, &error), CP_OK);
    assert_false(pulse.lateral);
    assert_true(isnan(pulse.marks.t_v0_s));
    cp_reference_pulse_destroy(&pulse);
}

static void wrong_files_are_named(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double speed_km_h;
        const char *words;
    } CASES[] = {
        {"time_s,vx_m_s\n0,1\n", NAN, ":1: column ax_m_s2 is missing"},
        {"time_s,ax_m_s2,vx_m_s\n0,0,9\n0.01,0,fast\n", NAN,
         ":3: vx_m_s must be a number, found 'fast'"},
        {"time_s,ax_m_s2,vx_m_s\n0,0,9\n0.01,0\n", NAN,
         ":3: must have a field for each of the 3 columns, found 2"},
        {"time_s,ax_m_s2,vx_m_s\n0,0,9,5\n0,01,0,9\n", NAN, ":2: must have a field"},
        {"time_s,ax_m_s2,vx_m_s,ax_m_s2\n0,0,9,1\n", NAN, ":1: column ax_m_s2 is given twice"},
        {"time_s,ax_m_s2,vx_m_s\n0,0,9\n0.01,0,9\n0.03,0,9\n", NAN, ":4: time_s must be 0.02"},
        {"time_s,ax_m_s2,vx_m_s\n0.5,0,9\n", NAN, ":2: time_s must be 0"},
        {"time_s,ax_m_s2,vx_m_s\n0,0,9\n0,0,9\n", NAN, ":3: time_s must rise"},
        {"time_s,ax_m_s2,vx_m_s\n0,0,9\n", NAN, "fewer than two samples"},
        {"time_s,ax_m_s2,vx_m_s\n0,0,9\n0.01,800,5\n", NAN, "do not go together (unit, polarity"},
        {"time_s,ax_m_s2,vx_m_s\n0,0,50\n0.01,-800,36\n", NAN, "do not go together"},
        {"time_s;ax_m_s2;vx_m_s\n0;0;9,5\n0,01;0;9\n", NAN,
         ":2: vx_m_s must be a number, found '9,5'"},
        {"time_s,ax_m_s2,vx_m_s\n0,0,10\n0.01,0,9\n", 50.0,
         "begins at 36 km/h, which does not go with a speed of 50 km/h"},
        {"", NAN, ":1: column time_s is missing"},
    };
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        cp_pulse_source source = source_of("");
        source.speed_km_h = CASES[k].speed_km_h;
        cp_reference_pulse pulse;
        cp_error error;
        assert_int_equal(load_text(CASES[k].text, source, &pulse, &error), CP_BAD_INPUT);
        if (strstr(error.text, CASES[k].words) == NULL)
            fail_msg("expected '%s' in: %s", CASES[k].words, error.text);
    }
    cp_pulse_source source = source_of("");
    source.until_s = 0.2;
    cp_reference_pulse pulse;
    cp_error error;
    assert_int_equal(load_text("time_s,ax_m_s2,vx_m_s\n0,0,9\n0.01,0,9\n", source, &pulse, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "end of the record at 0.01 s, found 0.2"));
}

// Figures of the real pulse, computed independently of this program.
static void the_real_pulse_has_its_known_marks(void **state)
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
    cp_pulse_source source = source_of(folder);
    source.sensor_count = 2;
    source.sensor[0] = 93;
    source.sensor[1] = 94;
    cp_reference_pulse pulse;
    cp_error error;
    if (load(&source, &pulse, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_near(pulse.condition.speed_km_h, 57.09, 1e-9);
    assert_near(pulse.marks.olc_g, 29.41, 0.01);
    assert_near(1e3 * pulse.marks.t_v0_s, 74.0, 0.1);
    assert_near(pulse.marks.peak_g, 40.9, 0.1);
    assert_near(1e3 * pulse.marks.crush_m, 746.0, 1.0);
    cp_reference_pulse_destroy(&pulse);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sensors_of_a_test_are_averaged),
        cmocka_unit_test(wrong_sensors_are_refused),
        cmocka_unit_test(a_file_is_read_by_its_columns),
        cmocka_unit_test(wrong_files_are_named),
        cmocka_unit_test(the_real_pulse_has_its_known_marks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
