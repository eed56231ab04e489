/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_SUMO_ROADS_H
#define TRAFFIC_SUMO_ROADS_H

#include "traffic/lane_map.h"
#include "traffic/road_network.h"
#include "traffic/sumo_names.h"

/* (C++, inside the bridge only.) The roads of the SUMO simulation that is running, read once: a
 * part of the bridge (sumo_bridge.h), whose conventions hold. */

/* How the bridge numbers names; borrowed. A name that has no number gets one. */
struct cp_sumo_numbers {
    Names *lanes, *edges;
    uint32_t lane(const char *id) const
    {
        return lanes->number(id);
    }
    uint32_t edge(const char *id) const
    {
        return edges->number(id);
    }
    size_t lane_count() const
    {
        return lanes->size();
    }
};

/* Both owned by the caller. Errors: CP_NO_MEMORY. Exceptions of libsumo pass through. */
CP_MUST_CHECK cp_status cp_sumo_roads_read(const cp_sumo_numbers *numbers, cp_road_network **roads,
                                           cp_lane_map **lanes, cp_error *error);

/* Two lanes inside one junction that has right-of-way rules: where lines cross and the rules see no
 * conflict, one passes over the other. Exceptions of libsumo pass through. */
bool cp_sumo_lanes_pass_over(const char *one, const char *other);

#endif
