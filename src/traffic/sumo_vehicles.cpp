/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/sumo_vehicles.h"

#include "core/units.h"

#include <cmath>
#include <stdexcept>

uint32_t SumoVehicles::number_type(const std::string &type)
{
    uint32_t number = types.number(type);
    if (number == size_of_type_.size())
        size_of_type_.push_back(
            {libsumo::VehicleType::getLength(type), libsumo::VehicleType::getWidth(type)});
    return number;
}

namespace
{

// From degrees clockwise from north; in (-pi, pi], and 0 exactly for due east.
double yaw_of_sumo_angle(double angle_deg)
{
    double yaw_deg = std::remainder(90.0 - angle_deg, 360.0);
    return cp_rad_from_deg(yaw_deg <= -180.0 ? 180.0 : yaw_deg);
}

} // namespace

// last: number of the lane it was seen on last, mostly that of now too.
void SumoVehicles::read_lane(const std::string &id, uint32_t *last, cp_vehicle_state *state)
{
    const std::string lane = libsumo::Vehicle::getLaneID(id);
    if (*last == CP_NO_NUMBER || *lanes_->name(*last) != lane)
        *last = lanes_->number(lane);
    state->lane = *last;
    state->is_in_junction = !lane.empty() && lane[0] == ':';
    state->lane_position_m = libsumo::Vehicle::getLanePosition(id);
}

void SumoVehicles::read_place(const std::string &id, cp_vehicle_state *state)
{
    uint32_t last = CP_NO_NUMBER;
    read_lane(id, &last, state);
}

// Where it is heading and how fast, from SUMO only where the way of its front does not tell: to ask
// is to look it up by id, twice. One that stood already and has not moved since does both as
// before; one that drives straight on heads as before.
void SumoVehicles::read_motion(Driving *driving, const libsumo::TraCIPosition &position,
                               cp_vehicle_state *state)
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
SumoVehicles::Where SumoVehicles::read_vehicle(Driving *driving, cp_vehicle_state *state)
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
    if (reads_places)
        read_lane(id, &driving->lane, state);
    state->front_x_m = position.x;
    state->front_y_m = position.y;
    state->elevation_m = position.z;
    state->length_m = size_of_type_[state->type].length_m;
    state->width_m = size_of_type_[state->type].width_m;
    read_motion(driving, position, state);
    return Where::ON_THE_ROAD;
}

// Vehicles that came or went in this step. SUMO's own list of all, which is in the order of their
// ids too, costs as much as reading a state: it copies every id.
void SumoVehicles::keep_account()
{
    const auto by_id = [](const Driving &one, const std::string &id) { return *one.id < id; };
    std::vector<Driving> &all = under_way_;
    for (const std::string &id : leaving_)
        names.forget_id(id);
    leaving_.clear();
    departed.clear();
    for (const std::string &id : libsumo::Simulation::getDepartedIDList()) {
        const VehicleNames::Entry comer = names.find(id);
        departed.push_back(comer.number);
        const auto place = std::lower_bound(all.begin(), all.end(), id, by_id);
        if (place == all.end() || place->vehicle != comer.number)
            all.insert(place, {comer.number, comer.id});
    }
    for (const std::string &id : libsumo::Simulation::getArrivedIDList()) {
        const auto place = std::lower_bound(all.begin(), all.end(), id, by_id);
        if (place == all.end() || *place->id != id)
            continue;
        all.erase(place);
        leaving_.push_back(id);
    }
}

// Our account against SUMO's list: a vehicle left out would be one whose crashes nobody sees.
void SumoVehicles::check_account() const
{
    const std::vector<std::string> listed = libsumo::Vehicle::getIDList();
    const bool is_right = std::equal(listed.begin(), listed.end(), states.begin(), states.end(),
                                     [this](const std::string &id, const cp_vehicle_state &state) {
                                         return id == names.text(state.vehicle);
                                     });
    if (!is_right)
        throw std::logic_error("there are " + std::to_string(listed.size()) +
                               " vehicles, but by departures and arrivals " +
                               std::to_string(states.size()));
}

void SumoVehicles::read_step()
{
    const uint64_t steps_between_checks = 64;
    steps_++;
    keep_account();
    std::vector<Driving> &all = under_way_;
    states.resize(all.size());
    size_t kept = 0, read = 0;
    for (size_t k = 0; k < all.size(); k++) {
        const Where where = read_vehicle(&all[k], &states[read]);
        if (where == Where::GONE) {
            leaving_.push_back(*all[k].id);
            continue;
        }
        if (where == Where::ON_THE_ROAD)
            read++;
        if (kept != k)
            all[kept] = all[k];
        kept++;
    }
    all.resize(kept, Driving{});
    states.resize(read);
    if (steps_ % steps_between_checks == 1)
        check_account();
}
