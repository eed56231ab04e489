/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_FLEET_H
#define RUN_FLEET_H

#include "crash/vehicle_model.h"
#include "study/plan.h"

/* The surrogate models of a study: which car a SUMO vehicle type crashes as. */
typedef struct cp_fleet {
    const cp_study *study;      /* borrowed */
    cp_vehicle_model *models;   /* one for each of study->vehicles */
    cp_vehicle_model_row *rows; /* the same for the database */
    size_t count;
} cp_fleet;

/* Load all vehicle files of the study. Errors: CP_BAD_INPUT with file, line and field. After an
 * error the fleet is destroyed already. */
CP_MUST_CHECK cp_status cp_fleet_load(const cp_study *study, cp_fleet *fleet, cp_error *error);
void cp_fleet_destroy(cp_fleet *fleet);

/* Model of a SUMO vehicle type; the default for a type the study does not name. */
const cp_vehicle_model *cp_fleet_model(const cp_fleet *fleet, const char *sumo_type);

#endif
