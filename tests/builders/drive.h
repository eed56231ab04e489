/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BUILDERS_DRIVE_H
#define BUILDERS_DRIVE_H

#include "core/geometry.h"
#include "traffic/traffic.h"

/* Made-up vehicles with a motion in closed form, for tests that need traffic without SUMO. */

/* Front at (x, y) at time 0. Straight with constant acceleration until at rest; or, with a yaw
 * rate (acceleration then 0), on a circle with the front's velocity along the heading. */
typedef struct drive {
    double x_m, y_m, yaw_rad;
    double speed_m_s;
    double acceleration_m_s2;
    double yaw_rate_rad_s;
    double length_m;   /* 0: 4.5 */
    double width_m;    /* 0: 1.8 */
    double inserted_s; /* on the road from this time on; 0: always */
} drive;

static inline cp_vehicle_state drive_state(const drive *car, uint32_t number, double time_s)
{
    double t_s = time_s;
    if (car->acceleration_m_s2 < 0.0)
        t_s = fmin(t_s, -car->speed_m_s / car->acceleration_m_s2);
    double way_m = car->speed_m_s * t_s + 0.5 * car->acceleration_m_s2 * t_s * t_s;
    double half_turn_rad = 0.5 * car->yaw_rate_rad_s * t_s;
    double chord_m = half_turn_rad == 0.0 ? way_m : way_m * sin(half_turn_rad) / half_turn_rad;
    cp_vec2 chord = cp_vec2_scale(cp_vec2_heading(car->yaw_rad + half_turn_rad), chord_m);
    return (cp_vehicle_state){.vehicle = number,
                              .front_x_m = car->x_m + chord.x,
                              .front_y_m = car->y_m + chord.y,
                              .yaw_rad = cp_wrap_angle(car->yaw_rad + 2.0 * half_turn_rad),
                              .speed_m_s = car->speed_m_s + car->acceleration_m_s2 * t_s,
                              .acceleration_m_s2 = car->acceleration_m_s2,
                              .length_m = car->length_m > 0.0 ? car->length_m : 4.5,
                              .width_m = car->width_m > 0.0 ? car->width_m : 1.8};
}

/* The motion through the step that ends at time_s. */
static inline cp_vehicle_motion drive_motion(const drive *car, uint32_t number, double time_s,
                                             double step_length_s)
{
    cp_vehicle_motion motion = {.after = drive_state(car, number, time_s)};
    motion.was_present = car->inserted_s <= time_s - step_length_s;
    if (!motion.was_present)
        return motion;
    motion.before = drive_state(car, number, time_s - step_length_s);
    motion.yaw_rate_rad_s =
        cp_wrap_angle(motion.after.yaw_rad - motion.before.yaw_rad) / step_length_s;
    return motion;
}

#endif
