/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_SUMO_COLLISIONS_H
#define EXCHANGE_SUMO_COLLISIONS_H

#include "core/error.h"

#include <stddef.h>

/* The collisions of a finished SUMO run: what --collision-output wrote. */

typedef struct cp_listed_collision {
    size_t line;   /* of the file */
    double time_s; /* end of the step of the first report */
    double last_s; /* and of the last one: what SUMO reports early by its minGap may touch later */
    char *id[2];   /* collider, victim; owned, as the next two */
    char *type[2];
    char *kind; /* SUMO's word: collision, frontal, junction */
} cp_listed_collision;

typedef struct cp_collision_list {
    cp_listed_collision *collision; /* in order of first report */
    size_t count;
    size_t reports;         /* in the file: SUMO repeats a collision that lasts */
    size_t with_themselves; /* rows whose collider is the victim (trains in a loop): passed over */
} cp_collision_list;

/* Every pair of vehicles once, at its first report. Collisions with persons are left out and not
 * counted. The caller destroys. Errors: CP_BAD_INPUT with file, line, attribute; CP_NO_MEMORY.
 * After an error the list is destroyed already. */
CP_MUST_CHECK cp_status cp_sumo_collisions_read(const char *path, cp_collision_list *list,
                                                cp_error *error);
void cp_collision_list_destroy(cp_collision_list *list);

#endif
