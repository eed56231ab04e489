/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_BARRIER_H
#define CRASH_BARRIER_H

#include "core/error.h"
#include "crash/contact.h"

/* Rigid barrier with rounded corners. Its pose is given relative to the car as lateral offset and
 * angle; width, depth, corner radius and the point about which the angle turns it are properties
 * of the test set-up. */
typedef struct cp_barrier {
    double width_m;         /* default 2.0 */
    double depth_m;         /* default 1.5 */
    double corner_radius_m; /* default 0.15 */
    double pivot_m;         /* the angle turns about a point this far before the face, default 0 */
    double friction_1;      /* unused when < 0: the car's own */
} cp_barrier;

cp_barrier cp_barrier_default(void);

/* Outline of the barrier at a pose (middle of its face, x axis its depth direction). */
cp_outline cp_barrier_outline(const cp_barrier *barrier, cp_pose pose);

/* Ranges of width, depth, corner radius, pivot. Errors: CP_BAD_INPUT naming the field. */
CP_MUST_CHECK cp_status cp_barrier_validate(const cp_barrier *barrier, cp_error *error);

#endif
