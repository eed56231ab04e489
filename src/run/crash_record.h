/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_CRASH_RECORD_H
#define RUN_CRASH_RECORD_H

#include "crash/drawn_car.h"
#include "impact/impact.h"
#include "run/fleet.h"
#include "store/result_rows.h"

/* From a confirmed impact to everything stored about the crash: configuration, description,
 * validity, and what the surrogate says. */

/* Who the two vehicles of an impact are; index 0 is role a. Texts are borrowed. */
typedef struct cp_impact_names {
    const char *sumocfg_path; /* of the scenario */
    const char *sumo_id[2];
    const char *sumo_type[2];
    cp_sumo_type type[2]; /* what that type is */
    bool at_fault[2];
    bool had_crashed[2]; /* it had crashed before: the surrogate's undamaged car is not it */
    const char *lane[2]; /* SUMO's; NULL or "": not known */
} cp_impact_names;

/* What one vehicle crashes as. */
typedef struct cp_stand_in {
    cp_fleet_choice choice;
    cp_vehicle_model model; /* covers the rectangle; without a choice only its outline counts */
    char drawn[CP_DRAWN_CAR_TEXT_SIZE]; /* what of it is not its class's (crash/drawn_car.h) */
} cp_stand_in;

/* What there is to know of a crash before it is simulated. */
typedef struct cp_crash_facts {
    double time_s;
    cp_vec2 contact_m; /* first contact point, in the frame of the configuration */
    cp_crash_configuration configuration;
    cp_crash_description description;
    double length_m[2]; /* of the rectangles that met */
    double width_m[2];
} cp_crash_facts;

/* How much of a crash is simulated. */
typedef enum cp_crash_record_extent {
    CP_RECORD_ALL,
    CP_RECORD_PULSE /* not the parameter sets of the vehicle models' ensembles */
} cp_crash_record_extent;

/* Fill row, zeroed before, and simulate; as cp_crash_record_fill, of whose names it takes no types.
 */
CP_MUST_CHECK cp_status cp_crash_record_facts(const cp_crash_facts *facts,
                                              const cp_impact_names *names,
                                              const cp_stand_in cars[2],
                                              cp_crash_record_extent extent, cp_crash_row *row,
                                              cp_error *error);

/* Fill row, zeroed before; what it owns is freed by cp_result_rows_destroy. A crash the surrogate
 * cannot simulate, or with a vehicle that has no model, is kept, with OLC status simulation_failed,
 * and logged. Models cover SUMO's rectangles (cp_vehicle_model_cover). Errors: CP_NO_MEMORY;
 * CP_BAD_INPUT for a type that names an unknown model. */
CP_MUST_CHECK cp_status cp_crash_record_fill(const cp_impact *impact, const cp_impact_names *names,
                                             const cp_fleet *fleet, cp_crash_record_extent extent,
                                             cp_crash_row *row, cp_error *error);

/* Fill row, zeroed before, with what is known of the same crash: same vehicles and types, same
 * impact to the bit, same earlier crashes. Only who errs and the lanes are taken from names. Error:
 * CP_NO_MEMORY.
 */
CP_MUST_CHECK cp_status cp_crash_record_repeat(const cp_crash_row *known,
                                               const cp_impact_names *names, cp_crash_row *row,
                                               cp_error *error);

#endif
