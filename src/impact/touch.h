/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef IMPACT_TOUCH_H
#define IMPACT_TOUCH_H

#include "core/geometry.h"
#include "crash/crash_configuration.h"

/* Two bodies at the moment they first touch: where, and on which sides. */

typedef struct cp_touching_body {
    cp_rectangle rectangle;
    cp_vec2 front_velocity_m_s; /* of the middle of its front edge */
    double yaw_rate_rad_s;
} cp_touching_body;

typedef struct cp_first_touch {
    cp_vec2 point_m;
    cp_contact_side side[2];
} cp_first_touch;

/* Contact point and sides of two rectangles whose separation is zero to rounding (or that overlap:
 * then along the direction that parts them soonest). A corner on an edge: the corner. Two edges
 * parallel to within 1 cm over the edge: the middle of their common stretch. The side is the edge
 * that holds the point; within 1 cm of a corner, the one of its two edges whose outward normal is
 * more opposed to the other body's relative velocity at the point. */
cp_first_touch cp_touch_of(const cp_touching_body body[2]);

#endif
