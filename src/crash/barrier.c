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

bool cp_barrier_is_party(const cp_barrier *barrier)
{
    return barrier->mass_kg > 0.0 || barrier->face_m > 0.0;
}

static cp_status check_party(const cp_barrier *barrier, cp_error *error)
{
    if (barrier->mass_kg != 0.0 && !(barrier->mass_kg >= 200.0 && barrier->mass_kg <= 1e5))
        return cp_fail(error, CP_BAD_INPUT,
                       "barrier mass_kg must be 0 (fixed) or between 200 and 100000, found %g",
                       barrier->mass_kg);
    if (barrier->face_m == 0.0)
        return CP_OK;
    if (!(barrier->face_m >= 0.1 && barrier->face_m <= 0.8 * barrier->depth_m))
        return cp_fail(error, CP_BAD_INPUT,
                       "barrier face_m must be 0 (rigid) or between 0.1 and 80 %% of depth_m = %g, "
                       "found %g",
                       barrier->depth_m, barrier->face_m);
    if (!(barrier->face_kn >= 5.0 && barrier->face_kn <= 5000.0))
        return cp_fail(error, CP_BAD_INPUT, "barrier face_kn must be between 5 and 5000, found %g",
                       barrier->face_kn);
    if (!(barrier->face_bumper_m >= 0.0 && barrier->face_bumper_m <= barrier->face_m - 0.06))
        return cp_fail(error, CP_BAD_INPUT,
                       "barrier face_bumper_m must be between 0 and face_m - 0.06 = %g, found %g",
                       barrier->face_m - 0.06, barrier->face_bumper_m);
    if (barrier->face_bumper_m > 0.0 &&
        !(barrier->face_bumper_kn >= 5.0 && barrier->face_bumper_kn <= 5000.0))
        return cp_fail(error, CP_BAD_INPUT,
                       "barrier face_bumper_kn must be between 5 and 5000, found %g",
                       barrier->face_bumper_kn);
    return CP_OK;
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
    return check_party(barrier, error);
}
