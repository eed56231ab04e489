/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_ASSESSMENT_H
#define CLI_ASSESSMENT_H

#include "exchange/configurations_csv.h"
#include "exchange/sumo_fcd.h"
#include "exchange/sumo_types.h"
#include "run/fleet.h"
#include "store/result_rows.h"

/* Ready collisions through the path that collisions of a study take: poses, contact configuration,
 * surrogate with both vehicle models, severities. */

/* What of a list became no crash, and how the others were found. */
typedef struct cp_assessment_count {
    size_t listed;
    size_t crashes;
    size_t carried;    /* crashes found beyond the end of the record */
    size_t no_contact; /* the two never touched */
    size_t unknown;    /* SUMO took them away in the step in which they collided */
    size_t bad;        /* could not be assessed: named by log, and left out */
    size_t filtered;   /* touched, and no crash: see the verdict of the contact */
} cp_assessment_count;

/* Leave pulses out of the results, which then take some 2 kB a crash in place of 8: for those that
 * print only. */
typedef enum cp_assessment_keep { CP_KEEP_PULSES, CP_KEEP_NO_PULSES } cp_assessment_keep;

/* In both: a row that cannot be assessed is named by log and counted, the others go on; strict: it
 * is the error CP_BAD_INPUT, as it is when there is no other row.
 *
 * The collisions of a SUMO run; one of whose vehicles is not in the record is a bad row. Ways are
 * taken out of the record as they are assessed. results, zeroed before, gets crashes in order of
 * time and ids, contacts, SUMO's collisions and the exposure of the record; the caller destroys it.
 * A type that is not among types is as large as the model that the fleet maps it to, else SUMO's
 * own car. Tells by log what is no crash. Between cp_crash_library_begin and _end. Errors:
 * CP_BAD_INPUT when not one of the vehicles is in the record; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_assess_collisions(const cp_collision_list *list, const char *list_path,
                                             cp_fcd_record *record, const cp_vtypes *types,
                                             const cp_fleet *fleet, cp_assessment_keep keep,
                                             bool strict, cp_result_rows *results,
                                             cp_assessment_count *count, cp_error *error);

/* A list of configurations, in its order; no exposure. A row's vehicle files are the fleet's types
 * of that name. Two that miss each other or begin inside each other are a bad row. */
CP_MUST_CHECK cp_status cp_assess_configurations(const cp_configuration_list *list,
                                                 const char *list_path, const cp_fleet *fleet,
                                                 cp_assessment_keep keep, bool strict,
                                                 cp_result_rows *results,
                                                 cp_assessment_count *count, cp_error *error);

#endif
