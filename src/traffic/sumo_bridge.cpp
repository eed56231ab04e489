/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/sumo_bridge.h"

#include "traffic/sumo_messages.h"
#include "traffic/sumo_options.h"
#include "traffic/sumo_road_relation.h"
#include "traffic/sumo_vehicles.h"

#include <libsumo/libsumo.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace
{

// A speed commanded before the coming step.
struct SpeedCommand {
    uint32_t vehicle;
    double speed_m_s;
};

struct Bridge {
    bool running = false;
    std::string command_line;
    Names lanes, edges, lights, collision_types;
    SumoVehicles vehicles{&lanes};
    SumoRoadRelation roads;
    std::vector<cp_sumo_collision> collisions;
    std::vector<SpeedCommand> speed_commands; // since the last step
};

// libsumo keeps one simulation a process, so the bridge keeps one record.
std::unique_ptr<Bridge> bridge;

cp_status need_running(cp_error *error)
{
    if (bridge && bridge->running)
        return CP_OK;
    return cp_fail(error, CP_TRAFFIC_FAILED, "no SUMO simulation is running");
}

std::vector<std::string> command(const char *sumocfg, uint64_t seed, double step_length_s,
                                 const char *const *options, size_t option_count, size_t streams)
{
    std::vector<std::string> words = {"sumo", "-c", sumocfg};
    words.insert(words.end(), options, options + option_count);
    std::ostringstream step;
    step.precision(17);
    step << step_length_s;
    for (size_t k = 0; k < CP_SUMO_RULE_COUNT; k++) {
        const cp_sumo_rule &rule = CP_SUMO_RULE[k];
        if (rule.treatment == CP_SUMO_REPLACED)
            words.insert(words.end(), {std::string("--") + rule.option, rule.value});
    }
    words.insert(words.end(), {"--thread-rngs", std::to_string(streams), "--seed",
                               std::to_string(seed & INT32_MAX), "--step-length", step.str()});
    return words;
}

void close_quietly()
{
    SumoMessages messages;
    try {
        libsumo::Simulation::close();
    } catch (...) {
        // A simulation that never came up has nothing to close.
    }
}

// Start with as many random streams as lanes: changes to one car must not change far ones. The
// number of lanes is known once the network is loaded; then start over if the first guess was low.
void start(const char *sumocfg, uint64_t seed, double step_length_s, const char *const *options,
           size_t option_count)
{
    size_t streams = 64;
    auto words = command(sumocfg, seed, step_length_s, options, option_count, streams);
    libsumo::Simulation::start(words);
    const size_t lanes = static_cast<size_t>(libsumo::Lane::getIDCount());
    if (lanes > streams) {
        streams = lanes; // not more: each is 5 kB
        words = command(sumocfg, seed, step_length_s, options, option_count, streams);
        close_quietly();
        libsumo::Simulation::start(words);
    }
    for (const std::string &word : words)
        bridge->command_line +=
            (bridge->command_line.empty() ? "" : " ") + (word.empty() ? "''" : word);
}

void step()
{
    libsumo::Simulation::step();
    bridge->speed_commands.clear();
    bridge->vehicles.read_step();
}

// A command to one vehicle by its id.
template <typename Call>
cp_status command_vehicle(const char *what, uint32_t vehicle, cp_error *error, Call call)
{
    cp_status status = need_running(error);
    if (status != CP_OK)
        return status;
    if (!bridge->vehicles.names.has(vehicle))
        return cp_fail(error, CP_TRAFFIC_FAILED, "%s: there is no vehicle number %u", what,
                       static_cast<unsigned>(vehicle));
    return cp_sumo_guarded(what, CP_TRAFFIC_FAILED, error,
                           [&] { call(bridge->vehicles.names.text(vehicle)); });
}

// Whether a command is the one to hold among those before the coming step.
bool holds(uint32_t vehicle, double speed_m_s)
{
    for (SpeedCommand &earlier : bridge->speed_commands) {
        if (earlier.vehicle != vehicle)
            continue;
        if (speed_m_s < 0.0 || speed_m_s >= earlier.speed_m_s)
            return false;
        earlier.speed_m_s = speed_m_s;
        return true;
    }
    if (speed_m_s >= 0.0)
        bridge->speed_commands.push_back({vehicle, speed_m_s});
    return true;
}

} // namespace

extern "C" {

cp_status sumo_bridge_start(const char *sumocfg, uint64_t seed, double step_length_s,
                            const char *const *options, size_t option_count, cp_error *error)
{
    sumo_bridge_stop();
    if (!(step_length_s >= 0.001))
        return cp_fail(error, CP_BAD_INPUT, "%s: step_length_s must be >= 0.001, found %g", sumocfg,
                       step_length_s);
    // SUMO counts milliseconds: it would make steps of another length than we take them for.
    if (std::fabs(1e3 * step_length_s - std::round(1e3 * step_length_s)) > 1e-6)
        return cp_fail(
            error, CP_BAD_INPUT,
            "%s: step_length_s must be whole milliseconds, as SUMO counts them, found %g", sumocfg,
            step_length_s);
    if (setenv("SUMO_HOME", "/usr/share/sumo", 0) != 0)
        return cp_fail_memory(error, "environment");
    try {
        bridge = std::make_unique<Bridge>();
    } catch (...) {
        return cp_fail_memory(error, "SUMO bridge");
    }
    cp_status status = cp_sumo_guarded(sumocfg, CP_BAD_INPUT, error, [&] {
        start(sumocfg, seed, step_length_s, options, option_count);
    });
    bridge->running = true;
    if (status != CP_OK)
        sumo_bridge_stop();
    return status;
}

void sumo_bridge_stop(void)
{
    if (bridge && bridge->running)
        close_quietly();
    bridge.reset();
}

cp_status sumo_bridge_step(const cp_vehicle_state **states, size_t *count, cp_error *error)
{
    *states = nullptr;
    *count = 0;
    cp_status status = need_running(error);
    if (status == CP_OK)
        status = cp_sumo_guarded("SUMO stopped", CP_TRAFFIC_FAILED, error, [] { step(); });
    if (status != CP_OK)
        return status;
    *states = bridge->vehicles.states.data();
    *count = bridge->vehicles.states.size();
    return CP_OK;
}

void sumo_bridge_read_places(bool wanted)
{
    if (bridge)
        bridge->vehicles.reads_places = wanted;
}

cp_status sumo_bridge_place(cp_vehicle_state *state, cp_error *error)
{
    return command_vehicle("place", state->vehicle, error,
                           [=](const std::string &id) { bridge->vehicles.read_place(id, state); });
}

double sumo_bridge_time_s(void)
{
    try {
        return bridge && bridge->running ? libsumo::Simulation::getTime() : 0.0;
    } catch (...) {
        return 0.0;
    }
}

int sumo_bridge_expected_vehicles(void)
{
    try {
        return bridge && bridge->running ? libsumo::Simulation::getMinExpectedNumber() : 0;
    } catch (...) {
        return 0;
    }
}

const char *sumo_bridge_version(void)
{
    static const std::string version = [] {
        try {
            return libsumo::Simulation::getVersion().second;
        } catch (...) {
            return std::string("SUMO");
        }
    }();
    return version.c_str();
}

const char *sumo_bridge_command_line(void)
{
    return bridge ? bridge->command_line.c_str() : "";
}

cp_status sumo_bridge_collisions(const cp_sumo_collision **collisions, size_t *count,
                                 cp_error *error)
{
    *collisions = nullptr;
    *count = 0;
    cp_status status = need_running(error);
    if (status != CP_OK)
        return status;
    status = cp_sumo_guarded("SUMO's collisions", CP_TRAFFIC_FAILED, error, [] {
        bridge->collisions.clear();
        for (const libsumo::TraCICollision &collision : libsumo::Simulation::getCollisions()) {
            uint32_t type = bridge->collision_types.number(collision.type);
            bridge->collisions.push_back({bridge->vehicles.names.find(collision.collider).number,
                                          bridge->vehicles.names.find(collision.victim).number,
                                          bridge->collision_types.text(type)});
        }
    });
    if (status != CP_OK)
        return status;
    *collisions = bridge->collisions.data();
    *count = bridge->collisions.size();
    return CP_OK;
}

cp_status sumo_bridge_road_relation(const cp_vehicle_state *one, const cp_vehicle_state *other,
                                    cp_road_relation *relation, cp_error *error)
{
    *relation = CP_ROADS_MEET;
    cp_status status = need_running(error), answer = CP_OK;
    if (status == CP_OK)
        status = cp_sumo_guarded("roads", CP_TRAFFIC_FAILED, error, [&] {
            answer = bridge->roads.read(&bridge->lanes, &bridge->edges, error);
            if (answer == CP_OK)
                bridge->roads.relate(bridge->lanes, one, other, relation);
        });
    return status != CP_OK ? status : answer;
}

cp_status sumo_bridge_lane_map(const cp_lane_map **map, cp_error *error)
{
    *map = nullptr;
    cp_status status = need_running(error), answer = CP_OK;
    if (status == CP_OK)
        status = cp_sumo_guarded("roads", CP_TRAFFIC_FAILED, error, [&] {
            answer = bridge->roads.read(&bridge->lanes, &bridge->edges, error);
        });
    if (status == CP_OK && answer == CP_OK)
        *map = bridge->roads.lane_map();
    return status != CP_OK ? status : answer;
}

// The first lane of an edge that a vehicle class may use; its first of all when none allows it.
static std::string first_lane_for(const std::string &edge, const std::string &vehicle_class)
{
    const int count = libsumo::Edge::getLaneNumber(edge);
    for (int k = 0; k < count; k++) {
        const std::string lane = edge + "_" + std::to_string(k);
        const auto allowed = libsumo::Lane::getAllowed(lane);
        const auto refused = libsumo::Lane::getDisallowed(lane);
        const auto is_in = [&](const std::vector<std::string> &list) {
            return std::find(list.begin(), list.end(), vehicle_class) != list.end();
        };
        if (allowed.empty() ? !is_in(refused) : is_in(allowed))
            return lane;
    }
    return edge + "_0";
}

cp_status sumo_bridge_next_lanes(uint32_t vehicle, uint32_t *lanes, size_t room, size_t *count,
                                 cp_error *error)
{
    *count = 0;
    return command_vehicle("route", vehicle, error, [=](const std::string &id) {
        const std::string here = libsumo::Vehicle::getLaneID(id);
        for (const auto &choice : libsumo::Vehicle::getBestLanes(id)) {
            if (choice.laneID != here)
                continue;
            for (const std::string &lane : choice.continuationLanes)
                if (lane != here && *count < room)
                    lanes[(*count)++] = bridge->lanes.number(lane);
        }
        // Inside a junction only the edges are known.
        if (here.empty() || here[0] != ':')
            return;
        const auto route = libsumo::Vehicle::getRoute(id);
        const std::string who = libsumo::Vehicle::getVehicleClass(id);
        const int last = libsumo::Vehicle::getRouteIndex(id);
        for (size_t k = (size_t)(last + 1); last >= 0 && k < route.size() && *count < room; k++)
            lanes[(*count)++] = bridge->lanes.number(first_lane_for(route[k], who));
    });
}

const char *sumo_bridge_vehicle_id(uint32_t vehicle)
{
    return bridge ? bridge->vehicles.names.text(vehicle) : "";
}

const char *sumo_bridge_type_id(uint32_t type)
{
    return bridge ? bridge->vehicles.types.text(type) : "";
}

const char *sumo_bridge_lane_id(uint32_t lane)
{
    return bridge ? bridge->lanes.text(lane) : "";
}

cp_status sumo_bridge_type(const char *type_id, cp_sumo_type *type, cp_error *error)
{
    using libsumo::VehicleType;
    *type = {};
    std::string vehicle_class, model, mass;
    cp_status status = need_running(error);
    if (status == CP_OK)
        status = cp_sumo_guarded(type_id, CP_TRAFFIC_FAILED, error, [&] {
            vehicle_class = VehicleType::getVehicleClass(type_id);
            model = VehicleType::getParameter(type_id, SUMO_BRIDGE_MODEL_KEY);
            mass = VehicleType::getParameter(type_id, "vehicleMass");
            type->length_m = VehicleType::getLength(type_id);
            type->width_m = VehicleType::getWidth(type_id);
            type->height_m = VehicleType::getHeight(type_id);
        });
    if (status != CP_OK)
        return status;
    if (model.size() >= sizeof type->model)
        return cp_fail(error, CP_BAD_INPUT, "vehicle type '%s': %s is longer than %zu characters",
                       type_id, SUMO_BRIDGE_MODEL_KEY, sizeof type->model - 1);
    vehicle_class.copy(type->vehicle_class, sizeof type->vehicle_class - 1);
    model.copy(type->model, sizeof type->model - 1);
    type->mass_kg = std::nan("");
    if (mass.empty())
        return CP_OK;
    char *end = nullptr;
    type->mass_kg = std::strtod(mass.c_str(), &end);
    if (*end != '\0' || !(type->mass_kg > 0.0) || !std::isfinite(type->mass_kg))
        return cp_fail(error, CP_BAD_INPUT,
                       "vehicle type '%s': vehicleMass must be a mass in kg, found '%s'", type_id,
                       mass.c_str());
    return CP_OK;
}

cp_status sumo_bridge_departed(const uint32_t **vehicles, size_t *count, cp_error *error)
{
    *vehicles = nullptr;
    *count = 0;
    cp_status status = need_running(error);
    if (status != CP_OK)
        return status;
    *vehicles = bridge->vehicles.departed.data();
    *count = bridge->vehicles.departed.size();
    return CP_OK;
}

cp_status sumo_bridge_remove(uint32_t vehicle, cp_error *error)
{
    return command_vehicle("remove", vehicle, error,
                           [](const std::string &id) { libsumo::Vehicle::remove(id); });
}

cp_status sumo_bridge_set_speed(uint32_t vehicle, double speed_m_s, cp_error *error)
{
    return command_vehicle("set speed", vehicle, error, [=](const std::string &id) {
        if (holds(vehicle, speed_m_s))
            libsumo::Vehicle::setSpeed(id, speed_m_s);
    });
}

cp_status sumo_bridge_set_speed_mode(uint32_t vehicle, int mode, cp_error *error)
{
    return command_vehicle("set speed mode", vehicle, error, [=](const std::string &id) {
        libsumo::Vehicle::setSpeedMode(id, mode);
    });
}

cp_status sumo_bridge_set_lane_change_mode(uint32_t vehicle, int mode, cp_error *error)
{
    return command_vehicle("set lane change mode", vehicle, error, [=](const std::string &id) {
        libsumo::Vehicle::setLaneChangeMode(id, mode);
    });
}

cp_status sumo_bridge_speed_mode(uint32_t vehicle, int *mode, cp_error *error)
{
    *mode = 0;
    return command_vehicle("get speed mode", vehicle, error, [=](const std::string &id) {
        *mode = libsumo::Vehicle::getSpeedMode(id);
    });
}

cp_status sumo_bridge_lane_width(uint32_t lane, double *width_m, cp_error *error)
{
    *width_m = 0.0;
    cp_status status = need_running(error);
    if (status != CP_OK)
        return status;
    const std::string *id = bridge->lanes.name(lane);
    if (!id)
        return cp_fail(error, CP_TRAFFIC_FAILED, "lane width: there is no lane number %u",
                       static_cast<unsigned>(lane));
    return cp_sumo_guarded("lane width", CP_TRAFFIC_FAILED, error,
                           [&] { *width_m = libsumo::Lane::getWidth(*id); });
}

cp_status sumo_bridge_set_speed_factor(uint32_t vehicle, double factor_1, cp_error *error)
{
    return command_vehicle("set speed factor", vehicle, error, [=](const std::string &id) {
        libsumo::Vehicle::setSpeedFactor(id, factor_1);
    });
}

cp_status sumo_bridge_speed_factor(uint32_t vehicle, double *factor_1, cp_error *error)
{
    *factor_1 = 0.0;
    return command_vehicle("get speed factor", vehicle, error, [=](const std::string &id) {
        *factor_1 = libsumo::Vehicle::getSpeedFactor(id);
    });
}

cp_status sumo_bridge_next_light(uint32_t vehicle, cp_next_light *light, cp_error *error)
{
    *light = {HUGE_VAL, CP_NO_NUMBER, false};
    return command_vehicle("next traffic light", vehicle, error, [=](const std::string &id) {
        const auto lights = libsumo::Vehicle::getNextTLS(id);
        if (!lights.empty())
            *light = {lights[0].dist, bridge->lights.number(lights[0].id),
                      lights[0].state == 'r' || lights[0].state == 'R'};
    });
}

cp_status sumo_bridge_set_parameter(uint32_t vehicle, const char *key, const char *value,
                                    cp_error *error)
{
    return command_vehicle("set parameter", vehicle, error, [=](const std::string &id) {
        libsumo::Vehicle::setParameter(id, key, value);
    });
}

} // extern "C"
