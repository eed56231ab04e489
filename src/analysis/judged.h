/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_JUDGED_H
#define ANALYSIS_JUDGED_H

#include "analysis/figures.h"

/* Severity of the same crashes with and without treatment (counterfactual design), for figures that
 * draw all variants together: the baseline's frontal crashes that were judged with every treatment,
 * each with the larger severity of its frontally struck vehicles. An avoided crash counts as below
 * every value, so nothing is conditional on crashing. New crashes between others are not in it. */

typedef struct cp_judged_variant {
    size_t variant;
    size_t avoided;                      /* of the crashes */
    cp_sample sample[CP_EXCEEDED_COUNT]; /* of OLC in g, of delta-v in m/s; one value a crash,
                                            -INFINITY when avoided or left-censored; clusters are
                                            the baseline's replications */
    cp_band band[CP_EXCEEDED_COUNT];     /* of their distribution functions */
    cp_exceedance curve[CP_EXCEEDED_COUNT][CP_EXCEEDANCE_POINTS]; /* per vehicle-km of the baseline;
                                                                     least and most as crashes */
} cp_judged_variant;

typedef struct cp_judged {
    size_t crashes;  /* judged with every treatment */
    size_t left_out; /* frontal crashes of the baseline that were not: an invalid pair, or a crash
                        with or without treatment that has no severity of a struck front */
    size_t variant_count;       /* 0 when the study has no pairs */
    cp_judged_variant *variant; /* the baseline, then every treatment with pairs in the slice */
} cp_judged;

/* scope: CP_SCOPE_INSIDE takes crashes that had both vehicles inside validity with the baseline,
 * which is known before any treatment. The caller destroys, also after an error. Error:
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_judged_create(const cp_study_data *data, size_t baseline, cp_slice slice,
                                         int scope, const cp_comparison_options *options,
                                         cp_judged *judged, cp_error *error);
void cp_judged_destroy(cp_judged *judged);

/* Of a variant; NULL when it is not among them. */
const cp_judged_variant *cp_judged_find(const cp_judged *judged, size_t variant);

#endif
