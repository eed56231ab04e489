/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/barrier.h"

cp_barrier cp_barrier_default(void)
{
    return (cp_barrier){.width_m = 2.0,
                        .depth_m = 1.5,
                        .corner_radius_m = 0.15,
                        .pivot_m = 0.0,
                        .friction_1 = -1.0};
}

cp_outline cp_barrier_outline(const cp_barrier *barrier, cp_pose pose)
{
    cp_vec2 depth = cp_vec2_heading(pose.yaw_rad);
    return (cp_outline){
        .centre_m = cp_vec2_add(pose.position_m, cp_vec2_scale(depth, 0.5 * barrier->depth_m)),
        .along = depth,
        .half_length_m = 0.5 * barrier->depth_m,
        .half_width_m = 0.5 * barrier->width_m,
        .radius_m = fmin(barrier->corner_radius_m, 0.5 * fmin(barrier->width_m, barrier->depth_m))};
}

cp_status cp_barrier_validate(const cp_barrier *barrier, cp_error *error)
{
    if (!(barrier->width_m >= 0.2 && barrier->width_m <= 20.0))
        return cp_fail(error, CP_BAD_INPUT, "barrier width_m must be between 0.2 and 20, found %g",
                       barrier->width_m);
    if (!(barrier->depth_m >= 0.2 && barrier->depth_m <= 20.0))
        return cp_fail(error, CP_BAD_INPUT, "barrier depth_m must be between 0.2 and 20, found %g",
                       barrier->depth_m);
    const double rounding_m = 1e-6; // of numbers in a file
    double largest_m = 0.5 * fmin(barrier->width_m, barrier->depth_m);
    if (!(barrier->corner_radius_m >= 0.0 && barrier->corner_radius_m <= largest_m + rounding_m))
        return cp_fail(error, CP_BAD_INPUT,
                       "barrier corner_radius_m must be between 0 and %g, found %g", largest_m,
                       barrier->corner_radius_m);
    if (!(fabs(barrier->pivot_m) <= 3.0))
        return cp_fail(error, CP_BAD_INPUT, "barrier pivot_m must be between -3 and 3, found %g",
                       barrier->pivot_m);
    return CP_OK;
}
