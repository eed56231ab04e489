/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/sensor.h"

#define SCREENS_MAX 64 /* that are looked at closely at a time */

/* A circle. */
typedef struct disc {
    cp_vec2 centre_m;
    double radius_m;
} disc;

static disc around(const cp_rectangle *rectangle)
{
    return (disc){rectangle->centre_m, cp_rectangle_half_diagonal_m(rectangle)};
}

// Whether a disc lies clear of all ways from a point into another disc.
static bool is_clear(const disc *screen, cp_vec2 from_m, const disc *target)
{
    cp_vec2 way_m = cp_vec2_sub(target->centre_m, from_m);
    cp_vec2 centre_m = cp_vec2_sub(screen->centre_m, from_m);
    double reach_m = screen->radius_m + target->radius_m, length_m2 = cp_vec2_dot(way_m, way_m);
    double across_m2 = cp_vec2_cross(way_m, centre_m), along_m2 = cp_vec2_dot(way_m, centre_m);
    if (across_m2 * across_m2 > reach_m * reach_m * length_m2)
        return true;
    double length_m = sqrt(length_m2);
    return along_m2 < -reach_m * length_m || along_m2 > (length_m + reach_m) * length_m;
}

// Whether the way from one point to another leads through a rectangle: both as seen from the
// rectangle, the stretch inside its two slabs.
static bool is_behind(const cp_rectangle *screen, cp_vec2 from_m, cp_vec2 to_m)
{
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

// Whether no point of a disc lies in the sector, seen from its mounting.
static bool is_outside(const cp_sensor *sensor, cp_vec2 centre_m, double radius_m)
{
    double distance_m = cp_vec2_length(centre_m), rounding = 1e-9;
    if (distance_m - radius_m > sensor->range_m + rounding)
        return true;
    if (distance_m <= radius_m)
        return false;
    double beside_rad = fabs(atan2(centre_m.y, centre_m.x)) - asin(radius_m / distance_m);
    return beside_rad > 0.5 * sensor->field_of_view_rad + rounding;
}

static bool is_in_sector(const cp_sensor *sensor, cp_vec2 seen_m)
{
    return cp_vec2_length(seen_m) <= sensor->range_m &&
           fabs(atan2(seen_m.y, seen_m.x)) <= 0.5 * sensor->field_of_view_rad;
}

// Those of the screens that may hide some of the target. Returns how many there are; near has room
// for the first SCREENS_MAX of them.
static size_t find_near(const cp_rectangle *own, const cp_rectangle *target, cp_vec2 from_m,
                        const cp_rectangle *const *screens, size_t screen_count,
                        const cp_rectangle *near[SCREENS_MAX])
{
    disc aim = around(target);
    size_t count = 0;
    for (size_t k = 0; k < screen_count; k++) {
        disc screen = around(screens[k]);
        if (screens[k] == own || screens[k] == target || is_clear(&screen, from_m, &aim))
            continue;
        if (count < SCREENS_MAX)
            near[count] = screens[k];
        count++;
    }
    return count;
}

bool cp_sensor_sees(const cp_sensor *sensor, const cp_rectangle *own, const cp_rectangle *target,
                    const cp_rectangle *const *screens, size_t screen_count)
{
    cp_pose mounting = {own->centre_m, own->yaw_rad};
    mounting.position_m = cp_pose_to_world(mounting, (cp_vec2){0.5 * own->length_m, 0.0});
    cp_pose there = {target->centre_m, target->yaw_rad};
    if (is_outside(sensor, cp_pose_to_local(mounting, target->centre_m),
                   cp_rectangle_half_diagonal_m(target)))
        return false;

    // Few are in the way. More than there is room for: then all are looked at.
    const cp_rectangle *near[SCREENS_MAX];
    size_t near_count = find_near(own, target, mounting.position_m, screens, screen_count, near);
    if (near_count <= SCREENS_MAX) {
        screens = near;
        screen_count = near_count;
    }

    // A grid of 3 x 3 points of the target: corners, side middles, centre.
    for (int along = -1; along <= 1; along++) {
        for (int across = -1; across <= 1; across++) {
            cp_vec2 local_m = {0.5 * along * target->length_m, 0.5 * across * target->width_m};
            cp_vec2 point_m = cp_pose_to_world(there, local_m);
            bool visible = is_in_sector(sensor, cp_pose_to_local(mounting, point_m));
            for (size_t k = 0; visible && k < screen_count; k++)
                visible = screens[k] == own || screens[k] == target ||
                          !is_behind(screens[k], mounting.position_m, point_m);
            if (visible)
                return true;
        }
    }
    return false;
}
