/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TESTS_RUN_RUN_ROAD_H
#define TESTS_RUN_RUN_ROAD_H

#include "control/scripted_road.h"
#include "run/simulation.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* The scripted road with all that a simulation asks of SUMO: crashed cars leave it, types and lanes
 * have names, collisions are reported, and it can fail. All cars are of one type. */

#define ROAD_STEP_S 0.1

static struct run_road {
    double fails_at_s;     /* the step that ends there fails; 0: none does */
    bool fails_on_command; /* a commanded speed is refused */
    cp_sumo_collision collisions[ROAD_CARS];
    size_t collision_count; /* reported after every step */
} run_road;

static cp_status run_road_step(const cp_vehicle_state **states, size_t *count, cp_error *error)
{
    if (run_road.fails_at_s > 0.0 && road.time_s + road.step_s > run_road.fails_at_s - 1e-9)
        return cp_fail(error, CP_TRAFFIC_FAILED, "the road ends");
    return road_step(states, count, error);
}

static cp_status run_road_remove(uint32_t vehicle, cp_error *error)
{
    (void)error;
    road.cars[vehicle].is_there = false;
    return CP_OK;
}

static cp_status run_road_set_speed(uint32_t vehicle, double speed_m_s, cp_error *error)
{
    if (run_road.fails_on_command)
        return cp_fail(error, CP_TRAFFIC_FAILED, "no commands for '%s'", road_vehicle_id(vehicle));
    return road_set_speed(vehicle, speed_m_s, error);
}

static int run_road_expected(void)
{
    int there = 0;
    for (uint32_t k = 0; k < road.count; k++)
        there += road.cars[k].is_there;
    return there;
}

static const char *run_road_lane_id(uint32_t lane)
{
    return lane == 0 ? "street_0" : ":corner_0_0";
}

static cp_status run_road_type(const char *type_id, cp_sumo_type *type, cp_error *error)
{
    (void)type_id;
    (void)error;
    *type = (cp_sumo_type){.vehicle_class = "passenger",
                           .length_m = 4.5,
                           .width_m = 1.8,
                           .height_m = 1.5,
                           .mass_kg = NAN};
    return CP_OK;
}

static cp_status run_road_collisions(const cp_sumo_collision **collisions, size_t *count,
                                     cp_error *error)
{
    (void)error;
    *collisions = run_road.collisions;
    *count = run_road.collision_count;
    return CP_OK;
}

/* A simulation on an empty road; end it. */
static inline void run_road_begin(const cp_simulation_settings *settings, cp_simulation *simulation)
{
    static cp_traffic_source source;
    cp_traffic *traffic = NULL;
    cp_error error = {0};
    source = ROAD;
    source.step = run_road_step;
    source.remove = run_road_remove;
    source.set_speed = run_road_set_speed;
    source.expected_vehicles = run_road_expected;
    source.lane_id = run_road_lane_id;
    source.type = run_road_type;
    source.collisions = run_road_collisions;
    memset(&run_road, 0, sizeof run_road);
    memset(&road, 0, sizeof road);
    road.step_s = settings->step_length_s;
    assert_int_equal(cp_traffic_create_from(&source, settings->step_length_s, &traffic, &error),
                     CP_OK);
    if (cp_simulation_begin_on(settings, traffic, simulation, &error) != CP_OK)
        fail_msg("%s", error.text);
}

/* On to the step that ends at time_s. */
static inline void run_road_until(cp_simulation *simulation, double time_s)
{
    cp_error error = {0};
    while (cp_traffic_time_s(simulation->traffic) < time_s - 1e-9)
        if (cp_simulation_step(simulation, &error) != CP_OK)
            fail_msg("%s", error.text);
}

#endif
