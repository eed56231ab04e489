/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "crash/parameter_scatter.h"

#include <stdio.h>
#include <string.h>

static cp_vehicle_model scattered_car(const char *parameter, double scatter_1)
{
    cp_vehicle_model model = cp_vehicle_model_default();
    model.scatter_1[cp_vehicle_parameter_index(parameter)] = scatter_1;
    return model;
}

static cp_vehicle_model draw(const cp_vehicle_model *model, uint64_t seed, uint64_t sample,
                             size_t *redrawn)
{
    cp_vehicle_model drawn;
    cp_error error = {0};
    if (cp_parameter_scatter_draw(model, cp_rng_key_seed(seed), sample, &drawn, redrawn, &error) !=
        CP_OK)
        fail_msg("%s", error.text);
    return drawn;
}

static void draws_have_the_mean_and_the_deviation_of_the_file(void **state)
{
    (void)state;
    cp_vehicle_model model = scattered_car("friction_1", 0.1);
    enum { COUNT = 20000 };
    double sum = 0.0, squares = 0.0;
    for (uint64_t k = 0; k < COUNT; k++) {
        double off = draw(&model, 3, k, NULL).friction_1 / model.friction_1 - 1.0;
        sum += off;
        squares += off * off;
    }
    // Five standard errors.
    assert_near(sum / COUNT, 0.0, 5.0 * 0.1 / sqrt(COUNT));
    assert_near(sqrt(squares / COUNT), 0.1, 5.0 * 0.1 / sqrt(2.0 * COUNT));
}

static void only_parameters_with_scatter_differ(void **state)
{
    (void)state;
    cp_vehicle_model model = scattered_car("mass_kg", 0.05);
    assert_int_equal(cp_parameter_scatter_count(&model), 1);
    cp_vehicle_model drawn = draw(&model, 1, 7, NULL);
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++) {
        double expected = cp_vehicle_model_get(&model, k), found = cp_vehicle_model_get(&drawn, k);
        assert_true((expected == found) == (strcmp(CP_VEHICLE_PARAMETER[k].name, "mass_kg") != 0));
    }
}

static void a_draw_depends_on_nothing_but_what_it_is_for(void **state)
{
    (void)state;
    cp_vehicle_model one = scattered_car("mass_kg", 0.03), two = one;
    two.scatter_1[cp_vehicle_parameter_index("friction_1")] = 0.2;
    double backwards[20];
    for (int k = 19; k >= 0; k--)
        backwards[k] = draw(&one, 5, (uint64_t)k, NULL).mass_kg;
    for (int k = 0; k < 20; k++) {
        assert_near(draw(&one, 5, (uint64_t)k, NULL).mass_kg, backwards[k], 0.0);
        assert_near(draw(&two, 5, (uint64_t)k, NULL).mass_kg, backwards[k], 0.0);
        assert_true(draw(&one, 6, (uint64_t)k, NULL).mass_kg != backwards[k]);
        assert_true(k == 0 || backwards[k] != backwards[k - 1]);
    }
}

static void draws_stay_within_the_bounds_of_the_file(void **state)
{
    (void)state;
    cp_vehicle_model model = scattered_car("mass_kg", 0.1);
    size_t mass = cp_vehicle_parameter_index("mass_kg");
    model.smallest[mass] = 1600.0;
    model.largest[mass] = 1650.0;
    for (uint64_t k = 0; k < 500; k++) {
        double mass_kg = draw(&model, 2, k, NULL).mass_kg;
        assert_true(mass_kg >= 1600.0 && mass_kg <= 1650.0);
    }
}

static void cars_that_do_not_fit_together_are_drawn_again(void **state)
{
    (void)state;
    // A crash box may collapse by 0.16 m of its 0.2 m: wide scatter would often exceed that.
    cp_vehicle_model model = scattered_car("crash_box_collapse_end_m", 0.4);
    size_t again = 0;
    for (uint64_t k = 0; k < 300; k++) {
        size_t redrawn = 0;
        cp_vehicle_model drawn = draw(&model, 2, k, &redrawn);
        cp_error error = {0};
        assert_int_equal(cp_vehicle_model_validate(&drawn, &error), CP_OK);
        again += redrawn;
    }
    // P(value > 0.2 m | within the table's bounds) is about a quarter.
    assert_in_range(again, 50, 200);
}

static void bounds_that_hold_nothing_are_an_error(void **state)
{
    (void)state;
    cp_vehicle_model model = scattered_car("mass_kg", 0.001), drawn;
    model.smallest[cp_vehicle_parameter_index("mass_kg")] = 1800.0;
    cp_error error = {0};
    assert_int_equal(cp_parameter_scatter_draw(&model, cp_rng_key_seed(1), 0, &drawn, NULL, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "mass_kg"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(draws_have_the_mean_and_the_deviation_of_the_file),
        cmocka_unit_test(only_parameters_with_scatter_differ),
        cmocka_unit_test(a_draw_depends_on_nothing_but_what_it_is_for),
        cmocka_unit_test(draws_stay_within_the_bounds_of_the_file),
        cmocka_unit_test(cars_that_do_not_fit_together_are_drawn_again),
        cmocka_unit_test(bounds_that_hold_nothing_are_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
