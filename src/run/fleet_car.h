/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_FLEET_CAR_H
#define RUN_FLEET_CAR_H

#include "run/fleet.h"

/* The car that one vehicle of traffic crashes as. In a study with vehicles.fleet the first of
 * these:
 *   1. study, sumo_type   as of run/fleet.h; the name of a vehicle class means a car drawn from it
 *   2. market             the study has shares of classes for the vehicle's SUMO type
 *   3. fleet              a class that holds the type's vClass and size, by the shares of
 *                         crash/vehicle_choice.h
 * else, and in studies without a fleet, the rules of run/fleet.h.
 *
 * The car of a class is drawn by the study's seed, the number of the replication and the vehicle's
 * id: it is the same in every variant and on any worker. Heavy vehicles have the length of the
 * vehicle in any study (crash/drawn_car.h). */

/* Draw from now on for the replication of that number. */
void cp_fleet_begin(cp_fleet *fleet, size_t replication_number);

/* car: its model, not yet covering the vehicle's rectangle; unspecified where choice has no model.
 * Errors: those of cp_fleet_choose and cp_drawn_car. */
CP_MUST_CHECK cp_status cp_fleet_car(const cp_fleet *fleet, const char *sumocfg_path,
                                     const char *sumo_type, const cp_sumo_type *type,
                                     const char *sumo_id, cp_fleet_choice *choice,
                                     cp_vehicle_model *car, cp_error *error);

#endif
