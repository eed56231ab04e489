/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/actuation.h"

#include <math.h>
#include <stdlib.h>

#define SPEED_MODE_OURS 27

static cp_actuation_car *find(const cp_actuation *actuation, uint32_t vehicle)
{
    for (size_t k = 0; k < actuation->count; k++)
        if (actuation->cars[k].vehicle == vehicle)
            return &actuation->cars[k];
    return NULL;
}

static cp_status add(cp_actuation *actuation, uint32_t vehicle, cp_actuation_car **added,
                     cp_error *error)
{
    if (actuation->count == actuation->room) {
        size_t room = actuation->room ? 2 * actuation->room : 8;
        cp_actuation_car *cars = realloc(actuation->cars, room * sizeof *cars);
        if (!cars)
            return cp_fail_memory(error, "actuation");
        actuation->cars = cars;
        actuation->room = room;
    }
    *added = &actuation->cars[actuation->count++];
    **added = (cp_actuation_car){.vehicle = vehicle};
    return CP_OK;
}

cp_status cp_actuation_request(cp_actuation *actuation, uint32_t vehicle, double speed_m_s,
                               double deceleration_m_s2, cp_error *error)
{
    cp_actuation_car *car = find(actuation, vehicle);
    cp_status status = car ? CP_OK : add(actuation, vehicle, &car, error);
    if (status != CP_OK)
        return status;
    car->request_m_s = car->is_requested ? fmin(car->request_m_s, speed_m_s) : speed_m_s;
    car->deceleration_m_s2 =
        car->is_requested ? fmax(car->deceleration_m_s2, deceleration_m_s2) : deceleration_m_s2;
    car->is_requested = true;
    if (!(deceleration_m_s2 > 0.0) || !actuation->acts)
        return CP_OK;
    return cp_acts_brake(actuation->acts, vehicle, cp_traffic_time_s(actuation->acts->traffic),
                         deceleration_m_s2, error);
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
    for (size_t k = 0; k < actuation->count && status == CP_OK; k++) {
        cp_actuation_car *car = &actuation->cars[k];
        if (!cp_traffic_motion_of(traffic, car->vehicle))
            continue; // it has left the road
        status = car->is_requested ? command(car, commands, car->vehicle, error)
                                   : hand_back(car, commands, car->vehicle, error);
        car->is_requested = false;
        if (car->is_taken)
            actuation->cars[kept++] = *car;
    }
    actuation->count = kept;
    return status;
}

double cp_actuation_deceleration_m_s2(const cp_actuation *actuation, uint32_t vehicle)
{
    const cp_actuation_car *car = find(actuation, vehicle);
    return car && car->is_taken ? car->deceleration_m_s2 : 0.0;
}

void cp_actuation_destroy(cp_actuation *actuation)
{
    free(actuation->cars);
    *actuation = (cp_actuation){0};
}
