/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_SUMO_COLLISIONS_H
#define EXCHANGE_SUMO_COLLISIONS_H

#include "core/error.h"
#include "core/geometry.h"

#include <stddef.h>

/* The collisions of a finished SUMO run: what --collision-output wrote. */

/* Where the two were at one report: colliderFront, colliderBack and the same of the victim, which
 * SUMO writes from 1.24 on. Indices as in the collision's id, whichever SUMO called collider. */
typedef struct cp_collision_places {
    double time_s;
    cp_vec2 front_m[2]; /* middle of the front bumper */
    cp_vec2 back_m[2];  /* middle of the rear one */
    double speed_m_s[2];
} cp_collision_places;

typedef struct cp_listed_collision {
    size_t line;   /* of the file */
    double time_s; /* end of the step of the first report */
    double last_s; /* and of the last one: what SUMO reports early by its minGap may touch later */
    char *id[2];   /* collider, victim; owned, as the next two */
    char *type[2]; /* NULL where the file does not tell (before colliderType, victimType) */
    char *kind;    /* SUMO's word: collision, frontal, junction */
    double speed_m_s[2];         /* at the first report; NAN where the file does not tell */
    cp_collision_places *places; /* owned, in order of time; of the reports that have them */
    size_t places_count;
} cp_listed_collision;

typedef struct cp_collision_list {
    cp_listed_collision *collision; /* in order of first report */
    size_t count;
    size_t reports;         /* in the file: SUMO repeats a collision that lasts */
    size_t without_places;  /* of them; 0: ways can be told without a record of all vehicles */
    double step_s;          /* least time between two reports: SUMO's step where a collision lasts;
                               INFINITY where all are of one time */
    size_t with_themselves; /* rows whose collider is the victim (trains in a loop): passed over */
} cp_collision_list;

/* Every pair of vehicles once, at its first report. Collisions with persons are left out and not
 * counted. Of the four places of a row there must be all or none; a third coordinate is height and
 * not kept. The caller destroys. Errors: CP_BAD_INPUT with file, line, attribute; CP_NO_MEMORY.
 * After an error the list is destroyed already. */
CP_MUST_CHECK cp_status cp_sumo_collisions_read(const char *path, cp_collision_list *list,
                                                cp_error *error);
void cp_collision_list_destroy(cp_collision_list *list);

#endif
