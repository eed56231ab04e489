/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_CORRIDOR_H
#define ANALYSIS_CORRIDOR_H

#include "analysis/study_data.h"

/* What the pulses of many vehicles have in common. */

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

/* Parts of the chosen pulses at every CP_CORRIDOR_INTERVAL_S from first contact, in g, rounded to
 * hundredths. */
typedef struct cp_corridor {
    size_t pulses; /* chosen */
    size_t points; /* up to where three of them last; 0 of fewer pulses */
    double p10_g[CP_CORRIDOR_POINTS];
    double p50_g[CP_CORRIDOR_POINTS];
    double p90_g[CP_CORRIDOR_POINTS];
} cp_corridor;

/* Over the pulses for which chosen[vehicle] holds, an array over the study's vehicles and then its
 * treated ones. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_corridor_of(const cp_corridor_pulses *pulses,
                                       const unsigned char *chosen, cp_corridor *corridor,
                                       cp_error *error);

#endif
