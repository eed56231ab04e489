/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_CONVERGENCE_H
#define ANALYSIS_CONVERGENCE_H

#include "analysis/figures.h"

/* Whether a study has run long enough: its headline figure over the first replications, then over
 * more and more of them, in the order of their numbers, as many of every scenario. */

/* The headline: X(name, text). Paired or independent seeds: the rate ratio of each treatment;
 * counterfactual: the share of the valid pairs that were avoided; baseline alone: its rate of
 * frontal crashes per 10^6 vehicle-km. */
#define CP_CONVERGING(X)                                                                           \
    X(CP_CONVERGING_RATE, "rate")                                                                  \
    X(CP_CONVERGING_RATE_RATIO, "rate_ratio")                                                      \
    X(CP_CONVERGING_AVOIDED, "avoided")

typedef enum cp_converging {
#define CP_CONVERGING_NAME(name, text) name,
    CP_CONVERGING(CP_CONVERGING_NAME)
#undef CP_CONVERGING_NAME
} cp_converging;

extern const char *const CP_CONVERGING_TEXT[];

/* One interval by counts of crashes, widened by what replications scatter, at every point, so that
 * the points can be compared with each other. */
typedef struct cp_convergence_point {
    size_t replications;  /* of the treatment; paired: seeds; counterfactual: of the baseline */
    double value;         /* NAN when there is none yet */
    cp_interval interval; /* 95 % */
} cp_convergence_point;

#define CP_CONVERGENCE_POINTS_MAX                                                                  \
    100 /* of more replications, evenly thinned; the last one stays                                \
         */

typedef struct cp_convergence_series {
    size_t variant;
    size_t count;
    cp_convergence_point point[CP_CONVERGENCE_POINTS_MAX];
} cp_convergence_series;

typedef struct cp_convergence {
    cp_converging what;
    size_t count;
    cp_convergence_series *series;
} cp_convergence;

/* The caller destroys, also after an error. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_convergence_create(const cp_study_data *data, size_t baseline,
                                              cp_slice slice, cp_convergence *convergence,
                                              cp_error *error);
void cp_convergence_destroy(cp_convergence *convergence);

#endif
