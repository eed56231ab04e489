/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_STRUCK_STRUCTURE_H
#define CRASH_STRUCK_STRUCTURE_H

#include "crash/front_structure.h"

/* Side and rear of a car that is struck there: three crush blocks (crash/crush_block.h) on the body
 * behind the firewall, whose faces look left, right and back. A car struck on its front has none
 * of them, so that what its front was fitted to stays as it is; one struck elsewhere has all three.
 *
 * A side is one face with three zones from the firewall to the rear structure: front wheel, door
 * with B-pillar, rear wheel. Its force at a depth is the sum over the zones of their force on a
 * metre times their width that yields: the width that is pressed on and half of side_spread_m to
 * either side (sill and roof rail carry it on, at the ends what holds them), less where it is only
 * pressed on near an end. So what presses on the border of two zones meets a mean of both, by
 * width, and nothing jumps there. In front of the firewall lies the outboard corner of the front,
 * which is pushed aside by its own law; it counts as the front wheel's zone.
 *
 * The rear is one face over the whole width: what presses on a share of it (and rear_spread_m)
 * meets that share of its force. From the side it is pushed aside as a whole. */

/* Add the three blocks and their outlines to a car that is built, and make room for them in its
 * body's. */
void cp_struck_build(cp_car *car);

/* What of a struck block's face is pressed on in the present step, along its own left from
 * right_m to left_m (right_m > left_m: nothing), the innermost of it inside_m from the nearer end:
 * sets what it resists with. */
void cp_struck_cover(cp_car *car, int block, double right_m, double left_m, double inside_m);

/* After the step: which zone took how much. Nothing of a car without sides. */
void cp_struck_after_step(cp_car *car);

/* How far the struck side has been pushed in for good, m, and the zone that took most of it; of a
 * front how far it has been pushed into the passenger cell. side: where the car was struck. */
cp_struck cp_struck_of(const cp_car *car, cp_contact_side side);

#endif
