/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_CROSS_CHECK_H
#define RUN_CROSS_CHECK_H

#include "core/error.h"
#include "run/found_as.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* SUMO's own collisions against our contacts, pair by pair. SUMO repeats a collision every step as
 * long as it lasts, may name the two in either order, and may be earlier or later than we are: so
 * both are collected during the run and matched at its end. */

typedef struct cp_cross_check_pair {
    uint32_t low, high;        /* vehicle numbers in order */
    double time_s;             /* ours: first touch; SUMO's: first report */
    cp_found_as found_as;      /* ours: what became of the contact; SUMO's: once matched */
    uint32_t collider, victim; /* SUMO's only: as first reported */
    char *type;
    double
        gap_m; /* SUMO's only: smallest separation of our rectangles at its reports; < 0 overlap */
} cp_cross_check_pair;

/* Zero-initialise, add, match once, destroy. */
typedef struct cp_cross_check {
    cp_cross_check_pair *ours;
    size_t our_count;
    cp_cross_check_pair *sumo; /* in order of first report */
    size_t sumo_count;
} cp_cross_check;

/* One of our contacts and what became of it. A pair may have several. */
CP_MUST_CHECK cp_status cp_cross_check_add_contact(cp_cross_check *check, uint32_t vehicle_1,
                                                   uint32_t vehicle_2, cp_found_as found_as,
                                                   double time_s, cp_error *error);
/* One report of SUMO; repetitions are fine. gap_m: separation of the two rectangles at that moment,
 * INFINITY when one of them is not on the road. */
CP_MUST_CHECK cp_status cp_cross_check_add_report(cp_cross_check *check, uint32_t collider,
                                                  uint32_t victim, const char *type, double time_s,
                                                  double gap_m, cp_error *error);
/* Set found_as of all of SUMO's pairs: our contact of the same pair (the crash if there is one,
 * else the contact nearest in time), else CP_FOUND_NO_CONTACT. */
void cp_cross_check_match(cp_cross_check *check);
void cp_cross_check_destroy(cp_cross_check *check);

#endif
