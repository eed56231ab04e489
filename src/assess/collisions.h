/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ASSESS_COLLISIONS_H
#define ASSESS_COLLISIONS_H

#include "assess/listed.h"
#include "exchange/sumo_fcd.h"
#include "exchange/sumo_types.h"
#include "run/fleet.h"

/* The collisions of a SUMO run through the path that those of a study take: poses, contact
 * configuration, surrogate with both vehicle models, severities. One of whose vehicles is not in
 * the record is a bad row (listed.h). Ways are taken out of the record as they are assessed.
 * results, zeroed before, gets crashes in order of time and ids, contacts, SUMO's collisions and
 * the exposure of the record; the caller destroys it. A type that is not among types is as large as
 * the model that the fleet maps it to, else SUMO's own car. Tells by log what is no crash. Between
 * cp_crash_library_begin and _end. Errors: CP_BAD_INPUT when not one of the vehicles is in the
 * record; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_assess_collisions(const cp_collision_list *list, const char *list_path,
                                             cp_fcd_record *record, const cp_vtypes *types,
                                             const cp_fleet *fleet, cp_assessment_keep keep,
                                             bool strict, cp_result_rows *results,
                                             cp_assessment_count *count, cp_error *error);

#endif
