/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_CONTACT_H
#define CRASH_CONTACT_H

#include "core/geometry.h"

/* Contact of two rounded rectangles in the plane: a rectangle (the core) grown by a radius. */

typedef struct cp_outline {
    cp_vec2 centre_m;
    cp_vec2 along;        /* unit vector of its length; cp_vec2_heading(yaw) makes one */
    double half_length_m; /* along it, rounding included */
    double half_width_m;  /* across, rounding included */
    double radius_m;      /* <= both halves */
} cp_outline;

typedef struct cp_contact_point {
    cp_vec2 position_m; /* half-way between the two surfaces */
    double depth_m;     /* > 0 when penetrating */
} cp_contact_point;

/* Width over which a dent spreads. Two points of a contact nearer to each other are one patch. */
#define CP_CONTACT_PATCH_M 0.12

/* Up to two points of a common normal. */
typedef struct cp_manifold {
    int count;
    cp_vec2 normal; /* unit, from a to b */
    cp_contact_point point[2];
} cp_manifold;

/* Share of the pair's stiffness at each point. Two points push both: near each other they are one
 * patch, no stiffer than a single corner, and grow to twice that with the distance. */
double cp_manifold_point_weight(const cp_manifold *manifold);

/* Points of a and b that are nearer than reach_m (0: penetrating only). */
cp_manifold cp_outline_contact(const cp_outline *a, const cp_outline *b, double reach_m);

/* Distance of the surfaces; negative: depth of penetration. */
double cp_outline_distance(const cp_outline *a, const cp_outline *b);
/* The same where it is below limit_m, else INFINITY, sooner. */
double cp_outline_distance_below(const cp_outline *a, const cp_outline *b, double limit_m);

#endif
