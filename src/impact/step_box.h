/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef IMPACT_STEP_BOX_H
#define IMPACT_STEP_BOX_H

#include "core/geometry.h"
#include "impact/broad_phase.h"
#include "traffic/traffic.h"

/* The axis-parallel box that holds a vehicle's rectangle throughout a step, for the broad phase. */

/* A heading and its unit vector, kept from step to step: where a vehicle heads at the beginning of
 * a step is where it headed at the end of the one before. Right for any vehicle, quick for the one
 * it was kept of. Begin with {.yaw_rad = 0.0, .unit = {1.0, 0.0}}. */
typedef struct cp_kept_heading {
    double yaw_rad;
    cp_vec2 unit;
} cp_kept_heading;

/* Box of a motion's rectangles, margin_m wider on every side; of a vehicle that was not there
 * before or jumped sideways (cp_motion_is_jump), of the end of the step alone. Of a state that is
 * not finite: a box that overlaps nothing (min > max). kept becomes the heading at the end. */
cp_box cp_step_box(const cp_vehicle_motion *motion, double step_length_s, double margin_m,
                   cp_kept_heading *kept);

#endif
