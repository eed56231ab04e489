/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/sensor.h"

bool cp_sensor_sees(const cp_sensor *sensor, const cp_rectangle *own, const cp_rectangle *target)
{
    cp_pose mounting = {own->centre_m, own->yaw_rad};
    mounting.position_m = cp_pose_to_world(mounting, (cp_vec2){0.5 * own->length_m, 0.0});
    cp_pose there = {target->centre_m, target->yaw_rad};

    // A grid of 3 x 3 points of the target: corners, side middles, centre.
    for (int along = -1; along <= 1; along++) {
        for (int across = -1; across <= 1; across++) {
            cp_vec2 local_m = {0.5 * along * target->length_m, 0.5 * across * target->width_m};
            cp_vec2 seen_m = cp_pose_to_local(mounting, cp_pose_to_world(there, local_m));
            if (cp_vec2_length(seen_m) <= sensor->range_m &&
                fabs(atan2(seen_m.y, seen_m.x)) <= 0.5 * sensor->field_of_view_rad)
                return true;
        }
    }
    return false;
}
