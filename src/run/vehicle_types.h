/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_VEHICLE_TYPES_H
#define RUN_VEHICLE_TYPES_H

#include "store/result_rows.h"

/* What the vehicle types of a replication crashed as, added to rows->crash_options (JSON):
 * "covers_outline": 1 and "vehicle_types": {SUMO type: {"model": name, or names of a type whose
 * cars are drawn ("compact_car,mid_size_car"), or null, "chosen_by": rule of run/fleet.h or
 * run/fleet_car.h or null, "reason": why there is none, or null}}, of the types that had crashes.
 * Warns once of every type without a model. Errors: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_vehicle_types_add(cp_result_rows *rows, cp_error *error);

#endif
