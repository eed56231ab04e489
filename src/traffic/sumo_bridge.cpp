/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/sumo_bridge.h"

#include "core/units.h"

#include <libsumo/libsumo.h>

#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <unordered_map>
#include <vector>

namespace
{

// Names numbered in the order they are first seen.
class Names
{
  public:
    uint32_t number(const std::string &name)
    {
        auto [entry, is_new] = numbers_.try_emplace(name, static_cast<uint32_t>(names_.size()));
        if (is_new)
            names_.push_back(&entry->first); // keys of an unordered_map stay where they are
        return entry->second;
    }
    size_t size() const
    {
        return names_.size();
    }
    const std::string *name(uint32_t number) const
    {
        return number < names_.size() ? names_[number] : nullptr;
    }
    const char *text(uint32_t number) const
    {
        return number < names_.size() ? names_[number]->c_str() : "";
    }

  private:
    std::unordered_map<std::string, uint32_t> numbers_;
    std::vector<const std::string *> names_;
};

struct Size {
    double length_m;
    double width_m;
};

struct Bridge {
    bool running = false;
    std::string command_line;
    Names vehicles, types, lanes, collision_types;
    std::vector<Size> size_of_type;
    std::vector<cp_vehicle_state> states;
    std::vector<uint32_t> departed, gone, present, present_before;
    std::vector<uint64_t> seen_in_step; // by vehicle number
    uint64_t step = 0;
    std::vector<cp_sumo_collision> collisions;
};

// libsumo keeps one simulation a process, so the bridge keeps one record.
std::unique_ptr<Bridge> bridge;

// What SUMO writes to its terminal streams while this object lives, kept instead of printed: SUMO's
// exceptions often say only "Process Error", the cause is on std::cerr.
class Messages
{
  public:
    Messages() : cerr_(std::cerr.rdbuf(text_.rdbuf())), cout_(std::cout.rdbuf(text_.rdbuf()))
    {
    }
    ~Messages()
    {
        std::cerr.rdbuf(cerr_);
        std::cout.rdbuf(cout_);
    }
    Messages(const Messages &) = delete;
    Messages &operator=(const Messages &) = delete;
    std::string text() const
    {
        return text_.str();
    }
    bool is_empty()
    {
        return text_.tellp() == std::streampos(0);
    }

  private:
    std::ostringstream text_;
    std::streambuf *cerr_;
    std::streambuf *cout_;
};

// The lines of text that tell something new. Progress ("Loading configuration ... done.") does not,
// nor do collisions and the hard braking before them: they are what a run is for, come by the
// thousand and are read through sumo_bridge_collisions.
std::vector<std::string> telling_lines(const std::string &text)
{
    static const char *const EXPECTED[] = {"collision with", "performs emergency braking"};
    std::istringstream lines(text);
    std::vector<std::string> telling;
    for (std::string line; std::getline(lines, line);) {
        bool is_expected =
            line.empty() || line.rfind("Loading ", 0) == 0 || line.rfind("Quitting", 0) == 0;
        for (const char *words : EXPECTED)
            is_expected |= line.find(words) != std::string::npos;
        if (!is_expected)
            telling.push_back(line);
    }
    return telling;
}

// Warnings of a call that went well: on to the person at the terminal.
void pass_on(const std::string &printed)
{
    for (const std::string &line : telling_lines(printed))
        std::cerr << "SUMO: " << line << std::endl;
}

// SUMO's messages and the exception's own text as one line.
std::string explain(const std::string &printed, const std::string &reason)
{
    std::string text;
    for (std::string line : telling_lines(printed)) {
        if (line.rfind("Error: ", 0) == 0)
            line.erase(0, 7);
        text += (text.empty() ? "" : "; ") + line;
    }
    bool says_more = reason != "Process Error" && text.find(reason) == std::string::npos;
    if (text.empty())
        return reason;
    return says_more ? reason + ": " + text : text;
}

// Run call; every exception becomes status with SUMO's words. whose names what was asked.
template <typename Call>
cp_status guarded(const char *whose, cp_status failure, cp_error *error, Call call)
{
    std::string what, printed;
    try {
        Messages messages;
        try {
            call();
            if (messages.is_empty())
                return CP_OK;
            printed = messages.text();
        } catch (const std::exception &exception) {
            what = exception.what();
            printed = messages.text();
            if (what.empty())
                what = "Process Error";
        } catch (...) {
            what = "unknown exception";
            printed = messages.text();
        }
    } catch (...) {
        return cp_fail_memory(error, "SUMO's messages");
    }
    try {
        if (what.empty()) {
            pass_on(printed);
            return CP_OK;
        }
        return cp_fail(error, failure, "%s: %s", whose, explain(printed, what).c_str());
    } catch (...) {
        return cp_fail_memory(error, "SUMO's messages");
    }
}

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
    const char *const ours[] = {"--no-step-log",
                                "true",
                                "--duration-log.disable",
                                "true",
                                "--step-method.ballistic",
                                "true",
                                "--collision.action",
                                "warn",
                                "--collision.check-junctions",
                                "true",
                                "--collision.mingap-factor",
                                "0"};
    words.insert(words.end(), std::begin(ours), std::end(ours));
    words.insert(words.end(), {"--thread-rngs", std::to_string(streams), "--seed",
                               std::to_string(seed & INT32_MAX), "--step-length", step.str()});
    return words;
}

void close_quietly()
{
    Messages messages;
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
    size_t lanes = static_cast<size_t>(libsumo::Lane::getIDCount());
    if (lanes > streams) {
        while (streams < lanes)
            streams *= 2;
        words = command(sumocfg, seed, step_length_s, options, option_count, streams);
        close_quietly();
        libsumo::Simulation::start(words);
    }
    for (const std::string &word : words)
        bridge->command_line += (bridge->command_line.empty() ? "" : " ") + word;
}

uint32_t number_type(const std::string &type)
{
    uint32_t number = bridge->types.number(type);
    if (number == bridge->size_of_type.size())
        bridge->size_of_type.push_back(
            {libsumo::VehicleType::getLength(type), libsumo::VehicleType::getWidth(type)});
    return number;
}

// From degrees clockwise from north; in (-pi, pi], and 0 exactly for due east.
double yaw_of_sumo_angle(double angle_deg)
{
    double yaw_deg = std::remainder(90.0 - angle_deg, 360.0);
    return cp_rad_from_deg(yaw_deg <= -180.0 ? 180.0 : yaw_deg);
}

// Read one vehicle; false when it is not on the road.
bool read_vehicle(const std::string &id, cp_vehicle_state *state)
{
    using libsumo::Vehicle;
    const libsumo::TraCIPosition position = Vehicle::getPosition(id);
    if (position.x <= -1e9 || position.y <= -1e9)
        return false;
    state->vehicle = bridge->vehicles.number(id);
    state->type = number_type(Vehicle::getTypeID(id));
    state->lane = bridge->lanes.number(Vehicle::getLaneID(id));
    state->front_x_m = position.x;
    state->front_y_m = position.y;
    state->yaw_rad = yaw_of_sumo_angle(Vehicle::getAngle(id));
    state->speed_m_s = Vehicle::getSpeed(id);
    state->acceleration_m_s2 = Vehicle::getAcceleration(id);
    state->lane_position_m = Vehicle::getLanePosition(id);
    state->length_m = bridge->size_of_type[state->type].length_m;
    state->width_m = bridge->size_of_type[state->type].width_m;
    return true;
}

void step()
{
    libsumo::Simulation::step();
    bridge->step++;
    bridge->present_before.swap(bridge->present);
    bridge->present.clear();
    bridge->states.clear();
    for (const std::string &id : libsumo::Vehicle::getIDList()) {
        cp_vehicle_state state;
        if (!read_vehicle(id, &state))
            continue;
        bridge->states.push_back(state);
        bridge->present.push_back(state.vehicle);
        if (state.vehicle >= bridge->seen_in_step.size())
            bridge->seen_in_step.resize(2 * static_cast<size_t>(state.vehicle) + 64, 0);
        bridge->seen_in_step[state.vehicle] = bridge->step;
    }
    bridge->gone.clear();
    for (uint32_t vehicle : bridge->present_before)
        if (bridge->seen_in_step[vehicle] != bridge->step)
            bridge->gone.push_back(vehicle);
    bridge->departed.clear();
    for (const std::string &id : libsumo::Simulation::getDepartedIDList())
        bridge->departed.push_back(bridge->vehicles.number(id));
}

// A command to one vehicle by its id.
template <typename Call>
cp_status command_vehicle(const char *what, uint32_t vehicle, cp_error *error, Call call)
{
    cp_status status = need_running(error);
    if (status != CP_OK)
        return status;
    const std::string *id = bridge->vehicles.name(vehicle);
    if (!id)
        return cp_fail(error, CP_TRAFFIC_FAILED, "%s: there is no vehicle number %u", what,
                       static_cast<unsigned>(vehicle));
    return guarded(what, CP_TRAFFIC_FAILED, error, [&] { call(*id); });
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
    if (setenv("SUMO_HOME", "/usr/share/sumo", 0) != 0)
        return cp_fail_memory(error, "environment");
    try {
        bridge = std::make_unique<Bridge>();
    } catch (...) {
        return cp_fail_memory(error, "SUMO bridge");
    }
    cp_status status = guarded(sumocfg, CP_BAD_INPUT, error,
                               [&] { start(sumocfg, seed, step_length_s, options, option_count); });
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
        status = guarded("SUMO stopped", CP_TRAFFIC_FAILED, error, [] { step(); });
    if (status != CP_OK)
        return status;
    *states = bridge->states.data();
    *count = bridge->states.size();
    return CP_OK;
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
    status = guarded("SUMO's collisions", CP_TRAFFIC_FAILED, error, [] {
        bridge->collisions.clear();
        for (const libsumo::TraCICollision &collision : libsumo::Simulation::getCollisions()) {
            uint32_t type = bridge->collision_types.number(collision.type);
            bridge->collisions.push_back({bridge->vehicles.number(collision.collider),
                                          bridge->vehicles.number(collision.victim),
                                          bridge->collision_types.text(type)});
        }
    });
    if (status != CP_OK)
        return status;
    *collisions = bridge->collisions.data();
    *count = bridge->collisions.size();
    return CP_OK;
}

const char *sumo_bridge_vehicle_id(uint32_t vehicle)
{
    return bridge ? bridge->vehicles.text(vehicle) : "";
}

const char *sumo_bridge_type_id(uint32_t type)
{
    return bridge ? bridge->types.text(type) : "";
}

const char *sumo_bridge_lane_id(uint32_t lane)
{
    return bridge ? bridge->lanes.text(lane) : "";
}

cp_status sumo_bridge_departed(const uint32_t **vehicles, size_t *count, cp_error *error)
{
    *vehicles = nullptr;
    *count = 0;
    cp_status status = need_running(error);
    if (status != CP_OK)
        return status;
    *vehicles = bridge->departed.data();
    *count = bridge->departed.size();
    return CP_OK;
}

cp_status sumo_bridge_gone(const uint32_t **vehicles, size_t *count, cp_error *error)
{
    *vehicles = nullptr;
    *count = 0;
    cp_status status = need_running(error);
    if (status != CP_OK)
        return status;
    *vehicles = bridge->gone.data();
    *count = bridge->gone.size();
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
        libsumo::Vehicle::setSpeed(id, speed_m_s);
    });
}

cp_status sumo_bridge_set_speed_mode(uint32_t vehicle, int mode, cp_error *error)
{
    return command_vehicle("set speed mode", vehicle, error, [=](const std::string &id) {
        libsumo::Vehicle::setSpeedMode(id, mode);
    });
}

cp_status sumo_bridge_speed_mode(uint32_t vehicle, int *mode, cp_error *error)
{
    *mode = 0;
    return command_vehicle("get speed mode", vehicle, error, [=](const std::string &id) {
        *mode = libsumo::Vehicle::getSpeedMode(id);
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
