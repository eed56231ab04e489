/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_FLEET_H
#define RUN_FLEET_H

#include "core/rng.h"
#include "crash/vehicle_choice.h"
#include "crash/vehicle_model.h"
#include "study/plan.h"
#include "traffic/vehicle_state.h"

/* The surrogate models of a study: which car a SUMO vehicle type crashes as. First of these that
 * applies:
 *   1. study          the study file maps the type: vehicles.types
 *   2. sumo_type      the type names it: <param key="crashpulse.model" value="..."/>, the name of a
 *                     model of the study or of a shipped one, or a path as seen from the .sumocfg
 *   3. study_default  the type is a car by class and size, and the study has vehicles.default
 *   4. class_and_size the table of crash/vehicle_choice.h
 * else it has no model and its crashes are kept without a severity. */

/* Row name of a vehicle without a model. */
#define CP_NO_VEHICLE_MODEL "none"

typedef struct cp_fleet {
    const cp_study *study;    /* borrowed */
    cp_vehicle_model *models; /* one for each of study->vehicles (name "": it has no default), then
                                 those that SUMO types name by path, the shipped ones, none */
    cp_vehicle_model_row *rows; /* the same for the database */
    char **paths;               /* resolved, of those that SUMO types name by path; else NULL */
    size_t count;
    cp_rng_key cars; /* what the cars of a replication are drawn by (run/fleet_car.h) */
} cp_fleet;

/* Load all vehicle files of the study and of its scenarios' vehicle types. Errors: CP_BAD_INPUT
 * with file, line and field. After an error the fleet is destroyed already. */
CP_MUST_CHECK cp_status cp_fleet_load(const cp_study *study, cp_fleet *fleet, cp_error *error);
void cp_fleet_destroy(cp_fleet *fleet);

/* What was chosen, and by which of the rules above. */
typedef struct cp_fleet_choice {
    const cp_vehicle_model *model;      /* NULL: none */
    const char *chosen_by;              /* static text; "" without a model */
    char reason[CP_CHOICE_REASON_SIZE]; /* why there is none */
} cp_fleet_choice;

/* Errors: CP_BAD_INPUT with file and line when the study's market names no class of a fleet. */
CP_MUST_CHECK cp_status cp_fleet_check_market(const cp_study *study, cp_error *error);

/* The model of that name; NULL when the fleet has none. */
const cp_vehicle_model *cp_fleet_find(const cp_fleet *fleet, const char *name);

/* sumocfg_path: of the scenario, from which paths are seen. Errors: CP_BAD_INPUT for a type that
 * names a model the fleet does not have. */
CP_MUST_CHECK cp_status cp_fleet_choose(const cp_fleet *fleet, const char *sumocfg_path,
                                        const char *sumo_type, const cp_sumo_type *type,
                                        cp_fleet_choice *choice, cp_error *error);

#endif
