/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_CRASH_RECORD_H
#define RUN_CRASH_RECORD_H

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
} cp_impact_names;

/* Fill row, zeroed before; what it owns is freed by cp_result_rows_destroy. A crash the surrogate
 * cannot simulate, or with a vehicle that has no model, is kept, with OLC status simulation_failed,
 * and logged. Models cover SUMO's rectangles (cp_vehicle_model_cover). Errors: CP_NO_MEMORY;
 * CP_BAD_INPUT for a type that names an unknown model. */
CP_MUST_CHECK cp_status cp_crash_record_fill(const cp_impact *impact, const cp_impact_names *names,
                                             const cp_fleet *fleet, cp_crash_row *row,
                                             cp_error *error);

#endif
