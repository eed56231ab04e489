/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_SCRIPTED_ROAD_H
#define CONTROL_SCRIPTED_ROAD_H

#include "control/control.h"
#include "core/geometry.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A road without SUMO for tests of controls: cars keep speed and curvature of their way but for
 * commanded speeds, which hold for the coming steps until taken back (ballistic update, as in our
 * runs of SUMO). */

#define ROAD_CARS 8

typedef struct road_car {
    char id[32];
    cp_vehicle_state state;
    bool is_there;
    double curvature_1_m; /* of the way of its centre, left positive */
    double command_m_s;   /* < 0: none */
    int mode;
    char key[64], value[256]; /* of the last parameter set */
    cp_next_light light;      /* none unless number is set */
} road_car;

static struct road {
    road_car cars[ROAD_CARS];
    uint32_t count;
    double step_s, time_s;
    cp_vehicle_state states[ROAD_CARS];
    uint32_t departed[ROAD_CARS];
    uint32_t departed_count, announced;
    int commands;
} road;

/* Along the arc: the centre by its chord, the front with the heading. */
static inline void road_drive(road_car *car, double way_m)
{
    double half_turn_rad = 0.5 * car->curvature_1_m * way_m;
    double shortening = half_turn_rad == 0.0 ? 1.0 : sin(half_turn_rad) / half_turn_rad;
    double half_m = 0.5 * car->state.length_m, yaw_rad = car->state.yaw_rad;
    double later_rad = cp_wrap_angle(yaw_rad + 2.0 * half_turn_rad);
    car->state.front_x_m += way_m * shortening * cos(yaw_rad + half_turn_rad) +
                            half_m * (cos(later_rad) - cos(yaw_rad));
    car->state.front_y_m += way_m * shortening * sin(yaw_rad + half_turn_rad) +
                            half_m * (sin(later_rad) - sin(yaw_rad));
    car->state.yaw_rad = later_rad;
}

static cp_status road_step(const cp_vehicle_state **states, size_t *count, cp_error *error)
{
    (void)error;
    road.time_s += road.step_s;
    *count = 0;
    for (uint32_t k = 0; k < road.count; k++) {
        road_car *car = &road.cars[k];
        double before_m_s = car->state.speed_m_s;
        if (car->command_m_s >= 0.0)
            car->state.speed_m_s = car->command_m_s;
        double way_m = 0.5 * (before_m_s + car->state.speed_m_s) * road.step_s;
        if (k < road.announced) // who has just come stands where it was put
            road_drive(car, way_m);
        if (car->is_there)
            road.states[(*count)++] = car->state;
    }
    road.departed_count = 0;
    for (; road.announced < road.count; road.announced++)
        road.departed[road.departed_count++] = road.announced;
    *states = road.states;
    return CP_OK;
}

static cp_status road_departed(const uint32_t **vehicles, size_t *count, cp_error *error)
{
    (void)error;
    *vehicles = road.departed;
    *count = road.departed_count;
    return CP_OK;
}

static double road_time_s(void)
{
    return road.time_s;
}

static const char *road_vehicle_id(uint32_t vehicle)
{
    return road.cars[vehicle].id;
}

static const char *road_type_id(uint32_t type)
{
    static const char *const TYPES[] = {"type0", "type1"};
    return TYPES[type % 2];
}

static cp_status road_set_speed(uint32_t vehicle, double speed_m_s, cp_error *error)
{
    (void)error;
    road.commands++;
    road.cars[vehicle].command_m_s = speed_m_s;
    return CP_OK;
}

static cp_status road_set_speed_mode(uint32_t vehicle, int mode, cp_error *error)
{
    (void)error;
    road.commands++;
    road.cars[vehicle].mode = mode;
    return CP_OK;
}

static cp_status road_speed_mode(uint32_t vehicle, int *mode, cp_error *error)
{
    (void)error;
    *mode = road.cars[vehicle].mode;
    return CP_OK;
}

static cp_status road_set_parameter(uint32_t vehicle, const char *key, const char *value,
                                    cp_error *error)
{
    (void)error;
    road.commands++;
    snprintf(road.cars[vehicle].key, sizeof road.cars[vehicle].key, "%s", key);
    snprintf(road.cars[vehicle].value, sizeof road.cars[vehicle].value, "%s", value);
    return CP_OK;
}

static cp_status road_next_light(uint32_t vehicle, cp_next_light *light, cp_error *error)
{
    (void)error;
    *light = road.cars[vehicle].light;
    return CP_OK;
}

static void road_stop(void)
{
}

static const cp_traffic_source ROAD = {
    .step = road_step,
    .departed = road_departed,
    .time_s = road_time_s,
    .vehicle_id = road_vehicle_id,
    .type_id = road_type_id,
    .set_speed = road_set_speed,
    .set_speed_mode = road_set_speed_mode,
    .speed_mode = road_speed_mode,
    .set_parameter = road_set_parameter,
    .next_light = road_next_light,
    .stop = road_stop,
};

/* An empty road at time 0; the caller destroys the traffic. */
static inline cp_traffic *road_open(double step_s)
{
    memset(&road, 0, sizeof road);
    road.step_s = step_s;
    cp_traffic *traffic = NULL;
    cp_error error = {0};
    if (cp_traffic_create_from(&ROAD, step_s, &traffic, &error) != CP_OK)
        abort();
    return traffic;
}

/* A car 4.5 m by 1.8 m with its front at (x, y), there from the next step on. */
static inline road_car *road_add(const char *id, double x_m, double y_m, double yaw_rad,
                                 double speed_m_s)
{
    road_car *car = &road.cars[road.count];
    snprintf(car->id, sizeof car->id, "%s", id);
    car->state = (cp_vehicle_state){.vehicle = road.count,
                                    .front_x_m = x_m,
                                    .front_y_m = y_m,
                                    .yaw_rad = yaw_rad,
                                    .speed_m_s = speed_m_s,
                                    .length_m = 4.5,
                                    .width_m = 1.8};
    car->is_there = true;
    car->command_m_s = -1.0;
    car->mode = 31;
    car->light = (cp_next_light){.distance_m = INFINITY, .number = CP_NO_NUMBER};
    road.count++;
    return car;
}

/* One control of default settings but for the parameters named: {"ttc_s", ...} with their values,
 * ended by NULL. */
static inline cp_control_settings road_settings(cp_control_kind kind, const char *name,
                                                const char *const *names, const double *values)
{
    cp_control_settings settings = cp_control_settings_default(cp_control_type_find(kind, name));
    for (size_t k = 0; names && names[k]; k++)
        for (size_t i = 0; i < settings.type->parameter_count; i++)
            if (strcmp(settings.type->parameters[i].name, names[k]) == 0)
                settings.parameter[i] = values[k];
    return settings;
}

#endif
