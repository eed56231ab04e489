/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "crash/shipped_vehicle.h"
#include "crash/vehicle_choice.h"
#include "crash/vehicle_model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *choose(const char *vehicle_class, double length_m, double width_m,
                          double height_m, double mass_kg, char reason[CP_CHOICE_REASON_SIZE])
{
    cp_vehicle_size size = {vehicle_class, length_m, width_m, height_m, mass_kg};
    bool is_car;
    reason[0] = '\0';
    return cp_vehicle_choose(&size, &is_car, reason);
}

static void cars_of_every_size(void **state)
{
    (void)state;
    char reason[CP_CHOICE_REASON_SIZE];
    // SUMO's own standard sizes first.
    static const struct {
        const char *vehicle_class;
        double length_m, width_m, height_m, mass_kg;
        const char *vehicle;
    } CASE[] = {{"passenger", 5.0, 1.8, 1.5, NAN, "honda_accord_2014"},
                {"taxi", 5.0, 1.8, 1.5, NAN, "honda_accord_2014"},
                {"emergency", 6.5, 2.16, 2.86, NAN, "van"},
                {"delivery", 6.5, 2.16, 2.86, NAN, "van"},
                {"passenger", 3.9, 1.72, 1.5, NAN, "small_car"},
                {"passenger", 4.42, 1.8, NAN, NAN, "small_car"},
                {"passenger", 4.43, 1.8, NAN, NAN, "honda_accord_2014"},
                {"evehicle", 4.7, 1.85, 1.45, 1850, "honda_accord_2014"},
                {"passenger", 4.8, 1.95, 1.75, NAN, "suv"},
                {"private", 5.3, 1.99, 2.1, 2400, "van"},
                {"delivery", 5.3, 1.99, 1.97, NAN, "van"}};
    for (size_t k = 0; k < sizeof CASE / sizeof CASE[0]; k++) {
        const char *chosen = choose(CASE[k].vehicle_class, CASE[k].length_m, CASE[k].width_m,
                                    CASE[k].height_m, CASE[k].mass_kg, reason);
        if (chosen == NULL || strcmp(chosen, CASE[k].vehicle) != 0)
            fail_msg("case %zu: %s (%s) instead of %s", k, chosen ? chosen : "none", reason,
                     CASE[k].vehicle);
    }
}

static void what_is_no_car_has_no_model(void **state)
{
    (void)state;
    char reason[CP_CHOICE_REASON_SIZE];
    static const char *const OTHERS[] = {"truck", "trailer", "bus",  "coach",      "motorcycle",
                                         "moped", "bicycle", "tram", "pedestrian", "rail",
                                         "ship",  "custom1", "army", "ignoring",   ""};
    for (size_t k = 0; k < sizeof OTHERS / sizeof OTHERS[0]; k++) {
        assert_null(choose(OTHERS[k], 4.8, 1.85, 1.5, NAN, reason));
        assert_non_null(strstr(reason, "no shipped model of vClass"));
        assert_non_null(strstr(reason, OTHERS[k]));
    }

    // A bus drawn as a passenger car, and cars that are none by one measure each.
    assert_null(choose("passenger", 12.0, 2.5, 3.4, NAN, reason));
    assert_string_equal(
        reason, "no shipped model of vClass passenger is 12 m long, 2.5 m wide, 3.4 m high");
    assert_null(choose("passenger", 4.8, 2.3, 1.5, NAN, reason));
    assert_null(choose("passenger", 2.7, 1.6, 1.5, NAN, reason));
    assert_null(choose("passenger", 4.8, 1.85, 1.5, 3000, reason));
    assert_string_equal(
        reason,
        "no shipped model of vClass passenger is 4.8 m long, 1.85 m wide, 1.5 m high, 3000 kg");
    assert_null(choose("delivery", 7.5, 2.16, 2.86, NAN, reason));
}

// Every row of the table names a shipped vehicle, which the row itself holds.
static void every_row_holds_its_own_vehicle(void **state)
{
    (void)state;
#define CHECK(vehicle, car, van, l0, l1, w0, w1, h0, h1, m0, m1)                                   \
    {                                                                                              \
        cp_shipped_vehicle shipped;                                                                \
        cp_vehicle_model model;                                                                    \
        cp_error error = {0};                                                                      \
        char reason[CP_CHOICE_REASON_SIZE];                                                        \
        assert_true(cp_shipped_vehicle_find(#vehicle, &shipped));                                  \
        assert_int_equal(                                                                          \
            cp_vehicle_model_parse(shipped.name, shipped.yaml, shipped.size, &model, &error),      \
            CP_OK);                                                                                \
        const char *chosen = choose((car) ? "passenger" : "delivery", model.length_m,              \
                                    model.width_m, 0.5 * ((h0) + (h1)), model.mass_kg, reason);    \
        assert_non_null(chosen);                                                                   \
        assert_string_equal(chosen, #vehicle);                                                     \
    }
    CP_VEHICLE_CHOICES(CHECK)
#undef CHECK
}

static void shipped_vehicles_are_their_files(void **state)
{
    (void)state;
    cp_shipped_vehicle shipped;
    for (size_t k = 0; k < CP_SHIPPED_VEHICLE_COUNT; k++) {
        char path[4096];
        cp_vehicle_model inside, file;
        cp_error error = {0};
        shipped = cp_shipped_vehicle_at(k);
        snprintf(path, sizeof path, "%s/db/vehicles/%s.yaml", getenv("CRASHPULSE_SOURCE"),
                 shipped.name);
        assert_int_equal(
            cp_vehicle_model_parse(shipped.name, shipped.yaml, shipped.size, &inside, &error),
            CP_OK);
        assert_int_equal(cp_vehicle_model_load(path, &file, &error), CP_OK);
        assert_string_equal(inside.hash, file.hash);
        assert_string_equal(inside.name, shipped.name);
        assert_non_null(strstr(cp_shipped_vehicle_names(), shipped.name));
    }
    assert_false(cp_shipped_vehicle_find("default", &shipped));
    assert_false(cp_shipped_vehicle_is_path("suv"));
    assert_true(cp_shipped_vehicle_is_path("suv.yaml"));
    assert_true(cp_shipped_vehicle_is_path("cars/suv"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cars_of_every_size),
        cmocka_unit_test(what_is_no_car_has_no_model),
        cmocka_unit_test(every_row_holds_its_own_vehicle),
        cmocka_unit_test(shipped_vehicles_are_their_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
