/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "crash/vehicle_model.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Write text to a temporary file, load it, remove it.
static cp_status load_text(const char *text, cp_vehicle_model *model, cp_error *error)
{
    char path[] = "/tmp/vehicle_XXXXXX";
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, text, strlen(text)), (ssize_t)strlen(text));
    close(descriptor);
    cp_status status = cp_vehicle_model_load(path, model, error);
    unlink(path);
    return status;
}

static void expect_refusal(const char *text, const char *place, const char *words)
{
    cp_vehicle_model model;
    cp_error error = {0};
    assert_int_equal(load_text(text, &model, &error), CP_BAD_INPUT);
    if (strstr(error.text, place) == NULL || strstr(error.text, words) == NULL)
        fail_msg("expected '%s' and '%s' in: %s", place, words, error.text);
}

static void an_ensemble_is_read_set_by_set(void **state)
{
    (void)state;
    cp_vehicle_model model;
    cp_error error = {0};
    cp_status status = load_text("vehicle: x\nparameters:\n  - {name: friction_1, value: 0.4}\n"
                                 "ensemble:\n  - {name: friction_1, values: [0.35, 0.5]}\n"
                                 "  - {name: cell_edge_kn, values: [150, 190]}\n",
                                 &model, &error);
    if (status != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(model.member_count, 2);
    cp_vehicle_model second = cp_vehicle_model_member(&model, 1);
    assert_near(second.friction_1, 0.5, 0.0);
    assert_near(second.cell_edge_kn, 190.0, 0.0);
    assert_near(second.mass_kg, model.mass_kg, 0.0);
    assert_near(model.friction_1, 0.4, 0.0);

    // A stretched outline stays stretched.
    cp_vehicle_model covering = cp_vehicle_model_cover(&model, 6.0, 2.0);
    assert_near(cp_vehicle_model_member(&covering, 0).length_m, 6.0, 0.0);

    expect_refusal("vehicle: x\nparameters: []\nensemble:\n  - {name: friction_1, values: [1, 1]}\n"
                   "  - {name: cell_kn, values: [500]}\n",
                   ":5: ensemble[1].values", "as many values as the first parameter's, 2, found 1");
    expect_refusal(
        "vehicle: x\nparameters: []\nensemble:\n  - {name: friction_1, values: [0.4, 7]}\n",
        "ensemble[0].values[1]", "between 0 and 1.5");
    expect_refusal("vehicle: x\nparameters: []\nensemble:\n  - {name: mass_kg, values: [500]}\n",
                   "set 1 of the ensemble", "mass_kg must leave");
}

// A file made for an earlier version of the model is read; what it no longer has is not used.
static void former_parameters_are_read_and_not_used(void **state)
{
    (void)state;
    cp_vehicle_model model;
    cp_error error = {0};
    cp_status status = load_text("vehicle: x\nparameters:\n"
                                 "  - {name: member_damping_kn_s_m, value: 2.7, unit: kN s/m}\n"
                                 "  - {name: longitudinal_collapse_begin_kn, value: 100}\n"
                                 "  - {name: longitudinal_collapse_end_kn, value: 300}\n"
                                 "  - {name: crush_rate_s_m, value: 0.02}\n",
                                 &model, &error);
    if (status != CP_OK)
        fail_msg("%s", error.text);
    assert_near(model.longitudinal_collapse_middle_kn, 200.0, 1e-12);
    assert_near(model.strain_rate_gain_1, cp_vehicle_model_default().strain_rate_gain_1, 0.0);
}

static void the_default_is_valid(void **state)
{
    (void)state;
    cp_vehicle_model model = cp_vehicle_model_default();
    cp_error error = {0};
    if (cp_vehicle_model_validate(&model, &error) != CP_OK)
        fail_msg("%s", error.text);
}

static void a_file_sets_what_it_names(void **state)
{
    (void)state;
    cp_vehicle_model model;
    cp_error error = {0};
    cp_status status = load_text("vehicle: test_car\n"
                                 "calibrated: {speed_min_km_h: 25, speed_max_km_h: 56, "
                                 "offset_max_mm: 1050, angle_max_deg: 30}\n"
                                 "parameters:\n"
                                 "  - {name: mass_kg, value: 1500, unit: kg, source: scale}\n"
                                 "  - {name: friction_1, value: 0.3, scatter: 0.1, min: 0.2, "
                                 "max: 0.6}\n",
                                 &model, &error);
    if (status != CP_OK)
        fail_msg("%s", error.text);
    assert_string_equal(model.name, "test_car");
    assert_near(model.mass_kg, 1500.0, 0.0);
    assert_near(model.friction_1, 0.3, 0.0);
    size_t friction = cp_vehicle_parameter_index("friction_1");
    assert_near(model.scatter_1[friction], 0.1, 0.0);
    assert_near(model.smallest[friction], 0.2, 0.0);
    assert_near(model.largest[friction], 0.6, 0.0);
    assert_near(model.largest[0], CP_VEHICLE_PARAMETER[0].largest, 0.0);
    assert_near(model.width_m, cp_vehicle_model_default().width_m, 0.0);
    assert_near(model.calibrated_speed_max_m_s, 56.0 / 3.6, 1e-12);
    assert_near(model.calibrated_offset_max_m, 1.05, 1e-12);
    assert_int_equal(strlen(model.hash), 64);
}

static void every_error_names_line_and_field(void **state)
{
    (void)state;
    expect_refusal("", ":", "empty");
    expect_refusal("vehicle: x\nparameters:\n  - {name: mass_kg, value: heavy}\n",
                   ":3:", "must be a number from 500 to 60000, found 'heavy'");
    expect_refusal("vehicle: x\nparameters:\n  - {name: mass_kg, value: nan}\n", ":3:", "'nan'");
    expect_refusal("vehicle: x\nparameters:\n  - {name: mass_kg, value: 20}\n",
                   ":3:", "between 500 and 60000, found 20");
    expect_refusal("vehicle: x\nparameters:\n  - {name: mess_kg, value: 20}\n", ":3:", "mess_kg");
    expect_refusal("vehicle: x\nparameters:\n  - {name: corner_strips_1, value: 2.5}\n", ":",
                   "corner_strips_1 must be a whole number, found 2.5");
    expect_refusal("vehicle: x\nparameters:\n  - {name: mass_kg, value: 1500}\n"
                   "  - {name: mass_kg, value: 1600}\n",
                   ":4:", "given twice");
    expect_refusal("vehicle: x\nparameters:\n  - {name: mass_kg, value: 1500, unit: t}\n",
                   ":3:", "unit must be 'kg'");
    expect_refusal("vehicle: x\nwheels: 4\nparameters: []\n", ":2", "wheels");
    expect_refusal("vehicle: x\nparameters: [\n", ":", "");
}

static void fields_must_fit_each_other(void **state)
{
    (void)state;
    expect_refusal("vehicle: x\nparameters:\n  - {name: crash_box_collapse_end_m, value: 0.3}\n",
                   "", "crash_box_collapse_end_m must not exceed");
    expect_refusal("vehicle: x\nparameters:\n  - {name: engine_gap_front_m, value: 0.75}\n", "",
                   "engine_gap_front_m");
    expect_refusal("vehicle: x\nparameters:\n  - {name: mass_kg, value: 550}\n", "", "mass_kg");
}

// Half of a length, both written with nine digits, is no more than half of it.
static void rounding_of_a_file_is_no_error(void **state)
{
    (void)state;
    cp_vehicle_model model;
    cp_error error = {0};
    cp_status status =
        load_text("vehicle: x\nbarrier: {width_m: 2, depth_m: 0.619412345, corner_radius_m: "
                  "0.309706173, pivot_m: 0}\nparameters:\n  - {name: crash_box_length_m, value: "
                  "0.200000001}\n  - {name: crash_box_collapse_end_m, value: 0.200000002}\n",
                  &model, &error);
    if (status != CP_OK)
        fail_msg("%s", error.text);
    cp_outline outline = cp_barrier_outline(&model.barrier, (cp_pose){{0.0, 0.0}, 0.0});
    assert_true(outline.radius_m <= outline.half_length_m);
    expect_refusal("vehicle: x\nbarrier: {width_m: 2, depth_m: 0.6, corner_radius_m: 0.31, "
                   "pivot_m: 0}\nparameters: []\n",
                   "", "corner_radius_m");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_default_is_valid),
        cmocka_unit_test(an_ensemble_is_read_set_by_set),
        cmocka_unit_test(former_parameters_are_read_and_not_used),
        cmocka_unit_test(a_file_sets_what_it_names),
        cmocka_unit_test(every_error_names_line_and_field),
        cmocka_unit_test(fields_must_fit_each_other),
        cmocka_unit_test(rounding_of_a_file_is_no_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
