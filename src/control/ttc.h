/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_TTC_H
#define CONTROL_TTC_H

#include "core/geometry.h"
#include "traffic/traffic.h"

/* A rectangle that keeps its velocity and yaw rate: its centre moves on a circle (a straight line
 * at yaw rate 0), velocity and heading turn together. */
typedef struct cp_moving_rectangle {
    cp_rectangle rectangle; /* now */
    cp_vec2 velocity_m_s;   /* of the centre, now */
    double yaw_rate_rad_s;
} cp_moving_rectangle;

/* What a step says of a vehicle: outline and forward speed at its end, mean yaw rate. SUMO's
 * heading jumps where a lane change begins or ends; a yaw rate that asks for more than 1 g of
 * lateral acceleration is such a jump and not a turn, and counts as 0. */
cp_moving_rectangle cp_moving_rectangle_of(const cp_vehicle_motion *motion);

/* Whether its yaw rate is that of such a jump, or of a corner too tight for its speed. */
bool cp_turns_too_fast(const cp_vehicle_motion *motion);

/* The same inside the step, fraction 0 = beginning, 1 = end: constant acceleration along the chord,
 * heading turned evenly. Needs a motion whose vehicle was present. */
cp_moving_rectangle cp_moving_rectangle_inside(const cp_vehicle_motion *motion, double fraction);

/* Where it is time_s from now. */
cp_rectangle cp_moving_rectangle_at(const cp_moving_rectangle *moving, double time_s);

/* Time to collision: time from now until the two rectangles first overlap when both keep velocity
 * and yaw rate; 0 when they overlap already, INFINITY when they do not within horizon_s. Exact for
 * straight motion; with a turning one contact counts from 1 mm on. */
double cp_ttc_s(const cp_moving_rectangle *a, const cp_moving_rectangle *b, double horizon_s);

#endif
