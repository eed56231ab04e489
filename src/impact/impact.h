/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef IMPACT_IMPACT_H
#define IMPACT_IMPACT_H

#include "crash/crash_configuration.h"
#include "crash/validity.h"
#include "traffic/traffic.h"

/* Detection of vehicle-vehicle crashes in moving traffic. */

/* Why a contact of rectangles is not a crash. X(name, text). */
#define CP_CONTACT_VERDICTS(X)                                                                     \
    X(CP_CONTACT_CONFIRMED, "confirmed")                                                           \
    X(CP_CONTACT_GRAZE, "graze")                                                                   \
    X(CP_CONTACT_AT_INSERTION, "overlap_at_insertion")                                             \
    X(CP_CONTACT_DIFFERENT_LEVEL, "no_common_road")

typedef enum cp_contact_verdict {
#define CP_CONTACT_VERDICT_NAME(name, text) name,
    CP_CONTACT_VERDICTS(CP_CONTACT_VERDICT_NAME)
#undef CP_CONTACT_VERDICT_NAME
        CP_CONTACT_VERDICT_COUNT
} cp_contact_verdict;

const char *cp_contact_verdict_text(cp_contact_verdict verdict);

/* First contact of one pair. Index 0 is role a, 1 is role b. */
typedef struct cp_impact {
    uint32_t vehicle[2];
    cp_vehicle_state state[2]; /* at first contact */
    double yaw_rate_rad_s[2];
    cp_vec2 front_velocity_m_s[2]; /* of the front bumper's middle, world; with lateral motion */
    double time_s;                 /* SUMO clock of first contact, inside the step */
    cp_vec2 contact_m;             /* first contact point, world */
    cp_contact_side side[2];
    cp_contact_verdict verdict;
} cp_impact;

typedef struct cp_detector cp_detector;

CP_MUST_CHECK cp_status cp_detector_create(cp_detector **detector, cp_error *error);
void cp_detector_destroy(cp_detector *detector);

/* Contacts that began in the step just made, ordered by time, then by the ids of the vehicles
 * (byte order). Each pair is reported once, while it stays in contact and ever after. The array is
 * the detector's, valid until the next call. Roles: a is a vehicle whose front is struck; if that
 * holds for both or neither, is_at_fault (may be NULL) decides, else the smaller id. */
CP_MUST_CHECK cp_status cp_detector_step(cp_detector *detector, const cp_traffic *traffic,
                                         bool (*is_at_fault)(void *context, uint32_t vehicle),
                                         void *context, const cp_impact **impacts, size_t *count,
                                         cp_error *error);

/* The configuration the surrogate starts from, in the world frame, cars as their models say
 * (centre of gravity cg_to_front behind the front bumper; its velocity is the front bumper's, along
 * the chord of the step, less the yaw rate's lever). */
cp_crash_configuration cp_impact_configuration(const cp_impact *impact,
                                               const cp_vehicle_model *model_a,
                                               const cp_vehicle_model *model_b);

/* Speeds, offset, angle, overlap of the SUMO rectangles at first contact (docs: conventions). */
cp_crash_description cp_impact_describe(const cp_impact *impact, const cp_vehicle_model *model_a,
                                        const cp_vehicle_model *model_b);

#endif
