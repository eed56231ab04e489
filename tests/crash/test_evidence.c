/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "builders/crash_builder.h"
#include "crash/evidence.h"
#include "crash/shipped_vehicle.h"
#include "crash/validity.h"

#include <math.h>
#include <string.h>

static cp_vehicle_model shipped(const char *name)
{
    cp_shipped_vehicle file;
    cp_vehicle_model model;
    cp_error error = {0};
    assert_true(cp_shipped_vehicle_find(name, &file));
    assert_int_equal(cp_vehicle_model_parse(name, file.yaml, file.size, &model, &error), CP_OK);
    return model;
}

// The table is of the files as they are: else 'cmake --build build --target evidence' was not run.
static void rows_are_of_the_shipped_files(void **state)
{
    (void)state;
    assert_true(cp_evidence_count() > 50);
    for (size_t k = 0; k < cp_evidence_count(); k++) {
        const cp_evidence *row = cp_evidence_at(k);
        cp_vehicle_model model = shipped(row->vehicle);
        if (strcmp(row->vehicle_hash, model.hash) != 0)
            fail_msg("%s of class %s was judged as another file", row->vehicle, row->name);
        assert_true(row->speed_min_km_h < row->speed_max_km_h);
        assert_true(row->overlap_min_1 < row->overlap_max_1 && row->overlap_max_1 <= 1.0);
        assert_true(row->error_1 > 0.0 && (row->error_1 < 1.0 || !row->kept));
        assert_true(cp_evidence_judges(&model));
    }
}

static const char *class_of(const cp_vehicle_model *model, cp_evidence_case crash,
                            unsigned *outside)
{
    const cp_evidence *found = cp_evidence_find(model, &crash, outside);
    return found != NULL ? found->name : "none";
}

static void a_crash_lies_in_the_first_class_around_it(void **state)
{
    (void)state;
    cp_vehicle_model car = shipped("mid_size_car");
    static const struct {
        cp_evidence_case crash;
        const char *name;
        unsigned outside;
    } CASE[] = {
        {{"front", 50, 1.0, 0, 0}, "wall", 0},
        {{"front", 50, NAN, 0, 0}, "wall", 0},
        {{"front", 32, 0.7, -10, 15}, "wall", 0},
        {{"front", 64, 0.25, 5, 0}, "small_overlap", 0},
        {{"front", 50, 0.5, 0, 0}, "offset", 0},
        {{"front", 40, 0.9, -30, 0}, "wall_30deg", 0},
        {{"front", 56, 0.4, 25, 0}, "turned", 0},
        {{"front", 10, 1.0, 0, 0}, "low_speed", 0},
        {{"front", 20, 0.5, 0, 0}, "low_speed_offset", 0},
        {{"front", 20, 0.5, 35, 0}, "low_speed_turned", 0},
        {{"front", 80, 1.0, 0, 0}, "none", CP_OUTSIDE_SPEED},
        {{"front", 50, 0.05, 0, 0}, "none", CP_OUTSIDE_OFFSET},
        {{"front", 50, 0.9, 60, 0}, "none", CP_OUTSIDE_ANGLE},
        {{"front", 50, 0.9, 0, -20}, "none", CP_OUTSIDE_OBLIQUE_VELOCITY},
        {{"front", 80, 0.05, 60, 0},
         "none",
         CP_OUTSIDE_SPEED | CP_OUTSIDE_OFFSET | CP_OUTSIDE_ANGLE},
    };
    for (size_t k = 0; k < sizeof CASE / sizeof CASE[0]; k++) {
        unsigned outside = 0;
        const char *name = class_of(&car, CASE[k].crash, &outside);
        if (strcmp(name, CASE[k].name) != 0 || outside != CASE[k].outside)
            fail_msg("case %zu: %s, outside %x", k, name, outside);
    }
}

static void what_keeps_no_bar_is_outside_everywhere(void **state)
{
    (void)state;
    cp_vehicle_model accord = shipped("honda_accord_2014");
    unsigned outside = 0;
    assert_string_equal(class_of(&accord, (cp_evidence_case){"front", 50, 1, 0, 0}, &outside),
                        "none");
    assert_int_equal(outside, CP_OUTSIDE_MODEL);

    // Another file of that name was never judged.
    cp_vehicle_model other = shipped("mid_size_car");
    assert_true(cp_evidence_judges(&other));
    other.hash[0] = other.hash[0] == 'a' ? 'b' : 'a';
    assert_false(cp_evidence_judges(&other));
}

static unsigned validity_of(const cp_vehicle_model *a, const cp_vehicle_model *b, double offset_mm,
                            int role, cp_validity_ground *ground)
{
    cp_crash_configuration configuration =
        crash_builder_configuration(a, b, 45.0, 45.0, offset_mm, 0.0);
    cp_crash_description description =
        cp_crash_describe(a, b, &configuration, cp_crash_contact_point(a, b, &configuration));
    return cp_validity(a, b, &configuration, &description, role, ground);
}

static void validity_comes_with_class_and_error(void **state)
{
    (void)state;
    cp_vehicle_model car = shipped("mid_size_car"), suv = shipped("suv"), bus = shipped("bus");
    cp_validity_ground ground;
    assert_int_equal(validity_of(&car, &suv, 0.0, 0, &ground), 0);
    assert_string_equal(ground.evidence_class, "wall");
    assert_true(ground.error_1 > 0.0);
    assert_int_equal(validity_of(&car, &suv, 700.0, 1, &ground), 0);
    assert_string_equal(ground.evidence_class, "offset");

    // Against what weighs more than 3.5 t no test speaks, nor for it.
    assert_true(validity_of(&car, &bus, 0.0, 0, &ground) & CP_OUTSIDE_OPPONENT_STRUCTURE);
    assert_null(ground.evidence_class);
    assert_true(validity_of(&car, &bus, 0.0, 1, &ground) & CP_OUTSIDE_MODEL);

    // A file that was not judged keeps its own range, without an error.
    cp_vehicle_model own = shipped("mid_size_car");
    own.hash[0] = '-';
    assert_int_equal(validity_of(&own, &suv, 0.0, 0, &ground), 0);
    assert_string_equal(ground.evidence_class, CP_EVIDENCE_OWN);
    assert_true(isnan(ground.error_1));
    assert_int_equal(validity_of(&own, &suv, 700.0, 0, &ground), CP_OUTSIDE_OFFSET);
}

// b's share of overlap is of its own width.
static void overlap_is_of_the_own_width(void **state)
{
    (void)state;
    cp_vehicle_model car = shipped("small_car"), pickup = shipped("pickup");
    cp_crash_configuration configuration =
        crash_builder_configuration(&car, &pickup, 45.0, 45.0, 600.0, 0.0);
    cp_crash_description description = cp_crash_describe(
        &car, &pickup, &configuration, cp_crash_contact_point(&car, &pickup, &configuration));
    double covered_m[2];
    for (int role = 0; role < 2; role++)
        covered_m[role] =
            cp_evidence_case_of(&car, &pickup, &configuration, &description, role).overlap_1 *
            (role == 0 ? car.width_m : pickup.width_m);
    assert_near(covered_m[0], covered_m[1], 1e-9);
    assert_near(covered_m[0], 0.5 * (car.width_m + pickup.width_m) - 0.6, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_of_the_shipped_files),
        cmocka_unit_test(a_crash_lies_in_the_first_class_around_it),
        cmocka_unit_test(what_keeps_no_bar_is_outside_everywhere),
        cmocka_unit_test(validity_comes_with_class_and_error),
        cmocka_unit_test(overlap_is_of_the_own_width),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
