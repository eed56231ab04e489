/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/sensor.h"

// Whether the way from one point to another leads through a rectangle: both as seen from the
// rectangle, the stretch inside its two slabs.
static bool is_behind(const cp_rectangle *screen, cp_vec2 from_m, cp_vec2 to_m)
{
    // Most lie clear of it, the whole circle around them.
    cp_vec2 way_m = cp_vec2_sub(to_m, from_m), centre_m = cp_vec2_sub(screen->centre_m, from_m);
    double reach_m = 0.5 * hypot(screen->length_m, screen->width_m);
    double length_m = cp_vec2_length(way_m), along_m2 = cp_vec2_dot(way_m, centre_m);
    if (fabs(cp_vec2_cross(way_m, centre_m)) > reach_m * length_m ||
        along_m2 < -reach_m * length_m || along_m2 > (length_m + reach_m) * length_m)
        return false;

    cp_pose pose = {screen->centre_m, screen->yaw_rad};
    cp_vec2 from = cp_pose_to_local(pose, from_m), to = cp_pose_to_local(pose, to_m);
    double start[2] = {from.x, from.y}, way[2] = {to.x - from.x, to.y - from.y};
    double half_m[2] = {0.5 * screen->length_m, 0.5 * screen->width_m};
    double enter_1 = 0.0, leave_1 = 1.0;
    for (int axis = 0; axis < 2; axis++) {
        if (fabs(way[axis]) < 1e-12) {
            if (fabs(start[axis]) >= half_m[axis])
                return false;
            continue;
        }
        double one_1 = (-half_m[axis] - start[axis]) / way[axis];
        double other_1 = (half_m[axis] - start[axis]) / way[axis];
        enter_1 = fmax(enter_1, fmin(one_1, other_1));
        leave_1 = fmin(leave_1, fmax(one_1, other_1));
    }
    return enter_1 < leave_1;
}

bool cp_sensor_sees(const cp_sensor *sensor, const cp_rectangle *own, const cp_rectangle *target,
                    const cp_rectangle *const *screens, size_t screen_count)
{
    cp_pose mounting = {own->centre_m, own->yaw_rad};
    mounting.position_m = cp_pose_to_world(mounting, (cp_vec2){0.5 * own->length_m, 0.0});
    cp_pose there = {target->centre_m, target->yaw_rad};

    // A grid of 3 x 3 points of the target: corners, side middles, centre.
    for (int along = -1; along <= 1; along++) {
        for (int across = -1; across <= 1; across++) {
            cp_vec2 local_m = {0.5 * along * target->length_m, 0.5 * across * target->width_m};
            cp_vec2 point_m = cp_pose_to_world(there, local_m);
            cp_vec2 seen_m = cp_pose_to_local(mounting, point_m);
            bool visible = cp_vec2_length(seen_m) <= sensor->range_m &&
                           fabs(atan2(seen_m.y, seen_m.x)) <= 0.5 * sensor->field_of_view_rad;
            for (size_t k = 0; visible && k < screen_count; k++)
                visible = screens[k] == own || screens[k] == target ||
                          !is_behind(screens[k], mounting.position_m, point_m);
            if (visible)
                return true;
        }
    }
    return false;
}
