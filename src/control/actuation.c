/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/actuation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SPEED_MODE_OURS 27

static cp_status reserve(cp_actuation *actuation, uint32_t vehicle, cp_error *error)
{
    if (vehicle >= actuation->numbers) {
        size_t numbers = 2 * ((size_t)vehicle + 1);
        cp_actuation_car *cars = realloc(actuation->cars, numbers * sizeof *cars);
        if (!cars)
            return cp_fail_memory(error, "actuation");
        memset(&cars[actuation->numbers], 0, (numbers - actuation->numbers) * sizeof *cars);
        actuation->cars = cars;
        actuation->numbers = numbers;
    }
    if (actuation->taken_count == actuation->taken_room) {
        size_t room = actuation->taken_room ? 2 * actuation->taken_room : 8;
        uint32_t *taken = realloc(actuation->taken, room * sizeof *taken);
        if (!taken)
            return cp_fail_memory(error, "actuation");
        actuation->taken = taken;
        actuation->taken_room = room;
    }
    return CP_OK;
}

cp_status cp_actuation_request(cp_actuation *actuation, uint32_t vehicle, double speed_m_s,
                               double deceleration_m_s2, cp_error *error)
{
    cp_status status = reserve(actuation, vehicle, error);
    if (status != CP_OK)
        return status;
    cp_actuation_car *car = &actuation->cars[vehicle];
    if (!car->is_requested && !car->is_taken)
        actuation->taken[actuation->taken_count++] = vehicle;
    car->request_m_s = car->is_requested ? fmin(car->request_m_s, speed_m_s) : speed_m_s;
    car->deceleration_m_s2 =
        car->is_requested ? fmax(car->deceleration_m_s2, deceleration_m_s2) : deceleration_m_s2;
    car->is_requested = true;
    return CP_OK;
}

static cp_status command(cp_actuation_car *car, const cp_traffic_source *commands, uint32_t vehicle,
                         cp_error *error)
{
    cp_status status = CP_OK;
    if (!car->is_taken) {
        status = commands->speed_mode(vehicle, &car->driver_mode, error);
        if (status == CP_OK)
            status = commands->set_speed_mode(vehicle, SPEED_MODE_OURS, error);
        car->is_taken = status == CP_OK;
    }
    return status == CP_OK ? commands->set_speed(vehicle, car->request_m_s, error) : status;
}

static cp_status hand_back(cp_actuation_car *car, const cp_traffic_source *commands,
                           uint32_t vehicle, cp_error *error)
{
    car->is_taken = false;
    cp_status status = commands->set_speed(vehicle, -1.0, error);
    return status == CP_OK ? commands->set_speed_mode(vehicle, car->driver_mode, error) : status;
}

cp_status cp_actuation_apply(cp_actuation *actuation, const cp_traffic *traffic, cp_error *error)
{
    const cp_traffic_source *commands = cp_traffic_commands(traffic);
    cp_status status = CP_OK;
    size_t kept = 0;
    for (size_t k = 0; k < actuation->taken_count && status == CP_OK; k++) {
        uint32_t vehicle = actuation->taken[k];
        cp_actuation_car *car = &actuation->cars[vehicle];
        if (!cp_traffic_motion_of(traffic, vehicle)) {
            *car = (cp_actuation_car){0}; // it has left the road
            continue;
        }
        status = car->is_requested ? command(car, commands, vehicle, error)
                                   : hand_back(car, commands, vehicle, error);
        if (!car->is_requested)
            car->deceleration_m_s2 = 0.0;
        car->is_requested = false;
        if (car->is_taken)
            actuation->taken[kept++] = vehicle;
    }
    actuation->taken_count = kept;
    return status;
}

double cp_actuation_deceleration_m_s2(const cp_actuation *actuation, uint32_t vehicle)
{
    return vehicle < actuation->numbers && actuation->cars[vehicle].is_taken
               ? actuation->cars[vehicle].deceleration_m_s2
               : 0.0;
}

void cp_actuation_destroy(cp_actuation *actuation)
{
    free(actuation->cars);
    free(actuation->taken);
    *actuation = (cp_actuation){0};
}
