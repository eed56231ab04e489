/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_VEHICLE_STATE_H
#define TRAFFIC_VEHICLE_STATE_H

#include <stdbool.h>
#include <stdint.h>

/* What traffic tells of vehicles, their types and the roads under them, wherever it comes from.
 * Frame and units: plane x east, y north, m; headings counter-clockwise from +x, rad, in (-pi, pi];
 * speeds m/s; time s. Positions are of the middle of the front bumper. The header compiles as C and
 * as C++. */

/* No vehicle, type, lane or light has this number. */
#define CP_NO_NUMBER UINT32_MAX

/* One vehicle on the road at the end of a step. */
typedef struct cp_vehicle_state {
    uint32_t vehicle; /* number, see cp_traffic_vehicle_id */
    uint32_t type;    /* number, see cp_traffic_type_id */
    uint32_t lane;    /* number, see cp_traffic_lane_id; as the next two marked * only if places
                         are read (cp_traffic_read_places), else 0 */
    double front_x_m;
    double front_y_m;
    double elevation_m; /* 0 where the network is flat */
    double yaw_rad;
    double speed_m_s;         /* forward */
    double acceleration_m_s2; /* mean of the step by the speeds; filled in by the traffic */
    double lane_position_m;   /* front, along the lane * */
    double length_m;
    double width_m;
    bool is_in_junction; /* its front * */
} cp_vehicle_state;

/* One collision as SUMO itself reports it. */
typedef struct cp_sumo_collision {
    uint32_t collider;
    uint32_t victim;
    const char *type; /* "collision", "frontal", "junction", ... */
} cp_sumo_collision;

/* The next traffic light on a vehicle's route. */
typedef struct cp_next_light {
    double distance_m; /* to its stop line; INFINITY when there is none */
    uint32_t number;   /* of the light; CP_NO_NUMBER when there is none */
    bool is_red;       /* for this vehicle, now */
} cp_next_light;

/* What a vehicle type of SUMO is. */
typedef struct cp_sumo_type {
    char vehicle_class[32]; /* vClass */
    char model[512];        /* value of its parameter crashpulse.model; "" without one */
    double length_m;
    double width_m;
    double height_m;
    double mass_kg; /* its parameter vehicleMass; NAN without one */
} cp_sumo_type;

/* How the roads of two vehicles lie to each other. */
typedef enum cp_road_relation {
    CP_ROADS_MEET,        /* same road (either direction), or one junction, within the longer
                             vehicle's length and a few metres */
    CP_ROADS_APART,       /* no way that short from one to the other along the roads: they run side
                             by side or cross without meeting */
    CP_ROADS_OTHER_LEVEL, /* more than 2.5 m of elevation between them, or lanes that cross inside
                             one junction without being foes there */
} cp_road_relation;

#endif
