/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_EVIDENCE_H
#define CRASH_EVIDENCE_H

#include "crash/crash_configuration.h"

#include <stdbool.h>
#include <stddef.h>

/* Which crashes the tests speak for (db/validation/evidence.csv, made by db/validation/evidence.py
 * from the scorecard): for each vehicle file that the scorecard judges, classes of crashes around
 * tested cases, whether the vehicle keeps all bars of the tests that a class stands on, and the
 * error there. */
typedef struct cp_evidence {
    const char *name;         /* of the class, static text */
    const char *vehicle;      /* vehicle model */
    const char *vehicle_hash; /* SHA-256 of the file that was judged */
    const char *opponent;  /* struck side of the other: "front" (a barrier too), "side", "rear" */
    double speed_min_km_h; /* v_eq = closing speed m_other / (m_own + m_other); a barrier's mass is
                              infinite */
    double speed_max_km_h; /* from and to belong to the range, as of the next */
    double overlap_min_1;  /* share of the own width */
    double overlap_max_1;
    double angle_max_deg;          /* of the headings, either way */
    double velocity_angle_max_deg; /* of the relative velocity to the own x axis */
    bool kept;                     /* all bars of the class's tests */
    double error_1;                /* relative error of severity along x */
} cp_evidence;

/* Name of the class of a vehicle file that the scorecard does not judge, within its calibrated
 * range. */
#define CP_EVIDENCE_OWN "own_calibration"

size_t cp_evidence_count(void);
const cp_evidence *cp_evidence_at(size_t index);

/* Whether the scorecard judges this model: a row has its name and the hash of its file. */
bool cp_evidence_judges(const cp_vehicle_model *model);

/* What a crash is to a class. */
typedef struct cp_evidence_case {
    const char *opponent;
    double speed_km_h;
    double overlap_1; /* NAN: not known, then it is not looked at */
    double angle_deg;
    double velocity_angle_deg;
} cp_evidence_case;

/* The crash of vehicle role (0 or 1) as a case. */
cp_evidence_case cp_evidence_case_of(const cp_vehicle_model *model_a,
                                     const cp_vehicle_model *model_b,
                                     const cp_crash_configuration *configuration,
                                     const cp_crash_description *description, int role);

/* The first class kept by the model that holds the case; NULL: none. Then *outside are the validity
 * reasons (crash/validity_reason.h) by which the case misses the class that it misses by fewest of
 * speed, offset (overlap), angle, oblique_velocity; opponent_structure besides where no class kept
 * has that opponent, model where none is kept at all. *outside is 0 with a class. */
const cp_evidence *cp_evidence_find(const cp_vehicle_model *model, const cp_evidence_case *crash,
                                    unsigned *outside);

#endif
