/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_SUMO_VEHICLES_H
#define TRAFFIC_SUMO_VEHICLES_H

#include "traffic/straight_run.h"
#include "traffic/sumo_names.h"
#include "traffic/vehicle_state.h"

#include <libsumo/libsumo.h>

/* (C++, inside the bridge only.) The vehicles of the SUMO simulation that is running, and their
 * states after each step. Exceptions of libsumo pass through. */

class SumoVehicles
{
  public:
    // lanes: numbers of lanes; borrowed.
    explicit SumoVehicles(Names *lanes) : lanes_(lanes)
    {
    }
    // After a step of SUMO's: who came and went, states of all on the road in SUMO's order.
    void read_step();
    // Lane, place along it and is_in_junction of a state.
    void read_place(const std::string &id, cp_vehicle_state *state);

    VehicleNames names;
    Names types;
    bool reads_places = true;
    std::vector<cp_vehicle_state> states; // of the last step
    std::vector<uint32_t> departed;       // in the last step

  private:
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
    struct Size {
        double length_m;
        double width_m;
    };
    enum class Where { ON_THE_ROAD, ELSEWHERE, GONE };

    uint32_t number_type(const std::string &type);
    void read_lane(const std::string &id, uint32_t *last, cp_vehicle_state *state);
    static void read_motion(Driving *driving, const libsumo::TraCIPosition &position,
                            cp_vehicle_state *state);
    Where read_vehicle(Driving *driving, cp_vehicle_state *state);
    void keep_account();
    void check_account() const;

    Names *lanes_;
    std::vector<Size> size_of_type_;
    std::vector<Driving> under_way_;   // departed and not arrived, by id
    std::vector<std::string> leaving_; // ids of those who went in this step
    uint64_t steps_ = 0;
};

#endif
