/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_SUMO_ROAD_RELATION_H
#define TRAFFIC_SUMO_ROAD_RELATION_H

#include "core/error.h"
#include "traffic/lane_map.h"
#include "traffic/road_network.h"
#include "traffic/sumo_names.h"
#include "traffic/vehicle_state.h"

/* (C++, inside the bridge only.) How the roads of two vehicles lie to each other, by the network of
 * the SUMO simulation that is running. Exceptions of libsumo pass through. */

class SumoRoadRelation
{
  public:
    SumoRoadRelation() = default;
    SumoRoadRelation(const SumoRoadRelation &) = delete;
    SumoRoadRelation &operator=(const SumoRoadRelation &) = delete;
    ~SumoRoadRelation();

    // The roads, read when first asked for. lanes, edges: numbers of lanes and edges. Error:
    // CP_NO_MEMORY.
    cp_status read(Names *lanes, Names *edges, cp_error *error);
    // After read; the relation is left as it is when the roads meet.
    void relate(const Names &lanes, const cp_vehicle_state *one, const cp_vehicle_state *other,
                cp_road_relation *relation) const;
    // After read.
    const cp_lane_map *lane_map() const
    {
        return lane_map_;
    }

  private:
    cp_road_network *roads_ = nullptr; // lanes by number
    cp_lane_map *lane_map_ = nullptr;
};

#endif
