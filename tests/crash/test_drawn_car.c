/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "crash/drawn_car.h"
#include "crash/shipped_vehicle.h"

#include <math.h>
#include <string.h>

static cp_vehicle_model class_of(const char *name)
{
    cp_shipped_vehicle shipped;
    cp_vehicle_model model;
    cp_error error = {0};
    assert_true(cp_shipped_vehicle_find(name, &shipped));
    if (cp_vehicle_model_parse(shipped.name, shipped.yaml, shipped.size, &model, &error) != CP_OK)
        fail_msg("%s", error.text);
    return model;
}

static cp_vehicle_model draw(const cp_vehicle_model *of_class, bool scatters, double length_m,
                             double mass_kg, uint64_t key)
{
    cp_vehicle_model drawn;
    cp_error error = {0};
    const cp_vehicle_size size = {"passenger", length_m, 1.8, 1.5, mass_kg};
    if (cp_drawn_car(of_class, scatters, &size, cp_rng_key_seed(key), &drawn, &error) != CP_OK)
        fail_msg("%s", error.text);
    return drawn;
}

// Bounds of the file, mean and deviation of the class's mass.
static void masses_scatter_as_the_class_does(void **state)
{
    (void)state;
    enum { COUNT = 3000 };
    cp_vehicle_model suv = class_of("suv");
    size_t mass = cp_vehicle_parameter_index("mass_kg");
    double sum = 0.0, squares = 0.0;
    for (uint64_t k = 0; k < COUNT; k++) {
        double off = draw(&suv, true, suv.length_m, NAN, k).mass_kg - suv.mass_kg;
        assert_true(off + suv.mass_kg >= suv.smallest[mass] &&
                    off + suv.mass_kg <= suv.largest[mass]);
        sum += off;
        squares += off * off;
    }
    // Cut off at two standard deviations a normal law keeps 0.8796 of its deviation.
    double sd_kg = suv.scatter_1[mass] * suv.mass_kg;
    assert_near(sum / COUNT, 0.0, 5.0 * sd_kg / sqrt(COUNT));
    assert_near(sqrt(squares / COUNT) / sd_kg, 0.8796, 0.05);
}

static void outline_and_inertia_are_the_vehicles(void **state)
{
    (void)state;
    cp_vehicle_model car = class_of("mid_size_car");
    cp_vehicle_model longer = draw(&car, false, car.length_m + 0.3, NAN, 1);
    assert_near(longer.length_m, car.length_m + 0.3, 1e-12);
    assert_true(longer.mass_kg == car.mass_kg);
    double ratio = (longer.length_m * longer.length_m + car.width_m * car.width_m) /
                   (car.length_m * car.length_m + car.width_m * car.width_m);
    assert_near(longer.yaw_inertia_kg_m2, car.yaw_inertia_kg_m2 * ratio, 1e-9);

    // Farther from the class than a class goes the length stays; a mass outside of it stays too.
    assert_true(draw(&car, false, car.length_m + 0.9, NAN, 1).length_m == car.length_m);
    assert_true(draw(&car, false, car.length_m, car.mass_kg + 50.0, 1).mass_kg ==
                car.mass_kg + 50.0);
    assert_true(draw(&car, false, car.length_m, 9000.0, 1).mass_kg == car.mass_kg);

    // A heavy vehicle is as long as the vehicle in any case.
    cp_vehicle_model truck = class_of("rigid_truck");
    assert_true(draw(&truck, false, 6.2, NAN, 1).length_m == 6.2);
}

// The ensemble is of the drawn car, not of the class's.
static void the_ensemble_goes_with_the_car(void **state)
{
    (void)state;
    cp_vehicle_model car = class_of("mid_size_car");
    cp_vehicle_model drawn = draw(&car, true, car.length_m, NAN, 3);
    size_t force = cp_vehicle_parameter_index("longitudinal_collapse_end_kn");
    size_t mass = cp_vehicle_parameter_index("mass_kg");
    assert_true(car.member_count > 0);
    double ratio = cp_vehicle_model_get(&drawn, force) / cp_vehicle_model_get(&car, force);
    assert_true(fabs(ratio - 1.0) > 1e-3);
    for (size_t m = 0; m < car.member_count; m++) {
        assert_near(drawn.member[m][force], car.member[m][force] * ratio, 1e-9);
        assert_true(drawn.member[m][mass] == drawn.mass_kg);
    }
}

static void text_gives_the_same_bits_back(void **state)
{
    (void)state;
    char text[CP_DRAWN_CAR_TEXT_SIZE];
    cp_error error = {0};
    cp_vehicle_model suv = class_of("suv"), back;
    for (uint64_t k = 0; k < 50; k++) {
        cp_vehicle_model drawn = draw(&suv, true, suv.length_m + 0.01, NAN, k);
        cp_drawn_car_text(&suv, &drawn, text);
        assert_int_equal(cp_drawn_car_read(&suv, text, &back, &error), CP_OK);
        for (size_t p = 0; p < CP_VEHICLE_PARAMETER_COUNT; p++)
            assert_true(cp_vehicle_model_get(&drawn, p) == cp_vehicle_model_get(&back, p));
    }
    // Nothing drawn is no text, and no text the class's own car.
    assert_string_equal(cp_drawn_car_text(&suv, &suv, text), "");
    assert_int_equal(cp_drawn_car_read(&suv, "", &back, &error), CP_OK);
    assert_true(back.mass_kg == suv.mass_kg);
}

static void other_texts_are_refused(void **state)
{
    (void)state;
    static const char *const TEXT[] = {"{}",
                                       "{\"mass_kg\":1}",
                                       "{\"mass_kg\":1500",
                                       "{\"mass_kg\":1500} ",
                                       "[\"mass_kg\":1500}",
                                       "{\"mass\":1500}",
                                       "{\"mass_kg\":nan}",
                                       "{\"mass_kg\":}",
                                       "{mass_kg:1500}",
                                       "{\"mass_kg\":1500,}"};
    cp_vehicle_model car = class_of("mid_size_car"), back;
    for (size_t k = 0; k < sizeof TEXT / sizeof TEXT[0]; k++) {
        cp_error error = {0};
        if (cp_drawn_car_read(&car, TEXT[k], &back, &error) != CP_BAD_INPUT)
            fail_msg("'%s' was read", TEXT[k]);
        assert_non_null(strstr(error.text, "what was drawn of a mid_size_car"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(masses_scatter_as_the_class_does),
        cmocka_unit_test(outline_and_inertia_are_the_vehicles),
        cmocka_unit_test(the_ensemble_goes_with_the_car),
        cmocka_unit_test(text_gives_the_same_bits_back),
        cmocka_unit_test(other_texts_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
