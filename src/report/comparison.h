/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_COMPARISON_H
#define REPORT_COMPARISON_H

#include "report/study_data.h"
#include "stats/contrast.h"
#include "stats/describe.h"
#include "stats/rates.h"

/* Variants compared over one slice of a study. Rate and severity are kept apart: the crashes of a
 * treated variant are not the baseline's survivors. */

#define CP_SLICE_ALL SIZE_MAX

typedef struct cp_slice {
    size_t scenario;   /* index, or CP_SLICE_ALL */
    size_t crash_type; /* index, or CP_SLICE_ALL */
} cp_slice;

/* Severity is given over all frontally struck vehicles and over those inside the range the
 * surrogate was validated in. */
enum { CP_SCOPE_ALL, CP_SCOPE_INSIDE, CP_SCOPE_COUNT };

/* "all", "inside". */
extern const char *const CP_SCOPE_TEXT[CP_SCOPE_COUNT];

#define CP_RATE_PER_KM 1e6 /* rates are per million vehicle-km */

typedef struct cp_variant_figures {
    size_t variant;
    size_t replications; /* finished */
    double vehicle_km;
    double vehicle_h;
    size_t crashes;            /* of every type in the slice */
    size_t frontal_crashes;    /* at least one vehicle struck on its front */
    size_t front_front_inside; /* of these front-front with both vehicles inside validity */
    double rate;               /* frontal crashes per 10^6 veh-km; NAN without exposure */
    cp_interval rate_garwood;  /* 95 %, exact if counts are Poisson */
    cp_interval rate_bootstrap;
    double dispersion_1; /* of frontal crashes over replications; NAN when unknown */
    size_t frontal_vehicles;
    size_t simulation_failed; /* of these: no OLC, not even censored */
    size_t inside;            /* of these inside validity */
    cp_description olc_g[CP_SCOPE_COUNT];
    cp_description delta_v_m_s[CP_SCOPE_COUNT];
    cp_description closing_speed_m_s[CP_SCOPE_COUNT];
} cp_variant_figures;

/* A treatment against the baseline; differences are treatment minus baseline. */
typedef struct cp_contrast_figures {
    size_t variant;
    size_t replications[2]; /* compared, of baseline and treatment; paired: the common seeds */
    double rate_ratio;
    cp_interval rate_ratio_poisson; /* 95 %, exact if counts are Poisson */
    cp_interval rate_ratio_bootstrap;
    double rate_p;      /* by permutation of whole replications */
    double rate_p_holm; /* adjusted for the number of treatments */
    cp_contrast olc_g[CP_SCOPE_COUNT];
    double olc_p_holm[CP_SCOPE_COUNT]; /* of the Mann-Whitney tests */
} cp_contrast_figures;

typedef struct cp_comparison {
    cp_slice slice;
    size_t baseline;
    size_t variant_count;
    cp_variant_figures *variant; /* in the study's order */
    size_t contrast_count;
    cp_contrast_figures *contrast; /* every other variant against the baseline */
} cp_comparison;

typedef struct cp_comparison_options {
    size_t repetitions;  /* of the bootstrap, default 2000 */
    size_t permutations; /* of the tests, default 1999 */
} cp_comparison_options;

cp_comparison_options cp_comparison_options_default(void);

/* Compare every variant with the variant baseline. The study's seed drives bootstrap and
 * permutations: same database, same numbers. The caller destroys, also after an error. Error:
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_compare(const cp_study_data *data, size_t baseline, cp_slice slice,
                                   const cp_comparison_options *options, cp_comparison *comparison,
                                   cp_error *error);
void cp_comparison_destroy(cp_comparison *comparison);

#endif
