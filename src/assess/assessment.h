/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ASSESS_ASSESSMENT_H
#define ASSESS_ASSESSMENT_H

#include "assess/listed.h"
#include "exchange/configurations_csv.h"
#include "exchange/sumo_fcd.h"
#include "exchange/sumo_types.h"
#include "run/fleet.h"
#include "store/result_rows.h"

/* Ready collisions, of a SUMO run or of a list of configurations, assessed from their files. */

/* What to assess; all borrowed, and longer-lived than the assessment. */
typedef struct cp_assessment_request {
    const char *collisions_path;    /* SUMO's --collision-output; NULL: of configurations */
    const char *fcd_path;           /* its --fcd-output; NULL: the places in the collisions */
    const char *const *routes_path; /* files with vTypes */
    size_t routes_count;
    const char *configurations_path; /* NULL: of collisions */
    const char *vehicle;             /* what types not named crash as; NULL: by class and size */
    const char *const *type;         /* "TYPE=VEHICLE" each */
    size_t type_count;
    const char *db_path; /* new database; NULL: none, and no pulses are kept */
    const char *name;    /* of the study in it */
    bool strict;         /* the first bad row is an error (listed.h) */
} cp_assessment_request;

/* All of one assessment. */
typedef struct cp_assessment {
    cp_assessment_request request;
    cp_collision_list collisions;
    cp_fcd_record record;
    cp_vtypes types;
    cp_configuration_list configurations;
    cp_study study; /* names the vehicle files */
    cp_fleet fleet;
    cp_result_rows results;
    cp_assessment_count count;
} cp_assessment;

/* Read the files, find the vehicle models and simulate every crash. The caller destroys, also after
 * an error. Errors: CP_BAD_INPUT with file, line and field; those of listed.h. */
CP_MUST_CHECK cp_status cp_assessment_make(const cp_assessment_request *request,
                                           cp_assessment *assessment, cp_error *error);
void cp_assessment_destroy(cp_assessment *assessment);

#endif
