/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_GALLERY_H
#define REPORT_GALLERY_H

#include "report/study_data.h"

/* Single crashes, simulated again from the database, and what the pulses of many have in common. */

/* The gallery: of every variant the frontally struck vehicle with the highest OLC, and the one in
 * the middle, both inside validity where there are such; at most CP_GALLERY_MAX crashes. An array
 * of {"variant", "scenario", "crash_id", "why", "match", "run"}: run as in animations, crash_id as
 * text (a script has no 64-bit numbers), match says whether the pulses are the stored ones. A crash
 * that cannot be simulated again is listed with "failed": why. Errors: those of the store,
 * CP_NO_MEMORY. */
#define CP_GALLERY_MAX 8
CP_MUST_CHECK cp_status cp_gallery_json(cp_store *store, const cp_study_data *data,
                                        json_t **gallery, cp_error *error);

/* Decelerations over time, CFC60, of up to CP_CORRIDOR_PULSES_MAX sampled frontally struck vehicles
 * of each variant, treated crashes included; read once, used for every slice. */
#define CP_CORRIDOR_PULSES_MAX 400
#define CP_CORRIDOR_INTERVAL_S 0.002
#define CP_CORRIDOR_POINTS 76 /* 0 ... 150 ms */

typedef struct cp_corridor_pulses {
    size_t count;
    size_t *vehicle;                /* of the study, ascending; treated ones behind all others */
    float (*g)[CP_CORRIDOR_POINTS]; /* deceleration along x, NAN behind its end */
} cp_corridor_pulses;

/* Same database, same sample: the study's seed decides. The caller destroys. */
CP_MUST_CHECK cp_status cp_corridor_read(cp_store *store, const cp_study_data *data,
                                         cp_corridor_pulses *pulses, cp_error *error);
void cp_corridor_destroy(cp_corridor_pulses *pulses);

/* {"n", "p10": […], "p50": […], "p90": […]} over the pulses for which chosen[vehicle] holds,
 * an array over the study's vehicles and then its treated ones. */
json_t *cp_corridor_json(const cp_corridor_pulses *pulses, const unsigned char *chosen);

#endif
