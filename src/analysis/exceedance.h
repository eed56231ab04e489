/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_EXCEEDANCE_H
#define ANALYSIS_EXCEEDANCE_H

#include "analysis/study_data.h"
#include "stats/rates.h"

/* How often crashes above a severity happen: frontal crashes of which a frontally struck vehicle
 * exceeds x, per million vehicle-km. It joins rate and severity and needs no conditioning on
 * crashing, so a treatment cannot change it by moving crashes in or out of what is looked at.
 *
 * A crash none of whose frontally struck vehicles was simulated is not counted as above, but is in
 * the bounds: they take every severity outside the surrogate's validated range for unknown. */

/* X(name, text, unit, of curves: largest x, step; headline x; all in SI, OLC in g). */
#define CP_EXCEEDED(X)                                                                             \
    X(CP_EXCEEDED_OLC, "olc", "g", 40.0, 1.0, 15.0)                                                \
    X(CP_EXCEEDED_DELTA_V, "delta_v", "m_s", 100.0 / 3.6, 2.5 / 3.6, 30.0 / 3.6)

typedef enum cp_exceeded {
#define CP_EXCEEDED_NAME(name, text, unit, largest, step, headline) name,
    CP_EXCEEDED(CP_EXCEEDED_NAME)
#undef CP_EXCEEDED_NAME
        CP_EXCEEDED_COUNT
} cp_exceeded;

extern const char *const CP_EXCEEDED_TEXT[CP_EXCEEDED_COUNT];
extern const double CP_EXCEEDED_HEADLINE[CP_EXCEEDED_COUNT];

#define CP_EXCEEDANCE_POINTS 41

/* One x of a variant. */
typedef struct cp_exceedance {
    double x;
    size_t crashes;       /* above x */
    size_t least;         /* of these with a vehicle inside validity above x */
    size_t most;          /* least, and every crash with a frontally struck vehicle outside */
    double rate;          /* crashes per 10^6 vehicle-km; NAN without exposure */
    cp_interval interval; /* of the rate, 95 %, for this x alone; widened by dispersion */
} cp_exceedance;

/* One x, treatment over baseline. */
typedef struct cp_exceedance_ratio {
    double x;
    size_t crashes[2]; /* above x, of baseline and treatment, in the replications compared */
    double ratio;      /* Mantel and Haenszel's, over scenarios; NAN without any of the baseline */
    cp_interval interval;
    double bound[2]; /* of the ratio, lower and upper, with every severity outside unknown; upper
                        +INFINITY, both NAN when nothing is known */
    cp_interval bound_interval[2]; /* 95 %, of each of the two: together they reach from the lower
                                      end of the first to the upper of the second */
} cp_exceedance_ratio;

#endif
