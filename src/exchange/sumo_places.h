/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_SUMO_PLACES_H
#define EXCHANGE_SUMO_PLACES_H

#include "exchange/sumo_fcd.h"

/* Ways of colliding vehicles out of the collision output itself: from 1.24 on SUMO writes where
 * both were at every report. */

/* A record of nothing but the reports: one sample of both vehicles a report, no exposure. The step
 * is the smallest time between two reports of a pair, CP_PLACES_STEP_S where every pair has one
 * only. The caller destroys. Errors: CP_BAD_INPUT with file and line of a report without places, or
 * of a vehicle without a type; CP_NO_MEMORY. After an error the record is destroyed already. */
#define CP_PLACES_STEP_S 0.1
CP_MUST_CHECK cp_status cp_sumo_places_record(const char *path, const cp_collision_list *list,
                                              cp_fcd_record *record, cp_error *error);

/* Into a record read from --fcd-output: where SUMO says the two were at a report takes the place of
 * what the record has of that step, in which SUMO may have put them elsewhere already.
 * Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_sumo_places_add(const cp_collision_list *list, cp_fcd_record *record,
                                           cp_error *error);

#endif
