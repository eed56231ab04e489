/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BUILDERS_TWO_CARS_H
#define BUILDERS_TWO_CARS_H

#include "core/file.h"
#include "core/geometry.h"
#include "core/units.h"
#include "traffic/sumo_bridge.h"
#include "traffic/traffic.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Two cars on roads that SUMO does not know to meet (tests/control/two_cars), so that nothing but a
 * test moves them; and their exact motion beside it. */

#define TWO_CARS_LENGTH_M 4.5
#define TWO_CARS_WIDTH_M 1.8
#define TWO_CARS_BEFORE_M 150.0 /* of every road, before the place where the front begins */

/* The own car's front begins at (0, 0) heading east; the target as said. */
typedef struct two_cars {
    const char *road; /* the target's */
    double own_m_s;
    double x_m, y_m, yaw_rad; /* the target's front at the beginning */
    double target_m_s;
    double radius_m, turn_rad; /* the arc from there on, left positive; 0: straight */
    double ttc_s;              /* threshold of a function under test */
    double ahead_m;            /* the target begins this far further along its road */
} two_cars;

/* Place on the target's road, way_m from (x, y). */
static inline cp_vec2 two_cars_on_road(const two_cars *e, double way_m)
{
    cp_vec2 start_m = {e->x_m, e->y_m};
    double arc_m = fabs(e->turn_rad) * e->radius_m;
    if (way_m <= 0.0 || arc_m <= 0.0)
        return cp_vec2_add(start_m, cp_vec2_scale(cp_vec2_heading(e->yaw_rad), way_m));
    double along_m = fmin(way_m, arc_m);
    double turned_rad = e->turn_rad * along_m / arc_m;
    double chord_m = 2.0 * e->radius_m * sin(0.5 * fabs(turned_rad));
    cp_vec2 at_m = cp_vec2_add(
        start_m, cp_vec2_scale(cp_vec2_heading(e->yaw_rad + 0.5 * turned_rad), chord_m));
    return cp_vec2_add(at_m,
                       cp_vec2_scale(cp_vec2_heading(e->yaw_rad + turned_rad), way_m - along_m));
}

/* The target at constant speed: its front is on the road and so is its rear bumper's middle, as
 * with a vehicle of SUMO. */
static inline cp_rectangle two_cars_target_at(const two_cars *e, double time_s)
{
    double way_m = e->ahead_m + e->target_m_s * time_s;
    cp_vec2 front_m = two_cars_on_road(e, way_m);
    cp_vec2 rear_m = two_cars_on_road(e, way_m - TWO_CARS_LENGTH_M);
    double yaw_rad = atan2(front_m.y - rear_m.y, front_m.x - rear_m.x);
    cp_vec2 half = cp_vec2_scale(cp_vec2_heading(yaw_rad), 0.5 * TWO_CARS_LENGTH_M);
    return (cp_rectangle){cp_vec2_sub(front_m, half), yaw_rad, TWO_CARS_LENGTH_M, TWO_CARS_WIDTH_M};
}

static inline cp_status two_cars_write_routes(const two_cars *e, const char *path, cp_error *error)
{
    char text[2048];
    int size = snprintf(text, sizeof text, "<routes>\n");
    const char *const ids[] = {"own", "target"}, *const roads[] = {"own", e->road};
    const double speeds_m_s[] = {e->own_m_s, e->target_m_s}, ahead_m[] = {0.0, e->ahead_m};
    for (int k = 0; k < 2; k++)
        size += snprintf(text + size, sizeof text - (size_t)size,
                         "<vType id='%s_type' length='%g' width='%g' sigma='0' speedFactor='1' "
                         "speedDev='0' maxSpeed='%g' decel='9' emergencyDecel='9'/>\n"
                         "<vehicle id='%s' type='%s_type' depart='0' departPos='%.9g' "
                         "departSpeed='%g'><route edges='%s'/></vehicle>\n",
                         ids[k], TWO_CARS_LENGTH_M, TWO_CARS_WIDTH_M, fmax(1.0, speeds_m_s[k]),
                         ids[k], ids[k], TWO_CARS_BEFORE_M + ahead_m[k], speeds_m_s[k], roads[k]);
    size += snprintf(text + size, sizeof text - (size_t)size, "</routes>\n");
    return cp_file_write(path, text, (size_t)size, error);
}

/* SUMO, but nobody asks it whether the roads meet: it does not know. */
static const cp_traffic_source TWO_CARS_SOURCE = {
    .step = sumo_bridge_step,
    .departed = sumo_bridge_departed,
    .time_s = sumo_bridge_time_s,
    .expected_vehicles = sumo_bridge_expected_vehicles,
    .vehicle_id = sumo_bridge_vehicle_id,
    .type_id = sumo_bridge_type_id,
    .remove = sumo_bridge_remove,
    .set_speed = sumo_bridge_set_speed,
    .set_speed_mode = sumo_bridge_set_speed_mode,
    .speed_mode = sumo_bridge_speed_mode,
    .read_places = sumo_bridge_read_places,
    .place = sumo_bridge_place,
    .lane_width = sumo_bridge_lane_width,
    .lane_map = sumo_bridge_lane_map,
    .next_lanes = sumo_bridge_next_lanes,
    .stop = sumo_bridge_stop,
};

/* The two in SUMO; CRASHPULSE_BUILD is the build folder. Destroy the traffic. */
static inline cp_status two_cars_open(const two_cars *e, double step_length_s, cp_traffic **traffic,
                                      cp_error *error)
{
    char sumocfg[1024], routes[1024];
    const char *build = getenv("CRASHPULSE_BUILD");
    snprintf(sumocfg, sizeof sumocfg, "%s/tests/control/two_cars/two_cars.sumocfg", build);
    snprintf(routes, sizeof routes, "%s/tests/control/two_cars/%d.rou.xml", build, (int)getpid());
    const char *const words[] = {"--route-files", routes};
    cp_status status = two_cars_write_routes(e, routes, error);
    if (status == CP_OK)
        status = sumo_bridge_start(sumocfg, 1, step_length_s, words, 2, error);
    if (status == CP_OK)
        status = cp_traffic_create_from(&TWO_CARS_SOURCE, step_length_s, traffic, error);
    unlink(routes);
    return status;
}

/* Motion of one of them, "own" or "target"; NULL when it is not on the road. */
static inline const cp_vehicle_motion *two_cars_motion(const cp_traffic *traffic, const char *id)
{
    size_t count;
    const cp_vehicle_motion *motions = cp_traffic_motions(traffic, &count);
    for (size_t k = 0; k < count; k++)
        if (strcmp(cp_traffic_vehicle_id(traffic, motions[k].after.vehicle), id) == 0)
            return &motions[k];
    return NULL;
}

#endif
