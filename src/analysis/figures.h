/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_FIGURES_H
#define ANALYSIS_FIGURES_H

#include "analysis/exceedance.h"
#include "analysis/model_ensemble.h"
#include "analysis/study_data.h"
#include "stats/band.h"
#include "stats/contrast.h"
#include "stats/describe.h"
#include "stats/model_part.h"
#include "stats/paired.h"
#include "stats/precision.h"
#include "stats/rates.h"

/* The figures of a comparison of variants (comparison.h) over one slice of a study. Rate and
 * severity are kept apart: the crashes of a treated variant are not the baseline's survivors. */

#define CP_SLICE_ALL SIZE_MAX

/* A scenario restricts exposure too; everything else restricts crashes and their vehicles only. */
typedef struct cp_slice {
    size_t scenario;             /* index, or CP_SLICE_ALL */
    size_t crash_type;           /* index, or CP_SLICE_ALL */
    const unsigned char *chosen; /* of each vehicle of the study, 1 or 0, borrowed; NULL: all. A
                                    crash belongs when one of its vehicles does, a frontal one when
                                    a frontally struck one does */
} cp_slice;

/* Severity is described over all frontally struck vehicles and over those inside the range the
 * surrogate was validated in. It is compared over all only: a treatment moves crashes out of the
 * range, so that "inside" would select on the outcome; what lies outside is taken for unknown in
 * bounds instead. */
enum { CP_SCOPE_ALL, CP_SCOPE_INSIDE, CP_SCOPE_COUNT };

/* "all", "inside". */
extern const char *const CP_SCOPE_TEXT[CP_SCOPE_COUNT];

#define CP_RATE_PER_KM 1e6 /* rates are per million vehicle-km */

/* Distributions that are described. */
typedef enum cp_slice_quantity {
    CP_QUANTITY_OLC,
    CP_QUANTITY_DELTA_V,
    CP_QUANTITY_CLOSING_SPEED,
    CP_QUANTITY_LATERAL_OFFSET,
    CP_QUANTITY_ANGLE,
    CP_QUANTITY_COUNT
} cp_slice_quantity;

/* Those that are compared: the first ones. */
#define CP_QUANTITIES_COMPARED 3

/* Expected injured drivers by one risk function: the sum of the probabilities over the drivers it
 * is of in frontal crashes (those struck on their front, or both), or over those whose vehicle is
 * inside validity. Intervals carry what is uncertain of the function where its covariance is known.
 */
typedef struct cp_injury_figures {
    size_t drivers; /* with a known predictor */
    size_t unknown; /* without */
    double expected;
    double rate; /* expected per 10^6 veh-km; NAN without exposure */
    cp_interval rate_interval;
    double parameters_se_1; /* relative standard error it leaves; 0 without, NAN of nothing */
} cp_injury_figures;

/* Benefit: 1 - rate of the treatment over rate of the baseline, of expected injured drivers per
 * veh-km; counterfactual: per valid pair, avoided counting 0. */
typedef struct cp_benefit_figures {
    double baseline; /* expected, over what is compared */
    double treatment;
    double benefit_1; /* NAN without any expected with the baseline */
    cp_interval interval;
    double parameters_se_1; /* relative standard error it leaves to 1 - benefit */
    double bound[2]; /* of the benefit, lower and upper, were the risk of each vehicle outside
                        validity, or without a predictor, anything from 0 to 1; -INFINITY; NAN, also
                        of too few crashes for an interval */
} cp_benefit_figures;

typedef struct cp_variant_figures {
    size_t variant;
    size_t replications; /* finished */
    double vehicle_km;
    double vehicle_h;
    size_t crashes;            /* of every type in the slice */
    size_t frontal_crashes;    /* at least one vehicle struck on its front */
    size_t front_front_inside; /* of these front-front with both vehicles inside validity */
    double rate;               /* frontal crashes per 10^6 veh-km; NAN without exposure */
    cp_interval rate_widened;  /* 95 %, of Poisson counts, widened by their dispersion */
    cp_interval rate_bootstrap;
    cp_widening rate_widening;              /* dispersion of frontal crashes over replications */
    cp_exceedance above[CP_EXCEEDED_COUNT]; /* at the x of the options */
    cp_exceedance curve[CP_EXCEEDED_COUNT][CP_EXCEEDANCE_POINTS];
    size_t frontal_vehicles;
    size_t simulation_failed;    /* of these: no OLC, not even censored */
    size_t inside;               /* of these inside validity */
    cp_precision rate_precision; /* of the interval that counts, target +-10 % */
    cp_description description[CP_QUANTITY_COUNT][CP_SCOPE_COUNT]; /* over frontally struck ones */
    cp_interval olc_mean_interval[CP_SCOPE_COUNT];
    cp_precision olc_mean_precision[CP_SCOPE_COUNT]; /* target +-10 % */
    cp_band olc_band[CP_SCOPE_COUNT];                /* of the distribution function */
    cp_injury_figures *injury[CP_SCOPE_COUNT];       /* one a risk function */
    cp_model_part olc_median_model;                  /* of all; sets 0 without an ensemble */
    size_t without_sets;            /* vehicles of that median whose model has none */
    struct cp_field_variant *field; /* beside a field (field_figures.h); NULL: none */
} cp_variant_figures;

/* A treatment against the baseline; differences are treatment minus baseline. */
typedef struct cp_contrast_figures {
    size_t variant;
    size_t replications[2]; /* compared, of baseline and treatment; paired: the common seeds */
    size_t partnerless[2];  /* finished, but without a partner and left out */
    size_t frontal_crashes[2];
    double rate_ratio;              /* Mantel and Haenszel's, over scenarios */
    cp_interval rate_ratio_widened; /* 95 %, of Poisson counts, widened by their dispersion */
    cp_widening rate_ratio_widening;
    cp_interval rate_ratio_bootstrap;
    double rate_p;      /* by permutation of whole replications */
    double rate_p_holm; /* adjusted for every p of the comparison */
    cp_precision rate_ratio_precision;
    cp_exceedance_ratio above[CP_EXCEEDED_COUNT];
    cp_contrast severity[CP_QUANTITIES_COMPARED]; /* over all, mixed alike over scenarios */
    double severity_p_holm[CP_QUANTITIES_COMPARED];
    double distance_p_holm[CP_QUANTITIES_COMPARED];
    cp_superiority olc_bound[2]; /* Cliff's delta of OLC, least and most, with every severity
                                    outside validity unknown */
    cp_model_part median_model;  /* of the difference of OLC medians; sets 0 without an ensemble */
    cp_model_part delta_model;   /* likewise of Cliff's delta of OLC */
    size_t class_vehicles[2];    /* with the errors of classes (class_error.h): of baseline and
                                    treatment; 0 when not asked for, as the next */
    size_t class_without[2];     /* of these with no error that is known */
    double class_error_g;        /* standard error of a difference of mean OLC */
    cp_benefit_figures *benefit; /* one a risk function */
    struct cp_field_contrast *field; /* weighted as a field; NULL: none */
} cp_contrast_figures;

/* Paired severity of the pairs: (a) over all valid pairs, avoided = 0 g; (b) conditional on
 * crashing, over the pairs that crash in both. */
enum { CP_PAIRED_ALL, CP_PAIRED_CRASHING, CP_PAIRED_COUNT };

/* "all_pairs", "conditional_on_crashing". */
extern const char *const CP_PAIRED_TEXT[CP_PAIRED_COUNT];

/* A treatment in the counterfactual design: what became of the baseline's frontal crashes. */
typedef struct cp_counterfactual_figures {
    size_t variant;
    size_t crashes;                    /* of the baseline in the slice, = sum of the outcomes */
    size_t valid;                      /* of these not invalid */
    size_t outcome[CP_OUTCOME_NO_OLC]; /* by closing speed */
    size_t outcome_olc[CP_OUTCOME_NO_OLC + 1];
    cp_interval
        share[CP_OUTCOME_NO_OLC]; /* of the valid pairs, by replications; [invalid] unused */
    size_t reason[CP_NULL_NOT_REPRODUCED + 1]; /* why invalid */
    double new_crashes;                        /* between others, over the valid pairs */
    double vanished_crashes;                   /* likewise; NAN: not known */
    cp_paired olc_g[CP_PAIRED_COUNT];
    cp_paired closing_speed_m_s[CP_PAIRED_COUNT];
    cp_model_part olc_model[CP_PAIRED_COUNT]; /* of Hodges-Lehmann's change; sets 0 without */
    double p_holm[CP_PAIRED_COUNT];       /* of the signed-rank tests of OLC, for every p printed */
    double speed_p_holm[CP_PAIRED_COUNT]; /* likewise of closing speed */
    cp_benefit_figures *benefit;          /* one a risk function, both drivers, all valid pairs */
    /* The same of the crashes that had both vehicles inside validity with the baseline: known
       before any treatment, so this selects nothing by its outcome. */
    size_t inside_crashes;
    size_t inside_valid;
    size_t inside_outcome[CP_OUTCOME_NO_OLC];
    size_t inside_treated_outside; /* of these valid pairs: the treated crash lies outside */
    cp_interval inside_share[CP_OUTCOME_NO_OLC];
    cp_paired inside_olc_g;          /* all valid pairs of these, avoided = 0 g */
    struct cp_field_contrast *field; /* weighted as a field; NULL: none */
} cp_counterfactual_figures;

typedef struct cp_comparison {
    cp_slice slice;
    size_t baseline;
    size_t risk_count; /* of the arrays of injuries and benefits */
    size_t variant_count;
    cp_variant_figures *variant; /* in the study's order */
    size_t contrast_count;
    cp_contrast_figures *contrast; /* every other variant with replications against the baseline */
    size_t counterfactual_count;
    cp_counterfactual_figures *counterfactual; /* every treatment with pairs */
} cp_comparison;

/* The interval of a rate and of a ratio that counts: by bootstrap where replications allow one,
 * else the widened one. */
cp_interval cp_rate_interval(const cp_variant_figures *figures);
cp_interval cp_rate_ratio_interval(const cp_contrast_figures *figures);

typedef struct cp_comparison_options {
    size_t repetitions;                   /* of the bootstrap, default 2000 */
    size_t permutations;                  /* of the tests, default 1999 */
    double above[CP_EXCEEDED_COUNT];      /* headline x of crashes above a severity, >= 0, SI */
    const cp_model_ensemble *ensemble;    /* the model's uncertainty by it; NULL (default), or fewer
                                             than CP_MODEL_SETS_MIN sets: none; borrowed */
    const struct cp_field_request *field; /* also beside this field; NULL (default): none; borrowed
                                           */
} cp_comparison_options;

cp_comparison_options cp_comparison_options_default(void);

/* A zero-initialised one is fine too. */
void cp_comparison_destroy(cp_comparison *comparison);

/* The figures of a variant of the study; NULL when the comparison has none of it. */
const cp_variant_figures *cp_comparison_variant(const cp_comparison *comparison, size_t variant);

#endif
