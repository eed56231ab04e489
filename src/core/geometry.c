/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/geometry.h"

#include "core/units.h"

double cp_wrap_angle(double angle_rad)
{
    if (angle_rad > -CP_PI && angle_rad <= CP_PI)
        return angle_rad;
    double wrapped = fmod(angle_rad + CP_PI, 2.0 * CP_PI);
    if (wrapped <= 0.0)
        wrapped += 2.0 * CP_PI;
    return wrapped - CP_PI;
}

void cp_rectangle_corners(const cp_rectangle *rectangle, cp_vec2 corners_m[4])
{
    static const double ALONG[4] = {0.5, -0.5, -0.5, 0.5};
    static const double ACROSS[4] = {0.5, 0.5, -0.5, -0.5};
    cp_pose pose = {rectangle->centre_m, rectangle->yaw_rad};
    for (int k = 0; k < 4; k++)
        corners_m[k] = cp_pose_to_world(
            pose, (cp_vec2){ALONG[k] * rectangle->length_m, ACROSS[k] * rectangle->width_m});
}

// Largest gap of b's corners beyond the four faces of a.
static double face_separation(const cp_rectangle *a, const cp_rectangle *b)
{
    cp_vec2 corners_m[4];
    cp_rectangle_corners(b, corners_m);
    cp_pose frame = {a->centre_m, a->yaw_rad};
    double min_x = INFINITY, max_x = -INFINITY, min_y = INFINITY, max_y = -INFINITY;
    for (int k = 0; k < 4; k++) {
        cp_vec2 local_m = cp_pose_to_local(frame, corners_m[k]);
        min_x = fmin(min_x, local_m.x);
        max_x = fmax(max_x, local_m.x);
        min_y = fmin(min_y, local_m.y);
        max_y = fmax(max_y, local_m.y);
    }
    double half_length_m = 0.5 * a->length_m, half_width_m = 0.5 * a->width_m;
    double along_m = fmax(min_x - half_length_m, -half_length_m - max_x);
    double across_m = fmax(min_y - half_width_m, -half_width_m - max_y);
    return fmax(along_m, across_m);
}

double cp_rectangle_separation(const cp_rectangle *a, const cp_rectangle *b)
{
    return fmax(face_separation(a, b), face_separation(b, a));
}
