/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "builders/ev5_folder.h"
#include "calibrate/fit_file.h"

// A fit file of these lines beside a made-up test and a pulse file, loaded.
static cp_status load_fit(const char *lines, cp_fit *fit, cp_error *error)
{
    ev5_folder shop = ev5_folder_open();
    ev5_folder_write(&shop, "base.yaml", "vehicle: base\nparameters: []\n");
    ev5_folder_write(&shop, "table.csv", "speed_kmh,offset_mm,angle_deg,olc_g\n56,0,0,20\n");
    ev5_folder_write(&shop, "pulse.csv",
                     "time_s,ax_m_s2,vx_m_s\n0,0,15\n0.01,-200,14\n0.02,-2800,-1\n0.03,2800,-1\n");
    char text[2048], path[128];
    snprintf(text, sizeof text,
             "fit: made_up\nbase: base.yaml\noutput: out.yaml\nseed: 1\n"
             "unknowns:\n  - {name: mass_kg, min: 1500, max: 1600}\n%s",
             lines);
    ev5_folder_write(&shop, "x.fit.yaml", text);
    snprintf(path, sizeof path, "%s/x.fit.yaml", shop.path);
    *error = (cp_error){0};
    cp_status status = cp_fit_load(path, NULL, fit, error);
    ev5_folder_close(&shop);
    return status;
}

static void pulses_are_loaded_with_their_conditions(void **state)
{
    (void)state;
    cp_fit fit;
    cp_error error;
    if (load_fit(
            "objective: pulse\n"
            "pulses:\n"
            "  - {ev5: ., channels: [7, 10], until_s: 0.05}\n"
            "  - {file: pulse.csv, speed_km_h: 54, offset_mm: -350, angle_deg: 20, weight: 2}\n"
            "calibrated: {speed_min_km_h: 30, speed_max_km_h: 60, offset_max_mm: 10, "
            "angle_max_deg: 3, reason: one test}\n",
            &fit, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(fit.objective, CP_FIT_PULSE);
    assert_int_equal(fit.pulse_count, 2);
    assert_string_equal(fit.pulses[0].source, "t1.EV5, channels 7 and 10");
    assert_near(fit.pulses[0].until_s, 0.05, 0.0);
    assert_near(fit.pulses[0].weight_1, 1.0, 0.0);
    assert_near(fit.pulses[1].weight_1, 2.0, 0.0);

    // The table of OLC values that reports go by.
    assert_int_equal(fit.reference.count, 2);
    assert_near(fit.reference.cases[0].speed_km_h, 36.0, 1e-9);
    assert_near(fit.reference.cases[1].speed_km_h, 54.0, 0.0);
    assert_near(fit.reference.cases[1].offset_mm, -350.0, 0.0);
    assert_near(fit.reference.cases[1].angle_deg, 20.0, 0.0);
    assert_true(isnan(fit.pulses[1].marks.olc_g) && fit.reference.cases[1].olc_g == 0.0);
    assert_int_equal(strlen(fit.reference.hash), 64);
    assert_true(fit.range.given);
    assert_near(fit.range.offset_max_mm, 10.0, 0.0);
    assert_string_equal(fit.range.reason, "one test");
    cp_fit_destroy(&fit);

    // Nothing said of an objective: OLC, as ever.
    assert_int_equal(load_fit("reference: table.csv\n", &fit, &error), CP_OK);
    assert_int_equal(fit.objective, CP_FIT_OLC);
    assert_int_equal(fit.pulse_count, 0);
    assert_false(fit.range.given);
    cp_fit_destroy(&fit);
}

static void errors_name_line_and_field(void **state)
{
    (void)state;
    static const struct {
        const char *lines;
        const char *words;
    } CASES[] = {
        {"", "reference is missing: objective olc needs"},
        {"objective: luck\nreference: table.csv\n",
         ":7: objective must be olc or pulse, found 'luck'"},
        {"objective: pulse\n", "pulses is missing: objective pulse needs"},
        {"objective: pulse\nreference: table.csv\npulses:\n  - {file: pulse.csv}\n",
         ":8: reference goes with objective olc"},
        {"reference: table.csv\npulses:\n  - {file: pulse.csv}\n",
         "pulses goes with objective pulse"},
        {"objective: pulse\npulses:\n  - {file: pulse.csv}\n  - {offset_mm: 3}\n",
         ":10: pulses[1].file either file or ev5"},
        {"objective: pulse\npulses:\n  - {file: pulse.csv, ev5: .}\n", "either file or ev5"},
        {"objective: pulse\npulses:\n  - {ev5: .}\n", "pulses[0].channels goes with ev5"},
        {"objective: pulse\npulses:\n  - {file: pulse.csv, channels: [7]}\n",
         "pulses[0].channels goes with ev5"},
        {"objective: pulse\npulses:\n  - {ev5: ., channels: [7, left]}\n",
         "pulses[0].channels[1] must be a number from 1 to 99999, found 'left'"},
        {"objective: pulse\npulses:\n  - {ev5: ., channels: [7.5]}\n", "must be a whole number"},
        {"objective: pulse\npulses:\n  - {ev5: ., channels: [8]}\n", ":9: pulses[0]: "},
        {"objective: pulse\npulses:\n  - {file: pulse.csv, weight: 0}\n",
         ":9: pulses[0].weight must be between"},
        {"objective: pulse\npulses:\n  - {file: gone.csv}\n", "gone.csv: cannot be read"},
        {"reference: table.csv\ncalibrated: {speed_min_km_h: 60, speed_max_km_h: 50, "
         "offset_max_mm: 0, angle_max_deg: 0, reason: none}\n",
         "calibrated.speed_max_km_h must be between 60"},
    };
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        cp_fit fit;
        cp_error error;
        assert_int_equal(load_fit(CASES[k].lines, &fit, &error), CP_BAD_INPUT);
        if (strstr(error.text, CASES[k].words) == NULL)
            fail_msg("expected '%s' in: %s", CASES[k].words, error.text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pulses_are_loaded_with_their_conditions),
        cmocka_unit_test(errors_name_line_and_field),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
