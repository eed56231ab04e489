/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef IMPACT_FOOTPRINT_H
#define IMPACT_FOOTPRINT_H

#include "core/geometry.h"
#include "traffic/traffic.h"
#include "traffic/vehicle_rectangle.h"

/* Where a vehicle is inside a step. */

/* State inside the step: fraction 0 = beginning, 1 = end. Constant acceleration along the chord
 * between the two positions (ballistic update; a vehicle that comes to rest inside the step stands
 * from there on), heading turned evenly; speed likewise. Place and type are those of the end. Of a
 * motion whose vehicle was not present before: the state of the end. */
cp_vehicle_state cp_motion_at(const cp_vehicle_motion *motion, double step_length_s,
                              double fraction);

/* Velocity of the middle of the front bumper at that fraction, world frame: along the chord, so
 * that a lane change shows; its size is the speed when the chord is as long as the speeds say.
 * After a jump (below): along the heading. */
cp_vec2 cp_motion_front_velocity(const cp_vehicle_motion *motion, double step_length_s,
                                 double fraction);

/* Sideways faster than that nobody drives: turning cars reach 5 m/s. */
#define CP_JUMP_SIDEWAYS_M_S 8.0

/* True when the vehicle was set down where it is rather than driven there: inserted, teleported,
 * or moved sideways faster than CP_JUMP_SIDEWAYS_M_S (SUMO's instant lane change). */
bool cp_motion_is_jump(const cp_vehicle_motion *motion, double step_length_s);

#endif
