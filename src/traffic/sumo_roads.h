/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_SUMO_ROADS_H
#define TRAFFIC_SUMO_ROADS_H

#include "traffic/lane_map.h"
#include "traffic/road_network.h"

/* The roads of the SUMO simulation that is running, read once: the other half of the bridge
 * (sumo_bridge.h), whose conventions hold. Used by the bridge only. */

#ifdef __cplusplus
extern "C" {
#endif

/* How the bridge numbers names. */
typedef struct cp_sumo_numbers {
    uint32_t (*lane)(const char *id); /* gives a number to one that has none */
    uint32_t (*edge)(const char *id); /* likewise */
    size_t (*lane_count)(void);       /* so far */
} cp_sumo_numbers;

/* Both owned by the caller. Errors: CP_NO_MEMORY. Exceptions of libsumo pass through. */
CP_MUST_CHECK cp_status cp_sumo_roads_read(const cp_sumo_numbers *numbers, cp_road_network **roads,
                                           cp_lane_map **lanes, cp_error *error);

/* Two lanes inside one junction that has right-of-way rules: where lines cross and the rules see no
 * conflict, one passes over the other. Exceptions of libsumo pass through. */
bool cp_sumo_lanes_pass_over(const char *one, const char *other);

#ifdef __cplusplus
}
#endif

#endif
