/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/fleet_car.h"

#include "crash/drawn_car.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Studies with a fleet and no scenario: which car each vehicle id crashes as. */

static cp_study_market market[2] = {{"car", "suv", 0.25, 7}, {"car", "pickup", 0.75, 8}};

typedef struct fleet_study {
    cp_study_vehicle vehicles[2];
    cp_study study;
    cp_fleet fleet;
} fleet_study;

static void begin(fleet_study *f, uint64_t seed, size_t replication)
{
    cp_error error = {0};
    *f = (fleet_study){.vehicles = {{0}, {.type = "mapped", .model_name = "mid_size"}}};
    f->study = (cp_study){.path = "study.yaml",
                          .seed = seed,
                          .vehicles = f->vehicles,
                          .vehicle_count = 2,
                          .has_fleet = true,
                          .market = market,
                          .market_count = 2};
    if (cp_fleet_load(&f->study, &f->fleet, &error) != CP_OK)
        fail_msg("%s", error.text);
    cp_fleet_begin(&f->fleet, replication);
}

static const cp_sumo_type MID_SIZE = {"passenger", "", 4.6, 1.8, 1.5, NAN};

static cp_vehicle_model car_of(const fleet_study *f, const char *sumo_type,
                               const cp_sumo_type *type, const char *id, cp_fleet_choice *choice)
{
    cp_vehicle_model car = {0};
    cp_error error = {0};
    if (cp_fleet_car(&f->fleet, "a.sumocfg", sumo_type, type, id, choice, &car, &error) != CP_OK)
        fail_msg("%s", error.text);
    return car;
}

// A draw hangs on seed, replication and id, not on what was drawn before, nor on which worker drew.
static void the_same_vehicle_is_the_same_car(void **state)
{
    (void)state;
    fleet_study one, other;
    cp_fleet_choice choice[2];
    begin(&one, 5, 3);
    begin(&other, 5, 3);
    (void)car_of(&other, "t", &MID_SIZE, "someone.else", &choice[1]);
    for (int k = 9; k >= 0; k--) {
        char id[16];
        snprintf(id, sizeof id, "flow.%d", k);
        cp_vehicle_model a = car_of(&one, "t", &MID_SIZE, id, &choice[0]);
        snprintf(id, sizeof id, "flow.%d", 9 - k);
        (void)car_of(&other, "t", &MID_SIZE, id, &choice[1]);
        snprintf(id, sizeof id, "flow.%d", k);
        cp_vehicle_model b = car_of(&other, "t", &MID_SIZE, id, &choice[1]);
        assert_string_equal(choice[0].model->name, choice[1].model->name);
        assert_string_equal(choice[0].chosen_by, "fleet");
        assert_memory_equal(&a, &b, sizeof a);
    }
    cp_fleet_destroy(&one.fleet);
    cp_fleet_destroy(&other.fleet);
}

static double mass_of(uint64_t seed, size_t replication, const char *id)
{
    fleet_study f;
    cp_fleet_choice choice;
    begin(&f, seed, replication);
    double mass_kg = car_of(&f, "t", &MID_SIZE, id, &choice).mass_kg;
    cp_fleet_destroy(&f.fleet);
    return mass_kg;
}

static void another_seed_replication_or_vehicle_is_another_car(void **state)
{
    (void)state;
    double mass_kg = mass_of(5, 3, "flow.1");
    assert_true(mass_kg == mass_of(5, 3, "flow.1"));
    assert_true(mass_kg != mass_of(6, 3, "flow.1"));
    assert_true(mass_kg != mass_of(5, 4, "flow.1"));
    assert_true(mass_kg != mass_of(5, 3, "flow.2"));
}

static void the_market_sets_the_shares_of_its_type(void **state)
{
    (void)state;
    enum { COUNT = 2000 };
    fleet_study f;
    cp_fleet_choice choice;
    int suvs = 0;
    begin(&f, 5, 0);
    for (int k = 0; k < COUNT; k++) {
        char id[16];
        snprintf(id, sizeof id, "v%d", k);
        (void)car_of(&f, "car", &MID_SIZE, id, &choice);
        assert_string_equal(choice.chosen_by, "market");
        suvs += strcmp(choice.model->name, "suv") == 0;
        assert_true(strcmp(choice.model->name, "suv") == 0 ||
                    strcmp(choice.model->name, "pickup") == 0);
    }
    // Four standard errors of a share of a quarter.
    assert_true(fabs(suvs / (double)COUNT - 0.25) < 4.0 * sqrt(0.25 * 0.75 / COUNT));
    cp_fleet_destroy(&f.fleet);
}

// A named car is that car; a named class is drawn from; what nothing holds has no model.
static void names_come_first(void **state)
{
    (void)state;
    fleet_study f;
    cp_fleet_choice choice;
    begin(&f, 5, 0);
    cp_vehicle_model car = car_of(&f, "mapped", &MID_SIZE, "v", &choice);
    assert_string_equal(choice.chosen_by, "study");
    assert_true(car.mass_kg == choice.model->mass_kg);
    cp_sumo_type named = {"passenger", "suv", 4.6, 1.8, 1.5, NAN};
    car = car_of(&f, "t", &named, "v", &choice);
    assert_string_equal(choice.chosen_by, "sumo_type");
    assert_string_equal(choice.model->name, "suv");
    assert_true(car.mass_kg != choice.model->mass_kg);
    cp_sumo_type bicycle = {"bicycle", "", 1.6, 0.7, 1.7, NAN};
    (void)car_of(&f, "t", &bicycle, "v", &choice);
    assert_null(choice.model);
    assert_string_equal(choice.reason, "no shipped model of vClass bicycle");
    cp_fleet_destroy(&f.fleet);
}

// Without a fleet nothing scatters, but a truck is as long as the vehicle.
static void without_a_fleet_only_heavy_vehicles_are_sized(void **state)
{
    (void)state;
    fleet_study f;
    cp_fleet_choice choice;
    begin(&f, 5, 0);
    f.study.has_fleet = false;
    cp_vehicle_model car = car_of(&f, "t", &MID_SIZE, "v", &choice);
    assert_string_equal(choice.model->name, "honda_accord_2014");
    assert_true(car.mass_kg == choice.model->mass_kg && car.length_m == choice.model->length_m);
    cp_sumo_type truck = {"truck", "", 7.1, 2.4, 2.4, NAN};
    car = car_of(&f, "t", &truck, "v", &choice);
    assert_string_equal(choice.model->name, "rigid_truck");
    assert_true(car.length_m == 7.1 && car.mass_kg == choice.model->mass_kg);
    cp_fleet_destroy(&f.fleet);
}

static void a_market_names_classes_only(void **state)
{
    (void)state;
    cp_study_market wrong[1] = {{"car", "limousine", 1.0, 9}};
    cp_study study = {.path = "study.yaml", .has_fleet = true, .market = wrong, .market_count = 1};
    cp_error error = {0};
    assert_int_equal(cp_fleet_check_market(&study, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "study.yaml:9: vehicles.market[0].class"));
    assert_non_null(strstr(error.text, "'limousine'; there are small_car, "));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_vehicle_is_the_same_car),
        cmocka_unit_test(another_seed_replication_or_vehicle_is_another_car),
        cmocka_unit_test(the_market_sets_the_shares_of_its_type),
        cmocka_unit_test(names_come_first),
        cmocka_unit_test(without_a_fleet_only_heavy_vehicles_are_sized),
        cmocka_unit_test(a_market_names_classes_only),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
