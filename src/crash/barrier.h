/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_BARRIER_H
#define CRASH_BARRIER_H

#include "core/error.h"
#include "crash/contact.h"

#include <stdbool.h>

/* Barrier with rounded corners. Its pose is given relative to the car as lateral offset and angle;
 * width, depth, corner radius and the point about which the angle turns it are properties of the
 * test set-up. Rigid and fixed unless it has a face or a mass: then it is simulated as a second
 * vehicle (cp_vehicle_model_of_barrier). A face collapses in CP_BARRIER_STRIPS strips side by side:
 * first a bumper, over face_bumper_m, then the block behind it, until face_m is used up. */
typedef struct cp_barrier {
    double width_m;         /* default 2.0 */
    double depth_m;         /* default 1.5 */
    double corner_radius_m; /* default 0.15 */
    double pivot_m;         /* the angle turns about a point this far before the face, default 0 */
    double friction_1;      /* unused when < 0: the car's own */
    double mass_kg;         /* default 0: fixed */
    double yaw_inertia_kg_m2; /* about its middle; 0: that of a plate of its outline */
    double face_m;            /* depth of the deformable face, part of depth_m; default 0: rigid */
    double face_kn;           /* force of the block over the whole width */
    double face_bumper_m;     /* depth of the bumper in front of it, part of face_m; 0: none */
    double face_bumper_kn;    /* force over the whole width until the bumper is used up */
} cp_barrier;

enum { CP_BARRIER_STRIPS = 6 };

cp_barrier cp_barrier_default(void);

/* Outline of the barrier at a pose (middle of its face, x axis its depth direction). */
cp_outline cp_barrier_outline(const cp_barrier *barrier, cp_pose pose);

/* Whether it moves or gives way. */
bool cp_barrier_is_party(const cp_barrier *barrier);

/* Ranges of width, depth, corner radius, pivot, mass and face. Errors: CP_BAD_INPUT naming the
 * field. */
CP_MUST_CHECK cp_status cp_barrier_validate(const cp_barrier *barrier, cp_error *error);

#endif
