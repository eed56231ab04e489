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
    static const char *const OTHERS[] = {"motorcycle", "moped",    "bicycle", "tram",
                                         "pedestrian", "rail",     "ship",    "custom1",
                                         "army",       "ignoring", ""};
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
    assert_null(choose("truck", 4.0, 1.8, 1.9, NAN, reason));
    assert_null(choose("bus", 25.0, 2.5, 3.4, NAN, reason));
}

// SUMO's standard sizes of what weighs more than 3.5 t, and a van that says how heavy it is.
static void heavy_vehicles_have_a_class(void **state)
{
    (void)state;
    char reason[CP_CHOICE_REASON_SIZE];
    static const struct {
        const char *vehicle_class;
        double length_m, width_m, height_m, mass_kg;
        const char *vehicle;
    } CASE[] = {{"truck", 7.1, 2.4, 2.4, NAN, "rigid_truck"},
                {"trailer", 16.5, 2.55, 4.0, NAN, "tractor_trailer"},
                {"truck", 16.5, 2.55, 4.0, NAN, "tractor_trailer"},
                {"bus", 12.0, 2.5, 3.4, NAN, "bus"},
                {"coach", 14.0, 2.6, 4.0, NAN, "bus"},
                {"delivery", 6.5, 2.16, 2.86, 5000, "delivery_van"},
                {"delivery", 7.5, 2.16, 2.86, NAN, "delivery_van"}};
    for (size_t k = 0; k < sizeof CASE / sizeof CASE[0]; k++) {
        const char *chosen = choose(CASE[k].vehicle_class, CASE[k].length_m, CASE[k].width_m,
                                    CASE[k].height_m, CASE[k].mass_kg, reason);
        if (chosen == NULL || strcmp(chosen, CASE[k].vehicle) != 0)
            fail_msg("case %zu: %s (%s) instead of %s", k, chosen ? chosen : "none", reason,
                     CASE[k].vehicle);
    }
}

// Over many draws the classes that hold a size have their shares of the market, others none.
static void classes_are_drawn_by_their_shares(void **state)
{
    (void)state;
    enum { COUNT = 4000 };
    char reason[CP_CHOICE_REASON_SIZE];
    const cp_vehicle_size size = {"passenger", 4.6, 1.8, 1.5, NAN};
    int compact = 0, mid_size = 0;
    for (int k = 0; k < COUNT; k++) {
        const char *drawn = cp_vehicle_draw_class(&size, (k + 0.5) / COUNT, reason);
        compact += strcmp(drawn, "compact_car") == 0;
        mid_size += strcmp(drawn, "mid_size_car") == 0;
    }
    assert_int_equal(compact + mid_size, COUNT);
    assert_true(fabs(compact / (double)COUNT - 0.217 / (0.217 + 0.193)) < 1.0 / COUNT);

    // Ends of the unit interval, a size with one class, one with none.
    assert_string_equal(cp_vehicle_draw_class(&size, 0.0, reason), "compact_car");
    assert_string_equal(cp_vehicle_draw_class(&size, nextafter(1.0, 0.0), reason), "mid_size_car");
    const cp_vehicle_size little = {"taxi", 3.6, 1.7, 1.5, NAN},
                          bike = {"bicycle", 1.6, 0.7, 1.7, NAN};
    assert_string_equal(cp_vehicle_draw_class(&little, 0.99, reason), "small_car");
    assert_null(cp_vehicle_draw_class(&bike, 0.5, reason));
    assert_string_equal(reason, "no shipped model of vClass bicycle");
}

// Every class of the fleet is shipped, and its own car's size draws it for some number.
static void every_class_is_shipped_and_holds_its_own_car(void **state)
{
    (void)state;
    double total = 0.0;
#define CHECK(vehicle, takes, l0, l1, w0, w1, h0, h1, m0, m1, share)                               \
    {                                                                                              \
        cp_shipped_vehicle shipped;                                                                \
        cp_vehicle_model model;                                                                    \
        cp_error error = {0};                                                                      \
        char reason[CP_CHOICE_REASON_SIZE];                                                        \
        bool found = false;                                                                        \
        total += (share);                                                                          \
        assert_true(cp_vehicle_is_fleet_class(#vehicle));                                          \
        assert_true(cp_shipped_vehicle_find(#vehicle, &shipped));                                  \
        assert_int_equal(                                                                          \
            cp_vehicle_model_parse(shipped.name, shipped.yaml, shipped.size, &model, &error),      \
            CP_OK);                                                                                \
        const cp_vehicle_size size = {"passenger", model.length_m, model.width_m,                  \
                                      0.5 * ((h0) + (h1)), model.mass_kg};                         \
        for (int k = 0; k < 100; k++)                                                              \
            found =                                                                                \
                found || strcmp(cp_vehicle_draw_class(&size, k / 100.0, reason), #vehicle) == 0;   \
        assert_true(found);                                                                        \
    }
    CP_FLEET_CLASSES(CHECK)
#undef CHECK
    assert_true(fabs(total - 1.0) < 0.002);
}

static const char *vclass_of(unsigned takes)
{
    return (takes & CP_TAKES_CAR) != 0     ? "passenger"
           : (takes & CP_TAKES_VAN) != 0   ? "delivery"
           : (takes & CP_TAKES_TRUCK) != 0 ? "truck"
                                           : "bus";
}

// Every row of the table names a shipped vehicle, which the row itself holds.
static void every_row_holds_its_own_vehicle(void **state)
{
    (void)state;
#define CHECK(vehicle, takes, l0, l1, w0, w1, h0, h1, m0, m1)                                      \
    {                                                                                              \
        cp_shipped_vehicle shipped;                                                                \
        cp_vehicle_model model;                                                                    \
        cp_error error = {0};                                                                      \
        char reason[CP_CHOICE_REASON_SIZE];                                                        \
        assert_true(cp_shipped_vehicle_find(#vehicle, &shipped));                                  \
        assert_int_equal(                                                                          \
            cp_vehicle_model_parse(shipped.name, shipped.yaml, shipped.size, &model, &error),      \
            CP_OK);                                                                                \
        const char *chosen = choose(vclass_of(takes), model.length_m, model.width_m,               \
                                    0.5 * ((h0) + (h1)), model.mass_kg, reason);                   \
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
        snprintf(path, sizeof path, "%s/db/vehicles/%s%s.yaml", getenv("CRASHPULSE_SOURCE"),
                 cp_vehicle_is_fleet_class(shipped.name) ? "fleet/" : "", shipped.name);
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
        cmocka_unit_test(heavy_vehicles_have_a_class),
        cmocka_unit_test(classes_are_drawn_by_their_shares),
        cmocka_unit_test(every_class_is_shipped_and_holds_its_own_car),
        cmocka_unit_test(every_row_holds_its_own_vehicle),
        cmocka_unit_test(shipped_vehicles_are_their_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
