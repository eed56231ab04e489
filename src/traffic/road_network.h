/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_ROAD_NETWORK_H
#define TRAFFIC_ROAD_NETWORK_H

#include "core/error.h"

#include <stddef.h>
#include <stdint.h>

/* (Compiles as C and as C++.) Which places of a road network belong together: two cars can only
 * touch where their roads meet. Roads that merely cross in the plane (an overpass) or run side by
 * side do not. */

#ifdef __cplusplus
extern "C" {
#endif

#define CP_ROAD_NONE UINT32_MAX

/* One lane as the simulation tells it. */
typedef struct cp_road_lane {
    const char *edge;     /* borrowed while the network is built */
    const char *junction; /* of a lane inside a junction, else NULL; borrowed likewise */
    double length_m;
    double begin_x_m, begin_y_m; /* ends of its centre line */
    double end_x_m, end_y_m;
} cp_road_lane;

/* From one lane to another over a junction. */
typedef struct cp_road_connection {
    uint32_t from_lane, to_lane; /* by index */
    uint32_t via_lane;           /* lane inside the junction; CP_ROAD_NONE without one */
} cp_road_connection;

typedef struct cp_road_network cp_road_network;

/* Built once, constant. Both directions of a road are one road: an edge and another that leads back
 * between the same junctions. Errors: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_road_network_create(const cp_road_lane *lanes, size_t lane_count,
                                               const cp_road_connection *connections,
                                               size_t connection_count, cp_road_network **network,
                                               cp_error *error);
void cp_road_network_destroy(cp_road_network *network); /* NULL is fine */

/* A place: how far along a lane. */
typedef struct cp_road_place {
    uint32_t lane; /* index */
    double position_m;
} cp_road_place;

/* Shortest way between two places along the roads, regardless of direction; a junction is a point.
 * INFINITY when there is none of at most reach_m, or a lane is unknown. */
double cp_road_distance_m(const cp_road_network *network, cp_road_place one, cp_road_place other,
                          double reach_m);

#ifdef __cplusplus
}
#endif

#endif
