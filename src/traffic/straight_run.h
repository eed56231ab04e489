/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_STRAIGHT_RUN_H
#define TRAFFIC_STRAIGHT_RUN_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Where a vehicle heads that drives straight on, told from where its front is. SUMO lays a vehicle
 * from its front to where its rear is on the way it came. So one whose front has kept to the line
 * of its own axis for as long as it is lies on that line as a whole, and on it keeps its heading,
 * however it speeds up or brakes; leaving the line by CP_STRAIGHT_RUN_M ends the run. A heading
 * told so is off by no more than 1e-8 rad. Zero-initialised: no run. */
typedef struct cp_straight_run {
    double x_m, y_m; /* front as last told */
    double yaw_rad;  /* of the axis */
    double axis_x_1, axis_y_1;
    double offset_m; /* of the axis from the origin */
    double way_m;    /* driven along it */
    bool is_on;      /* there is such an axis */
} cp_straight_run;

/* Most a front may be beside its axis, m: what rounding does to coordinates of 5000 km. */
#define CP_STRAIGHT_RUN_M 1e-8

/* The front of a vehicle is here a step later. True when it still heads as run->yaw_rad says;
 * false when that must be asked: then tell cp_straight_run_head. length_m: of the vehicle; no step
 * longer than that is part of a run. */
bool cp_straight_run_move(cp_straight_run *run, double x_m, double y_m, double length_m);

/* The heading where the front is now: the run goes on if it heads along it, else begins here. */
void cp_straight_run_head(cp_straight_run *run, double yaw_rad);

#ifdef __cplusplus
}
#endif

#endif
