/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef IMPACT_APPROACH_H
#define IMPACT_APPROACH_H

#include "impact/footprint.h"

/* When two moving rectangles come within a given separation of each other. */

/* Two rectangles over the time 0 .. duration_s. rate_m_s bounds how fast their separation can
 * change; the search never skips an approach that is deeper than half a millimetre. */
typedef struct cp_approach {
    void (*rectangles_at)(const void *context, double time_s, cp_rectangle rectangle[2]);
    const void *context;
    double duration_s;
    double rate_m_s;
} cp_approach;

/* First time at which the separation (core/geometry.h; negative: depth of overlap) is at most
 * level_m, to rounding; 0 when it is so from the beginning. False when it never is. */
bool cp_approach_reaches(const cp_approach *approach, double level_m, double *time_s);

/* Bound of the rate of separation of two rectangles: their reference points (any point of each
 * body) move relative to each other at most at relative_speed_m_s, they turn at most at the rates
 * given, and lie gap_m apart (centre to centre) at the beginning of duration_s. */
double cp_approach_rate(const cp_rectangle rectangle[2], double relative_speed_m_s,
                        const double yaw_rate_rad_s[2], double duration_s);

/* First touch of two vehicles inside a step, as a fraction of it in [0, 1]; 0 when they overlap
 * from the beginning. False when they do not touch. Neither motion is a jump. */
bool cp_first_contact(const cp_vehicle_motion *one, const cp_vehicle_motion *other,
                      double step_length_s, double *fraction);

#endif
