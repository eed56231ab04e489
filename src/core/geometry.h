/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_GEOMETRY_H
#define CORE_GEOMETRY_H

#include <math.h>
#include <stdbool.h>

/* Plane geometry: x east / forward, y north / left, metres; angles counter-clockwise, rad. */

typedef struct cp_vec2 {
    double x;
    double y;
} cp_vec2;

/* Position of a frame's origin and its heading. */
typedef struct cp_pose {
    cp_vec2 position_m;
    double yaw_rad;
} cp_pose;

/* A vehicle outline: oriented rectangle about its geometric centre. */
typedef struct cp_rectangle {
    cp_vec2 centre_m;
    double yaw_rad;
    double length_m; /* along yaw */
    double width_m;  /* across */
} cp_rectangle;

static inline cp_vec2 cp_vec2_add(cp_vec2 a, cp_vec2 b)
{
    return (cp_vec2){a.x + b.x, a.y + b.y};
}

static inline cp_vec2 cp_vec2_sub(cp_vec2 a, cp_vec2 b)
{
    return (cp_vec2){a.x - b.x, a.y - b.y};
}

static inline cp_vec2 cp_vec2_scale(cp_vec2 a, double factor)
{
    return (cp_vec2){a.x * factor, a.y * factor};
}

static inline double cp_vec2_dot(cp_vec2 a, cp_vec2 b)
{
    return a.x * b.x + a.y * b.y;
}

/* z component of a x b. */
static inline double cp_vec2_cross(cp_vec2 a, cp_vec2 b)
{
    return a.x * b.y - a.y * b.x;
}

static inline double cp_vec2_length(cp_vec2 a)
{
    return hypot(a.x, a.y);
}

/* Turn counter-clockwise by angle_rad. */
static inline cp_vec2 cp_vec2_rotate(cp_vec2 a, double angle_rad)
{
    double c = cos(angle_rad), s = sin(angle_rad);
    return (cp_vec2){c * a.x - s * a.y, s * a.x + c * a.y};
}

/* Unit vector of a heading. */
static inline cp_vec2 cp_vec2_heading(double yaw_rad)
{
    return (cp_vec2){cos(yaw_rad), sin(yaw_rad)};
}

/* Velocity of a point at lever arm r_m of a body turning at rate_rad_s: v + rate x r. */
static inline cp_vec2 cp_point_velocity(cp_vec2 velocity_m_s, double rate_rad_s, cp_vec2 r_m)
{
    return (cp_vec2){velocity_m_s.x - rate_rad_s * r_m.y, velocity_m_s.y + rate_rad_s * r_m.x};
}

/* From the centre of a rectangle to its corners. */
static inline double cp_rectangle_half_diagonal_m(const cp_rectangle *rectangle)
{
    return 0.5 * hypot(rectangle->length_m, rectangle->width_m);
}

/* A point given in the frame of pose, in the world, and back. */
static inline cp_vec2 cp_pose_to_world(cp_pose pose, cp_vec2 local_m)
{
    return cp_vec2_add(pose.position_m, cp_vec2_rotate(local_m, pose.yaw_rad));
}

static inline cp_vec2 cp_pose_to_local(cp_pose pose, cp_vec2 world_m)
{
    return cp_vec2_rotate(cp_vec2_sub(world_m, pose.position_m), -pose.yaw_rad);
}

/* The same angle in (-pi, pi]. */
double cp_wrap_angle(double angle_rad);

/* The four corners counter-clockwise: front left, rear left, rear right, front right. */
void cp_rectangle_corners(const cp_rectangle *rectangle, cp_vec2 corners_m[4]);

/* Signed separation of two rectangles by separating axes: > 0 the widest gap along a face
 * normal, < 0 the depth of overlap (least push that parts them). */
double cp_rectangle_separation(const cp_rectangle *a, const cp_rectangle *b);

#endif
