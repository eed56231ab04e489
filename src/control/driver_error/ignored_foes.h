/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_DRIVER_ERROR_IGNORED_FOES_H
#define CONTROL_DRIVER_ERROR_IGNORED_FOES_H

#include "traffic/traffic.h"

/* Who pays no heed to whom at junctions, for whatever reason. Several driver errors may have a
 * driver ignore another at the same time; SUMO takes one list a driver (junctionModel.ignoreIDs).
 */
typedef struct cp_ignored_foes cp_ignored_foes;

typedef enum cp_ignore_reason {
    CP_IGNORE_UNSEEN = 1,    /* looked but failed to see */
    CP_IGNORE_MISJUDGED = 2, /* takes a gap for larger than it is */
    CP_IGNORE_RED = 4,       /* runs a red light, or has green and does not expect who does */
} cp_ignore_reason;

CP_MUST_CHECK cp_status cp_ignored_foes_create(cp_ignored_foes **ignored, cp_error *error);
void cp_ignored_foes_destroy(cp_ignored_foes *ignored); /* NULL is fine */

/* A reason for ego to ignore foe comes up, or ends; all end when one of the two has gone or
 * teleports. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_ignored_foes_add(cp_ignored_foes *ignored, uint32_t ego, uint32_t foe,
                                            cp_ignore_reason reason, cp_error *error);
void cp_ignored_foes_take_back(cp_ignored_foes *ignored, uint32_t ego, uint32_t foe,
                               cp_ignore_reason reason);

/* Nobody ignores foe for that reason any more. */
void cp_ignored_foes_heed(cp_ignored_foes *ignored, uint32_t foe, cp_ignore_reason reason);

/* Tell SUMO what has changed, for the coming step, and forget who has gone. */
CP_MUST_CHECK cp_status cp_ignored_foes_send(cp_ignored_foes *ignored, const cp_traffic *traffic,
                                             cp_error *error);

/* Call visit for every foe that ego ignores for that reason. */
void cp_ignored_foes_visit(const cp_ignored_foes *ignored, uint32_t ego, cp_ignore_reason reason,
                           void (*visit)(void *context, uint32_t foe), void *context);

#endif
