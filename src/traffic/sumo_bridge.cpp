/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/sumo_bridge.h"

#include "core/units.h"
#include "traffic/straight_run.h"
#include "traffic/sumo_options.h"
#include "traffic/sumo_roads.h"

#include <libsumo/libsumo.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>
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

// A vehicle between departure and arrival.
struct Driving {
    uint32_t vehicle;
    const std::string *id;
    uint32_t type = CP_NO_NUMBER; // looked up when it is first seen: it stays the same
    uint32_t lane = CP_NO_NUMBER; // as last seen
    bool stands = false;          // where it was a step before
    double z_m = 0.0;             // as last seen
    double yaw_rad = 0.0;         // likewise
    cp_straight_run run = {};
};

// Vehicles by number and id. Numbers and texts are for good: contacts name vehicles that have long
// gone. The way from the id to the number, which takes most room, is kept only while SUMO has it.
class Vehicles
{
  public:
    Driving find(const std::string &id)
    {
        auto [entry, is_new] = numbers_.try_emplace(id, static_cast<uint32_t>(texts_.size()));
        if (is_new)
            texts_.push_back(keep(id));
        return {entry->second, &entry->first}; // keys of an unordered_map stay where they are
    }
    bool has(uint32_t vehicle) const
    {
        return vehicle < texts_.size();
    }
    const char *text(uint32_t vehicle) const
    {
        return has(vehicle) ? &blocks_[texts_[vehicle] / BLOCK][texts_[vehicle] % BLOCK] : "";
    }
    void forget_id(const std::string &id)
    {
        numbers_.erase(id);
    }

  private:
    // A copy that stays where it is: number of its block times BLOCK, plus its place there. A
    // longer one has a block of its own.
    uint32_t keep(const std::string &id)
    {
        const size_t size = id.size() + 1;
        if (blocks_.empty() || used_ + size > BLOCK) {
            blocks_.push_back(std::make_unique<char[]>(std::max<size_t>(size, BLOCK)));
            used_ = 0;
        }
        const uint32_t place = static_cast<uint32_t>((blocks_.size() - 1) * BLOCK + used_);
        std::copy_n(id.c_str(), size, &blocks_.back()[used_]);
        used_ += size;
        return place;
    }

    static constexpr uint32_t BLOCK = 16384; // 4 GB of names in all
    std::unordered_map<std::string, uint32_t> numbers_;
    std::vector<uint32_t> texts_; // where it is kept
    std::vector<std::unique_ptr<char[]>> blocks_;
    size_t used_ = 0; // of the last block
};

struct Size {
    double length_m;
    double width_m;
};

// A speed commanded before the coming step.
struct SpeedCommand {
    uint32_t vehicle;
    double speed_m_s;
};

struct Bridge {
    bool running = false;
    std::string command_line;
    Vehicles vehicles;
    Names types, lanes, edges, lights, collision_types;
    std::vector<Size> size_of_type;
    std::vector<cp_vehicle_state> states;
    std::vector<uint32_t> departed;
    std::vector<Driving> under_way;   // departed and not arrived, by id
    std::vector<std::string> leaving; // ids of those who went in this step
    bool reads_places = true;
    uint64_t step = 0;
    std::vector<cp_sumo_collision> collisions;
    std::vector<SpeedCommand> speed_commands; // since the last step
    cp_road_network *roads = nullptr;         // read when first asked for; lanes by number
    cp_lane_map *lane_map = nullptr;          // likewise

    Bridge() = default;
    Bridge(const Bridge &) = delete;
    Bridge &operator=(const Bridge &) = delete;
    ~Bridge()
    {
        cp_road_network_destroy(roads);
        cp_lane_map_destroy(lane_map);
    }
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

// last: number of the lane it was seen on last, mostly that of now too.
void read_place(const std::string &id, uint32_t *last, cp_vehicle_state *state)
{
    const std::string lane = libsumo::Vehicle::getLaneID(id);
    if (*last == CP_NO_NUMBER || *bridge->lanes.name(*last) != lane)
        *last = bridge->lanes.number(lane);
    state->lane = *last;
    state->is_in_junction = !lane.empty() && lane[0] == ':';
    state->lane_position_m = libsumo::Vehicle::getLanePosition(id);
}

enum class Where { ON_THE_ROAD, ELSEWHERE, GONE };

// Where it is heading and how fast, from SUMO only where the way of its front does not tell: to ask
// is to look it up by id, twice. One that stood already and has not moved since does both as
// before; one that drives straight on heads as before.
void read_motion(Driving *driving, const libsumo::TraCIPosition &position, cp_vehicle_state *state)
{
    const bool has_stayed = position.x == driving->run.x_m && position.y == driving->run.y_m &&
                            position.z == driving->z_m;
    const bool is_told =
        cp_straight_run_move(&driving->run, position.x, position.y, state->length_m);
    if (!driving->stands || !has_stayed) {
        if (is_told) {
            driving->yaw_rad = driving->run.yaw_rad;
        } else {
            driving->yaw_rad = yaw_of_sumo_angle(libsumo::Vehicle::getAngle(*driving->id));
            cp_straight_run_head(&driving->run, driving->yaw_rad);
        }
        state->speed_m_s = libsumo::Vehicle::getSpeed(*driving->id);
        driving->stands = has_stayed && state->speed_m_s == 0.0;
        driving->z_m = position.z;
    }
    state->yaw_rad = driving->yaw_rad;
}

// Read one vehicle, if it is on the road.
Where read_vehicle(Driving *driving, cp_vehicle_state *state)
{
    using libsumo::Vehicle;
    const std::string &id = *driving->id;
    libsumo::TraCIPosition position;
    try {
        position = Vehicle::getPosition(id, true);
    } catch (const libsumo::TraCIException &) {
        return Where::GONE; // taken out on the way, by us or by a calibrator: not among the arrived
    }
    if (position.x <= -1e9 || position.y <= -1e9) {
        driving->stands = false; // it may come back on the move and elsewhere
        driving->run.is_on = false;
        return Where::ELSEWHERE;
    }
    *state = cp_vehicle_state{};
    if (driving->type == CP_NO_NUMBER)
        driving->type = number_type(Vehicle::getTypeID(id));
    state->vehicle = driving->vehicle;
    state->type = driving->type;
    if (bridge->reads_places)
        read_place(id, &driving->lane, state);
    state->front_x_m = position.x;
    state->front_y_m = position.y;
    state->elevation_m = position.z;
    state->length_m = bridge->size_of_type[state->type].length_m;
    state->width_m = bridge->size_of_type[state->type].width_m;
    read_motion(driving, position, state);
    return Where::ON_THE_ROAD;
}

// Vehicles that came or went in this step. SUMO's own list of all, which is in the order of their
// ids too, costs as much as reading a state: it copies every id.
void keep_account()
{
    const auto by_id = [](const Driving &one, const std::string &id) { return *one.id < id; };
    std::vector<Driving> &all = bridge->under_way;
    for (const std::string &id : bridge->leaving)
        bridge->vehicles.forget_id(id);
    bridge->leaving.clear();
    bridge->departed.clear();
    for (const std::string &id : libsumo::Simulation::getDepartedIDList()) {
        const Driving comer = bridge->vehicles.find(id);
        bridge->departed.push_back(comer.vehicle);
        const auto place = std::lower_bound(all.begin(), all.end(), id, by_id);
        if (place == all.end() || place->vehicle != comer.vehicle)
            all.insert(place, comer);
    }
    for (const std::string &id : libsumo::Simulation::getArrivedIDList()) {
        const auto place = std::lower_bound(all.begin(), all.end(), id, by_id);
        if (place == all.end() || *place->id != id)
            continue;
        all.erase(place);
        bridge->leaving.push_back(id);
    }
}

// Our account against SUMO's list: a vehicle left out would be one whose crashes nobody sees.
void check_account()
{
    const std::vector<std::string> listed = libsumo::Vehicle::getIDList();
    const bool is_right =
        std::equal(listed.begin(), listed.end(), bridge->states.begin(), bridge->states.end(),
                   [](const std::string &id, const cp_vehicle_state &state) {
                       return id == bridge->vehicles.text(state.vehicle);
                   });
    if (!is_right)
        throw std::logic_error("there are " + std::to_string(listed.size()) +
                               " vehicles, but by departures and arrivals " +
                               std::to_string(bridge->states.size()));
}

void step()
{
    const uint64_t steps_between_checks = 64;
    libsumo::Simulation::step();
    bridge->speed_commands.clear();
    bridge->step++;
    keep_account();
    std::vector<Driving> &all = bridge->under_way;
    bridge->states.resize(all.size());
    size_t kept = 0, read = 0;
    for (size_t k = 0; k < all.size(); k++) {
        const Where where = read_vehicle(&all[k], &bridge->states[read]);
        if (where == Where::GONE) {
            bridge->leaving.push_back(*all[k].id);
            continue;
        }
        if (where == Where::ON_THE_ROAD)
            read++;
        if (kept != k)
            all[kept] = all[k];
        kept++;
    }
    all.resize(kept, Driving{});
    bridge->states.resize(read);
    if (bridge->step % steps_between_checks == 1)
        check_account();
}

// The roads, read when first asked for.
cp_status need_roads(cp_error *error)
{
    static const cp_sumo_numbers NUMBERS = {
        [](const char *id) { return bridge->lanes.number(id); },
        [](const char *id) { return bridge->edges.number(id); },
        [] { return bridge->lanes.size(); },
    };
    if (bridge->roads)
        return CP_OK;
    return cp_sumo_roads_read(&NUMBERS, &bridge->roads, &bridge->lane_map, error);
}

cp_status relate(const cp_vehicle_state *one, const cp_vehicle_state *other,
                 cp_road_relation *relation, cp_error *error)
{
    const double level_m = 2.5; // less than a bridge is high, more than a ramp climbs over a truck
    const double margin_m = 10.0; // stop lines set back, corners cut
    cp_status status = need_roads(error);
    if (status != CP_OK)
        return status;
    // A place before the beginning of a lane lies on one before it, as far away at most.
    const double before_m =
        std::max(0.0, -one->lane_position_m) + std::max(0.0, -other->lane_position_m);
    const double reach_m = std::max(one->length_m, other->length_m) + margin_m + before_m;
    const double distance_m = cp_road_distance_m(bridge->roads, {one->lane, one->lane_position_m},
                                                 {other->lane, other->lane_position_m}, reach_m);
    if (!(distance_m <= reach_m))
        *relation = CP_ROADS_APART;
    else if (std::fabs(one->elevation_m - other->elevation_m) > level_m ||
             cp_sumo_lanes_pass_over(bridge->lanes.text(one->lane),
                                     bridge->lanes.text(other->lane)))
        *relation = CP_ROADS_OTHER_LEVEL;
    return CP_OK;
}

// A command to one vehicle by its id.
template <typename Call>
cp_status command_vehicle(const char *what, uint32_t vehicle, cp_error *error, Call call)
{
    cp_status status = need_running(error);
    if (status != CP_OK)
        return status;
    if (!bridge->vehicles.has(vehicle))
        return cp_fail(error, CP_TRAFFIC_FAILED, "%s: there is no vehicle number %u", what,
                       static_cast<unsigned>(vehicle));
    return guarded(what, CP_TRAFFIC_FAILED, error, [&] { call(bridge->vehicles.text(vehicle)); });
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

void sumo_bridge_read_places(bool wanted)
{
    if (bridge)
        bridge->reads_places = wanted;
}

cp_status sumo_bridge_place(cp_vehicle_state *state, cp_error *error)
{
    return command_vehicle("place", state->vehicle, error, [=](const std::string &id) {
        uint32_t last = CP_NO_NUMBER;
        read_place(id, &last, state);
    });
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
            bridge->collisions.push_back({bridge->vehicles.find(collision.collider).vehicle,
                                          bridge->vehicles.find(collision.victim).vehicle,
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
        status = guarded("roads", CP_TRAFFIC_FAILED, error,
                         [&] { answer = relate(one, other, relation, error); });
    return status != CP_OK ? status : answer;
}

cp_status sumo_bridge_lane_map(const cp_lane_map **map, cp_error *error)
{
    *map = nullptr;
    cp_status status = need_running(error), answer = CP_OK;
    if (status == CP_OK)
        status = guarded("roads", CP_TRAFFIC_FAILED, error, [&] { answer = need_roads(error); });
    if (status == CP_OK && answer == CP_OK)
        *map = bridge->lane_map;
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

cp_status sumo_bridge_type(const char *type_id, cp_sumo_type *type, cp_error *error)
{
    using libsumo::VehicleType;
    *type = {};
    std::string vehicle_class, model, mass;
    cp_status status = need_running(error);
    if (status == CP_OK)
        status = guarded(type_id, CP_TRAFFIC_FAILED, error, [&] {
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
    *vehicles = bridge->departed.data();
    *count = bridge->departed.size();
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
    return guarded("lane width", CP_TRAFFIC_FAILED, error,
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
