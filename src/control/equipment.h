/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_EQUIPMENT_H
#define CONTROL_EQUIPMENT_H

#include "core/rng.h"
#include "traffic/traffic.h"

/* Which cars have a function. One number in [0, 1) is drawn for each vehicle, from study seed,
 * replication seed and vehicle id alone; a car has every function whose penetration lies above its
 * number. So the same cars are equipped in all variants of a replication, who has a function at 30
 * % has it at 50 %, and of two functions the rarer is found in cars that have the other too. */

/* Penetration among the vehicles of one SUMO vehicle type. */
typedef struct cp_equipment_share {
    char *type;
    double penetration_1; /* 0 ... 1 */
} cp_equipment_share;

/* Zero-initialise, fill the first part, destroy. */
typedef struct cp_equipment {
    cp_rng_key key;                   /* of study and replication */
    double penetration_1;             /* of every type not listed */
    const cp_equipment_share *shares; /* borrowed */
    size_t share_count;
    const char *const *only; /* ids of the only vehicles that may have it; NULL: all. Borrowed */
    size_t only_count;

    unsigned char *known; /* by vehicle number: 0 not asked yet, 1 without, 2 equipped */
    size_t numbers;
    size_t equipped; /* vehicles asked about and found equipped */
} cp_equipment;

/* Whether a vehicle on the road has it. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_equipment_has(cp_equipment *equipment, const cp_traffic *traffic,
                                         uint32_t vehicle, bool *has, cp_error *error);
/* Visit every car on the road that has it, in the order of the motions; ends with the first error.
 */
typedef cp_status (*cp_equipped_visit)(void *state, const void *context,
                                       const cp_vehicle_motion *motion, cp_error *error);
CP_MUST_CHECK cp_status cp_equipment_each(cp_equipment *equipment, const cp_traffic *traffic,
                                          cp_equipped_visit visit, void *state, const void *context,
                                          cp_error *error);
/* Whether anybody can have it at all. */
bool cp_equipment_is_any(const cp_equipment *equipment);
void cp_equipment_destroy(cp_equipment *equipment);

#endif
