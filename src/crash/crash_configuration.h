/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_CRASH_CONFIGURATION_H
#define CRASH_CRASH_CONFIGURATION_H

#include "core/error.h"
#include "core/geometry.h"
#include "crash/vehicle_model.h"

#include <stdbool.h>

/* The state of two cars (or a car and a barrier) at first contact, and what describes it.
 * Roles: [0] is a, [1] is b. */

typedef enum cp_contact_side {
    CP_SIDE_FRONT,
    CP_SIDE_LEFT,
    CP_SIDE_RIGHT,
    CP_SIDE_REAR
} cp_contact_side;

/* "front", "left", "right", "rear". */
const char *cp_contact_side_text(cp_contact_side side);

/* Crash type from the two sides, the nobler first: "front-front", "front-side", "front-rear",
 * "side-side", "side-rear", "rear-rear". */
const char *cp_crash_type_text(cp_contact_side a, cp_contact_side b);

/* Motion of one car: centre of gravity, heading, and their rates, in one common plane frame. */
typedef struct cp_body_state {
    cp_vec2 cog_m;
    double yaw_rad;
    cp_vec2 velocity_m_s;
    double yaw_rate_rad_s;
} cp_body_state;

/* The full relative state the surrogate starts from. */
typedef struct cp_crash_configuration {
    bool against_barrier;
    cp_body_state vehicle[2]; /* [1] unused against a barrier */
    cp_contact_side side[2];  /* where each is struck */
    cp_barrier barrier;
    cp_pose barrier_pose; /* middle of its face; x axis is its depth direction */
} cp_crash_configuration;

/* What describes a configuration. For a barrier closing speed is the car's speed. */
typedef struct cp_crash_description {
    double speed_m_s[2];      /* forward speed of each car */
    double closing_speed_m_s; /* of the two bodies at the contact point */
    double lateral_offset_m;  /* of the middle of b's front edge (barrier: face) in a's frame */
    double angle_rad;         /* wrap(yaw_b - yaw_a - pi): 0 exactly oncoming */
    double overlap_1;         /* share of a's width covered by b, front on front by b's front edge;
                               * NAN unless a's front is struck */
    double velocity_angle_rad[2]; /* relative velocity against the own x axis, 0 = straight ahead */
} cp_crash_description;

/* Car a drives along +x from the origin of the plane; b (model_b, or the barrier when NULL) is
 * placed by offset and angle and both are moved along their headings until they just touch.
 * barrier may be NULL: that of a's reference study. Speeds >= 0, not both 0. Errors: CP_BAD_INPUT
 * when the two miss each other. */
CP_MUST_CHECK cp_status cp_crash_configuration_from_description(
    const cp_vehicle_model *model_a, const cp_vehicle_model *model_b, const cp_barrier *barrier,
    double speed_a_m_s, double speed_b_m_s, double lateral_offset_m, double angle_rad,
    cp_crash_configuration *configuration, cp_error *error);

/* Car a drives along +x from the origin of the plane and is struck on a side or its rear by the
 * front of b: square to it (angle_rad 0, positive turns b counter-clockwise), the middle of b's
 * front at a's x (a side) or y (the rear) at_m from its centre of gravity, b driving along its
 * heading, moved along it until they just touch. Errors: CP_BAD_INPUT when they miss each other,
 * or when side is the front. */
CP_MUST_CHECK cp_status cp_crash_configuration_struck(
    const cp_vehicle_model *model_a, const cp_vehicle_model *model_b, cp_contact_side side,
    double at_m, double angle_rad, double speed_a_m_s, double speed_b_m_s,
    cp_crash_configuration *configuration, cp_error *error);

/* Distance of the two outlines of a configuration, negative when they overlap. */
double cp_crash_contact_gap(const cp_vehicle_model *model_a, const cp_vehicle_model *model_b,
                            const cp_crash_configuration *configuration);

/* Middle of the contact of the two outlines (rectangles of length and width; the barrier's rounded
 * one) of a configuration that touches, in its plane. */
cp_vec2 cp_crash_contact_point(const cp_vehicle_model *model_a, const cp_vehicle_model *model_b,
                               const cp_crash_configuration *configuration);

/* Speeds, offset, angle, overlap of a configuration whose outlines touch. Inverse of the above to
 * 1e-12. contact_m: the contact point in the plane of the configuration. */
cp_crash_description cp_crash_describe(const cp_vehicle_model *model_a,
                                       const cp_vehicle_model *model_b,
                                       const cp_crash_configuration *configuration,
                                       cp_vec2 contact_m);

#endif
