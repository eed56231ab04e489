/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/straight_run.h"

#include "core/geometry.h"

// Asked headings that differ by less are one.
#define SAME_YAW_RAD 1e-8

bool cp_straight_run_move(cp_straight_run *run, double x_m, double y_m, double length_m)
{
    cp_vec2 axis = {run->axis_x_1, run->axis_y_1};
    cp_vec2 front_m = {x_m, y_m}, step_m = {x_m - run->x_m, y_m - run->y_m};
    double along_m = cp_vec2_dot(axis, step_m);
    double beside_m = cp_vec2_cross(axis, front_m) - run->offset_m;
    run->x_m = x_m;
    run->y_m = y_m;
    run->is_on =
        run->is_on && fabs(beside_m) <= CP_STRAIGHT_RUN_M && along_m >= 0.0 && along_m <= length_m;
    run->way_m += along_m;
    return run->is_on && run->way_m >= length_m;
}

void cp_straight_run_head(cp_straight_run *run, double yaw_rad)
{
    if (run->is_on && fabs(cp_wrap_angle(yaw_rad - run->yaw_rad)) <= SAME_YAW_RAD)
        return;
    run->yaw_rad = yaw_rad;
    cp_vec2 axis = cp_vec2_heading(yaw_rad);
    run->axis_x_1 = axis.x;
    run->axis_y_1 = axis.y;
    run->offset_m = cp_vec2_cross(axis, (cp_vec2){run->x_m, run->y_m});
    run->way_m = 0.0;
    run->is_on = true;
}
