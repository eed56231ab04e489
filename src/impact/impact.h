/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef IMPACT_IMPACT_H
#define IMPACT_IMPACT_H

#include "crash/crash_configuration.h"
#include "crash/validity.h"
#include "traffic/traffic.h"

/* Detection of vehicle-vehicle crashes in moving traffic. */

/* Why a contact of rectangles is not a crash. X(name, text).
 *
 * graze: from the state at first touch they do not go deep (confirmation.h).
 *
 * overlap_at_insertion: SUMO set one down on the other (insertion, teleport).
 *
 * lane_change_jump: SUMO moved one sideways onto the other within a step.
 *
 * impossible_motion: one slides sideways or turns as no vehicle can (cp_motion_is_impossible): SUMO
 * lays rectangles along every kink of a lane; and without that it would be no crash. (With it or
 * without, it is one: then it is confirmed, and that part of the motion left out of the state. A
 * car that brakes to rest in a lane change turns on the spot in SUMO.)
 *
 * clipped_waiting: one of them stands, less than half a width lies in the other's way, and no
 * driver error is at work on either: SUMO's junctions leave corners of waiting cars in the way.
 *
 * long_vehicle_turning: only the part of a vehicle longer than 9 m that is more than 6 m behind its
 * front is touched, while it turns, its rear is still in a junction, or its lane bends under it,
 * standing too; or a point farther from the middle of that lane than its half width: SUMO's rigid
 * rectangle is not where a bus's tail, a trailer or a tram would be.
 *
 * no_common_road: their roads cross or run side by side without meeting.
 *
 * other_level: one passes over the other. */
#define CP_CONTACT_VERDICTS(X)                                                                     \
    X(CP_CONTACT_CONFIRMED, "confirmed")                                                           \
    X(CP_CONTACT_GRAZE, "graze")                                                                   \
    X(CP_CONTACT_AT_INSERTION, "overlap_at_insertion")                                             \
    X(CP_CONTACT_LANE_CHANGE_JUMP, "lane_change_jump")                                             \
    X(CP_CONTACT_IMPOSSIBLE_MOTION, "impossible_motion")                                           \
    X(CP_CONTACT_CLIPPED_WAITING, "clipped_waiting")                                               \
    X(CP_CONTACT_ROADS_APART, "no_common_road")                                                    \
    X(CP_CONTACT_OTHER_LEVEL, "other_level")                                                       \
    X(CP_CONTACT_LONG_TURNING, "long_vehicle_turning")

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
 * (byte order). A pair in contact is reported once; when it has parted (0.1 m) its next touch is a
 * new contact, but a pair whose crash was confirmed is never reported again. The array is the
 * detector's, valid until the next call. Roles: a is a vehicle whose front is struck; if that
 * holds for both or neither, is_at_fault (may be NULL) decides, else the smaller id. */
CP_MUST_CHECK cp_status cp_detector_step(cp_detector *detector, const cp_traffic *traffic,
                                         bool (*is_at_fault)(void *context, uint32_t vehicle),
                                         void *context, const cp_impact **impacts, size_t *count,
                                         cp_error *error);

/* Role a becomes role b and the other way round. */
void cp_impact_swap_roles(cp_impact *impact);

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
