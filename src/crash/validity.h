/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_VALIDITY_H
#define CRASH_VALIDITY_H

#include "crash/crash_configuration.h"
#include "crash/validity_reason.h"

#include <stdbool.h>
#include <stddef.h>

#define CP_VALIDITY_TEXT_SIZE 128

/* What speaks for the severity of a vehicle inside. */
typedef struct cp_validity_ground {
    const char *evidence_class; /* static text; NULL: outside */
    double error_1;             /* relative error of severity there; NAN: not known */
} cp_validity_ground;

/* Validity of vehicle role (0 or 1). A model that the scorecard judges is inside where a class of
 * tests speaks for the crash (crash/evidence.h); one that it does not judge, within its own
 * calibrated range: speed by v_eq = closing * m_other / (m_own + m_other) (the barrier has infinite
 * mass), offset and angle, oblique velocity up to 15 degrees (an assumption, stated as one), struck
 * on its front against a front. model: judged and no class kept, or never calibrated. contact_side:
 * struck elsewhere than on its front. opponent_structure: what the other is struck on is not spoken
 * for, as of any vehicle over 3.5 t. size: the model's outline was stretched. Offset of role 1 is
 * that seen from it. no_contact, moved (below), no_model and damaged (one of the two had crashed
 * before) are the caller's to add: the configuration does not tell. ground may be NULL. */
unsigned cp_validity(const cp_vehicle_model *model_a, const cp_vehicle_model *model_b,
                     const cp_crash_configuration *configuration,
                     const cp_crash_description *description, int role, cp_validity_ground *ground);

#define CP_HEAVY_FROM_KG 3500.0

/* Where rectangles of traffic touch, models have round corners: they are moved along their relative
 * velocity until they touch too. More than that far is told as moved: then they meet elsewhere than
 * the rectangles did. Where they pass each other it is no_contact, and there is no severity. */
#define CP_MOVED_LARGEST_M 0.5
#define CP_NO_CONTACT_TEXT "the outlines of the two vehicle models do not meet"

/* What the surrogate adds for both vehicles, the same wherever a crash is simulated: touched and
 * shift_m of cp_crash_result. */
unsigned cp_validity_of_meeting(bool touched, double shift_m);

/* "inside" or the list of what is outside, "speed,angle". Returns text. */
const char *cp_validity_text(unsigned outside, char text[CP_VALIDITY_TEXT_SIZE]);

#endif
