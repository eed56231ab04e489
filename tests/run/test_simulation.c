/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/simulation.h"

#include "run/run_road.h"

#include <math.h>

/* Simulations on a scripted road: what is found, what counts, what becomes of crashed cars. Two
 * cars on a straight line are at places that a child can work out. */

static const cp_simulation_settings PLAIN = {.step_length_s = ROAD_STEP_S};

// East and west, 10 m/s each, fronts gap_m apart when they come onto the road at 0.1 s.
static void add_head_on(double gap_m, double beside_m)
{
    road_add("east", 0.0, 0.0, 0.0, 10.0);
    road_add("west", gap_m, beside_m, 3.14159265358979323846, 10.0);
}

static void a_crash_is_found_and_its_cars_leave(void **state)
{
    (void)state;
    cp_simulation simulation;
    cp_simulation_settings settings = PLAIN;
    settings.history_s = 1.0;
    run_road_begin(&settings, &simulation);
    add_head_on(51.0, 0.0);
    run_road_until(&simulation, 2.6);
    assert_int_equal(simulation.found_count, 0);
    assert_int_equal(run_road_expected(), 2);
    run_road_until(&simulation, 2.7);

    // 51 m at 20 m/s from 0.1 s on.
    assert_int_equal(simulation.found_count, 1);
    const cp_found_contact *found = &simulation.found[0];
    assert_int_equal(found->found_as, CP_FOUND_CRASH);
    assert_true(fabs(found->impact.time_s - 2.65) < 1e-9);
    assert_string_equal(cp_traffic_vehicle_id(simulation.traffic, found->impact.vehicle[0]),
                        "east");
    assert_int_equal(found->follows, CP_FOLLOWS_NONE);
    for (int role = 0; role < 2; role++) {
        assert_false(found->car[role].at_fault || found->car[role].errs_alone ||
                     found->car[role].had_crashed);
        assert_true(found->car[role].error_since_s == INFINITY);
    }
    assert_int_equal(run_road_expected(), 0);
    assert_true(cp_traffic_finished(simulation.traffic));

    // A second before: 1.7 ... 2.6 s, of each car, east first.
    assert_int_equal(simulation.before_count, 1);
    assert_int_equal(simulation.before[0].count, 20);
    assert_int_equal(simulation.before[0].rows[19].role, 1);
    assert_true(fabs(simulation.before[0].rows[0].time_s - 1.7) < 1e-9);
    assert_true(fabs(simulation.before[0].rows[9].front_m.x - 25.0) < 1e-9);

    // Both drove from 0.1 s to 2.7 s.
    double simulated_s;
    cp_exposure counted = cp_simulation_counted(&simulation, &simulated_s);
    assert_true(fabs(simulated_s - 2.7) < 1e-9);
    assert_true(fabs(counted.vehicle_km - 2 * 26.0 / 1000.0) < 1e-9);
    assert_true(fabs(counted.vehicle_h - 2 * 2.6 / 3600.0) < 1e-9);
    assert_int_equal(counted.departed, 2);
    cp_simulation_end(&simulation);
    assert_null(simulation.found);
}

static void nothing_counts_before_the_warm_up_ends(void **state)
{
    (void)state;
    cp_simulation simulation;
    cp_simulation_settings settings = PLAIN;
    settings.warmup_s = 3.0;
    run_road_begin(&settings, &simulation);
    add_head_on(51.0, 0.0);
    road_add("later", -100.0, 50.0, 0.0, 10.0);
    run_road_until(&simulation, 3.0);
    double simulated_s;
    assert_true(cp_simulation_counted(&simulation, &simulated_s).vehicle_km == 0.0);
    assert_true(simulated_s == 0.0);
    run_road_until(&simulation, 5.0);
    assert_int_equal(simulation.found_count, 1);
    assert_int_equal(simulation.found[0].found_as, CP_FOUND_WARMUP);
    assert_true(cp_found_is_crash(&simulation.found[0]));
    // They have gone all the same; one car drove on for two seconds.
    assert_int_equal(run_road_expected(), 1);
    cp_exposure counted = cp_simulation_counted(&simulation, &simulated_s);
    assert_true(fabs(simulated_s - 2.0) < 1e-9);
    assert_true(fabs(counted.vehicle_km - 0.02) < 1e-9);
    assert_int_equal(counted.departed, 0);
    cp_simulation_end(&simulation);
}

// One car onto two that come side by side: one crash, and one contact after it in the same step.
static void a_car_crashes_once_a_step(void **state)
{
    (void)state;
    cp_simulation simulation;
    run_road_begin(&PLAIN, &simulation);
    add_head_on(51.0, 0.95);
    road_add("west_2", 51.0, -0.95, 3.14159265358979323846, 10.0);
    run_road_until(&simulation, 3.0);
    assert_int_equal(simulation.found_count, 2);
    assert_int_equal(simulation.found[0].found_as, CP_FOUND_CRASH);
    assert_int_equal(simulation.found[1].found_as, CP_FOUND_AFTER_CRASH);
    assert_false(cp_found_is_crash(&simulation.found[1]));
    // The third car crashed into no one that counts, and yet it is off the road.
    assert_int_equal(run_road_expected(), 0);
    cp_simulation_end(&simulation);
}

static void crashed_cars_stay_and_are_hit(void **state)
{
    (void)state;
    cp_simulation simulation;
    cp_simulation_settings settings = PLAIN;
    settings.stay_s = 5.0;
    run_road_begin(&settings, &simulation);
    add_head_on(51.0, 0.0);
    // 50 m behind the first: it meets the standing car's rear some 1.95 s after the crash.
    road_add("behind", -50.0, 0.0, 0.0, 22.0);
    run_road_until(&simulation, 7.0);
    assert_int_equal(simulation.found_count, 2);
    const cp_found_contact *second = &simulation.found[1];
    assert_int_equal(second->found_as, CP_FOUND_CRASH);
    assert_int_equal(second->follows, 0);
    assert_string_equal(cp_traffic_vehicle_id(simulation.traffic, second->impact.vehicle[0]),
                        "behind");
    assert_true(second->impact.side[0] == CP_SIDE_FRONT && second->impact.side[1] == CP_SIDE_REAR);
    assert_false(second->car[0].had_crashed);
    assert_true(second->car[1].had_crashed);
    assert_int_equal(run_road_expected(), 3);
    // Five seconds after the step of the first crash its cars go, later the third.
    run_road_until(&simulation, 7.8);
    assert_int_equal(run_road_expected(), 1);
    run_road_until(&simulation, 10.0);
    assert_int_equal(run_road_expected(), 0);
    cp_simulation_end(&simulation);
}

// What SUMO reports is matched with what is found, with the gap of the rectangles.
static void reports_are_cross_checked(void **state)
{
    (void)state;
    cp_simulation simulation;
    run_road_begin(&PLAIN, &simulation);
    add_head_on(51.0, 0.0);
    road_add("far", 0.0, 20.0, 0.0, 10.0);
    run_road.collisions[0] = (cp_sumo_collision){1, 0, "frontal"};
    run_road.collisions[1] = (cp_sumo_collision){0, 2, "junction"};
    run_road.collision_count = 2;
    run_road_until(&simulation, 4.0);
    cp_cross_check_match(&simulation.check);
    assert_int_equal(simulation.check.sumo_count, 2);
    assert_int_equal(simulation.check.sumo[0].found_as, CP_FOUND_CRASH);
    assert_true(simulation.check.sumo[0].gap_m < 0.0);
    assert_int_equal(simulation.check.sumo[1].found_as, CP_FOUND_NO_CONTACT);
    assert_true(fabs(simulation.check.sumo[1].gap_m - (20.0 - 1.8)) < 1e-9);
    cp_simulation_end(&simulation);
}

static void a_road_that_fails_is_told(void **state)
{
    (void)state;
    cp_simulation simulation;
    cp_error error = {0};
    run_road_begin(&PLAIN, &simulation);
    add_head_on(51.0, 0.0);
    run_road.fails_at_s = 1.0;
    run_road_until(&simulation, 0.9);
    assert_int_equal(cp_simulation_step(&simulation, &error), CP_TRAFFIC_FAILED);
    assert_string_equal(error.text, "the road ends");
    cp_simulation_end(&simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_crash_is_found_and_its_cars_leave),
        cmocka_unit_test(nothing_counts_before_the_warm_up_ends),
        cmocka_unit_test(a_car_crashes_once_a_step),
        cmocka_unit_test(crashed_cars_stay_and_are_hit),
        cmocka_unit_test(reports_are_cross_checked),
        cmocka_unit_test(a_road_that_fails_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
