/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_FIELD_FIGURES_H
#define ANALYSIS_FIELD_FIGURES_H

#include "analysis/field_study.h"
#include "analysis/figures.h"
#include "stats/raked.h"
#include "stats/weighted.h"

/* What a comparison is asked of a field, and its figures (field_comparison.h). */

typedef struct cp_field_request {
    const cp_field_table *table;        /* borrowed */
    const cp_field_study *study;        /* borrowed, of the same study data */
    bool margin[CP_FIELD_MARGIN_COUNT]; /* which are raked */
    bool exact; /* treatments are compared with exactly these, delta-v or not */
    double cap; /* largest weight over the mean, > 1; INFINITY: none */
} cp_field_request;

#define CP_FIELD_CAP 5.0

/* One class of a margin: shares where the class is known, NAN without any. */
typedef struct cp_field_class {
    double field_1;
    double field_se_1; /* NAN without a sample's design */
    double study_1;
    double weighted_1;
    size_t vehicles; /* of the study */
} cp_field_class;

/* How one number is distributed. */
typedef struct cp_field_number {
    size_t known;                     /* vehicles of the study */
    double median[3];                 /* field, study, study weighted; NAN without any */
    cp_weighted_distance distance[2]; /* of the study from the field, unweighted and weighted */
} cp_field_number;

/* A variant's frontally struck vehicles beside the field's. */
typedef struct cp_field_shape {
    size_t vehicles;
    cp_field_class of[CP_FIELD_MARGIN_COUNT][CP_FIELD_CLASSES_MAX];
    double type_distance_1[2]; /* half the sum of differences of the shares, unweighted, weighted */
    cp_field_number number[CP_FIELD_VALUE_COUNT];
    double
        never_made_1; /* field's share in combinations of all classes that the study has none of */
    double never_seen_1; /* the other way round */
    double effective;    /* Kish's number of vehicles */
    double largest_weight;
    size_t capped; /* vehicles at the cap */
} cp_field_shape;

/* Events of the weighted figures. */
enum { CP_FIELD_CRASH, CP_FIELD_ABOVE, CP_FIELD_INJURED = CP_FIELD_ABOVE + CP_EXCEEDED_COUNT };

/* Of a variant; [0]: unweighted, [1]: weighted, of the baseline only. Rates per 10^6 veh-km;
 * delta-v above x is without rebound. Intervals of injuries carry what is uncertain of the risk
 * function. */
typedef struct cp_field_variant {
    bool weighted;
    cp_field_shape shape;
    cp_raked_arm_figures figures[2];
    double above[CP_EXCEEDED_COUNT];
    double gap_1;      /* largest difference from a margin of the field that is left */
    const char *field; /* its name, borrowed */
} cp_field_variant;

/* Of a treatment against the baseline; in the counterfactual design of its valid pairs, whose
 * medians are not given. */
enum { CP_FIELD_PLAIN, CP_FIELD_WEIGHTED, CP_FIELD_DELTA_V_TOO, CP_FIELD_WAYS };

typedef struct cp_field_contrast {
    cp_raked_figures figures[CP_FIELD_WAYS];
    bool delta_v_too; /* the last way is there: delta-v raked too, where it is not as a rule */
    double above[CP_EXCEEDED_COUNT];
    size_t unlike; /* treated vehicles of a class the baseline has none of */
} cp_field_contrast;

#endif
