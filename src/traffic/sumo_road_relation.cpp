/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/sumo_road_relation.h"

#include "traffic/sumo_roads.h"

#include <algorithm>
#include <cmath>

SumoRoadRelation::~SumoRoadRelation()
{
    cp_road_network_destroy(roads_);
    cp_lane_map_destroy(lane_map_);
}

cp_status SumoRoadRelation::read(Names *lanes, Names *edges, cp_error *error)
{
    if (roads_)
        return CP_OK;
    const cp_sumo_numbers numbers = {lanes, edges};
    return cp_sumo_roads_read(&numbers, &roads_, &lane_map_, error);
}

void SumoRoadRelation::relate(const Names &lanes, const cp_vehicle_state *one,
                              const cp_vehicle_state *other, cp_road_relation *relation) const
{
    const double level_m = 2.5; // less than a bridge is high, more than a ramp climbs over a truck
    const double margin_m = 10.0; // stop lines set back, corners cut
    // A place before the beginning of a lane lies on one before it, as far away at most.
    const double before_m =
        std::max(0.0, -one->lane_position_m) + std::max(0.0, -other->lane_position_m);
    const double reach_m = std::max(one->length_m, other->length_m) + margin_m + before_m;
    const double distance_m = cp_road_distance_m(roads_, {one->lane, one->lane_position_m},
                                                 {other->lane, other->lane_position_m}, reach_m);
    if (!(distance_m <= reach_m))
        *relation = CP_ROADS_APART;
    else if (std::fabs(one->elevation_m - other->elevation_m) > level_m ||
             cp_sumo_lanes_pass_over(lanes.text(one->lane), lanes.text(other->lane)))
        *relation = CP_ROADS_OTHER_LEVEL;
}
