/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_VEHICLE_RECTANGLE_H
#define TRAFFIC_VEHICLE_RECTANGLE_H

#include "core/geometry.h"
#include "traffic/vehicle_state.h"

/* The rectangle that a vehicle covers: its state names the middle of the front bumper. */
cp_rectangle cp_vehicle_rectangle(const cp_vehicle_state *state);

#endif
