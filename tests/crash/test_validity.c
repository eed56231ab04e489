/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "builders/crash_builder.h"
#include "crash/validity.h"

#include <string.h>

static cp_vehicle_model calibrated_car(void)
{
    cp_vehicle_model car = cp_vehicle_model_default();
    car.calibrated_speed_min_m_s = cp_m_s_from_km_h(25.0);
    car.calibrated_speed_max_m_s = cp_m_s_from_km_h(56.0);
    car.calibrated_offset_max_m = 1.05;
    car.calibrated_angle_max_rad = cp_rad_from_deg(30.0);
    return car;
}

static unsigned validity_of(const cp_vehicle_model *a, const cp_vehicle_model *b, double speed_a,
                            double speed_b, double offset_mm, double angle_deg, int role)
{
    cp_crash_configuration configuration =
        crash_builder_configuration(a, b, speed_a, speed_b, offset_mm, angle_deg);
    cp_crash_description description =
        cp_crash_describe(a, b, &configuration, cp_crash_contact_point(a, b, &configuration));
    return cp_validity(a, b, &configuration, &description, role, NULL);
}

static void the_reference_study_is_inside(void **state)
{
    (void)state;
    cp_vehicle_model car = calibrated_car();
    assert_int_equal(validity_of(&car, NULL, 25.0, 0.0, -1050.0, 10.0, 0), 0);
    assert_int_equal(validity_of(&car, NULL, 56.0, 0.0, 350.0, 30.0, 0), 0);
    assert_int_equal(validity_of(&car, &car, 56.0, 56.0, 0.0, 0.0, 0), 0);
    assert_int_equal(validity_of(&car, &car, 56.0, 56.0, 0.0, 0.0, 1), 0);
}

static void every_limit_is_named(void **state)
{
    (void)state;
    cp_vehicle_model car = calibrated_car();
    assert_int_equal(validity_of(&car, NULL, 24.9, 0.0, 0.0, 0.0, 0), CP_OUTSIDE_SPEED);
    assert_int_equal(validity_of(&car, NULL, 56.1, 0.0, 0.0, 0.0, 0), CP_OUTSIDE_SPEED);
    assert_int_equal(validity_of(&car, NULL, 50.0, 0.0, 1060.0, 0.0, 0), CP_OUTSIDE_OFFSET);
    assert_int_equal(validity_of(&car, NULL, 50.0, 0.0, 0.0, 31.0, 0), CP_OUTSIDE_ANGLE);
    cp_vehicle_model never = cp_vehicle_model_default();
    assert_int_equal(validity_of(&never, NULL, 50.0, 0.0, 0.0, 0.0, 0), CP_OUTSIDE_MODEL);
    unsigned crossing = validity_of(&car, &car, 50.0, 20.0, -2500.0, 90.0, 0);
    assert_true(crossing & CP_OUTSIDE_OPPONENT_STRUCTURE);
    assert_true(crossing & CP_OUTSIDE_OBLIQUE_VELOCITY);
    assert_true(validity_of(&car, &car, 50.0, 20.0, -2500.0, 90.0, 1) & CP_OUTSIDE_CONTACT_SIDE);
}

static void speed_counts_by_mass(void **state)
{
    (void)state;
    // Closing 100 km/h: equal masses 50 each; against twice the mass the light car gets 66.7.
    cp_vehicle_model car = calibrated_car(), heavy = calibrated_car();
    heavy.mass_kg = 2.0 * car.mass_kg;
    assert_int_equal(validity_of(&car, &car, 50.0, 50.0, 0.0, 0.0, 0), 0);
    assert_int_equal(validity_of(&car, &heavy, 50.0, 50.0, 0.0, 0.0, 0), CP_OUTSIDE_SPEED);
    assert_int_equal(validity_of(&car, &heavy, 50.0, 50.0, 0.0, 0.0, 1), 0);
}

static void the_text_lists_all_reasons(void **state)
{
    (void)state;
    char text[CP_VALIDITY_TEXT_SIZE];
    assert_string_equal(cp_validity_text(0, text), "inside");
    assert_string_equal(cp_validity_text(CP_OUTSIDE_ANGLE | CP_OUTSIDE_SPEED, text), "speed,angle");
    unsigned all = ~0u;
    assert_true(strlen(cp_validity_text(all, text)) < CP_VALIDITY_TEXT_SIZE - 1);
    assert_non_null(strstr(text, "model"));
}

static void how_models_meet(void **state)
{
    (void)state;
    char text[CP_VALIDITY_TEXT_SIZE];
    assert_int_equal(cp_validity_of_meeting(true, 0.5), 0);
    assert_int_equal(cp_validity_of_meeting(true, -0.51), CP_OUTSIDE_MOVED);
    assert_string_equal(cp_validity_text(cp_validity_of_meeting(true, 0.51), text), "moved");
    assert_string_equal(cp_validity_text(cp_validity_of_meeting(false, 9.0), text), "no_contact");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_reference_study_is_inside), cmocka_unit_test(every_limit_is_named),
        cmocka_unit_test(speed_counts_by_mass),          cmocka_unit_test(how_models_meet),
        cmocka_unit_test(the_text_lists_all_reasons),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
