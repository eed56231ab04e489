/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/traffic.h"

#include "core/link_pages.h"
#include "traffic/sumo_bridge.h"

static const cp_traffic_source SUMO = {
    .step = sumo_bridge_step,
    .departed = sumo_bridge_departed,
    .time_s = sumo_bridge_time_s,
    .expected_vehicles = sumo_bridge_expected_vehicles,
    .vehicle_id = sumo_bridge_vehicle_id,
    .type_id = sumo_bridge_type_id,
    .lane_id = sumo_bridge_lane_id,
    .type = sumo_bridge_type,
    .collisions = sumo_bridge_collisions,
    .version = sumo_bridge_version,
    .command_line = sumo_bridge_command_line,
    .remove = sumo_bridge_remove,
    .set_speed = sumo_bridge_set_speed,
    .set_speed_mode = sumo_bridge_set_speed_mode,
    .set_lane_change_mode = sumo_bridge_set_lane_change_mode,
    .speed_mode = sumo_bridge_speed_mode,
    .set_speed_factor = sumo_bridge_set_speed_factor,
    .speed_factor = sumo_bridge_speed_factor,
    .set_parameter = sumo_bridge_set_parameter,
    .read_places = sumo_bridge_read_places,
    .place = sumo_bridge_place,
    .lane_width = sumo_bridge_lane_width,
    .next_light = sumo_bridge_next_light,
    .road_relation = sumo_bridge_road_relation,
    .lane_map = sumo_bridge_lane_map,
    .next_lanes = sumo_bridge_next_lanes,
    .stop = sumo_bridge_stop,
};

cp_status cp_traffic_create(const cp_traffic_options *options, cp_traffic **traffic,
                            cp_error *error)
{
    *traffic = NULL;
    cp_status status = sumo_bridge_start(options->sumocfg, options->seed, options->step_length_s,
                                         options->options, options->option_count, error);
    if (status != CP_OK)
        return status;
    // SUMO has read its network: what loading it and its libraries has touched is not needed again.
    cp_link_pages_release();
    status = cp_traffic_create_from(&SUMO, options->step_length_s, traffic, error);
    if (status != CP_OK)
        sumo_bridge_stop();
    return status;
}
