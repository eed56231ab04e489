/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TESTS_STATS_FIELD_STUDY_H
#define TESTS_STATS_FIELD_STUDY_H

#include "builders/simulated_study.h"
#include "stats/raked.h"
#include "stats/risk_function.h"

/* Studies whose crashes are of another mix than the field's, with known truth: how often the
 * intervals of weighted figures hold it. Shared by the long program and its short version.
 *
 * Crash types, overlaps and severities of a study are independent, and so are the field's, so that
 * raking leads to the product of the margins' ratios. Injury risk is a logistic function of
 * severity with a term of the crash type; every study gets coefficients drawn from their covariance
 * around the true ones, as if fitted to a field sample of its own. */

/* X(name, text). */
#define FIELD_FIGURES(X)                                                                           \
    X(FIELD_RATE_ABOVE, "rate above x")                                                            \
    X(FIELD_RATIO, "ratio")                                                                        \
    X(FIELD_RATIO_ABOVE, "ratio above x")                                                          \
    X(FIELD_INJURED, "injured")                                                                    \
    X(FIELD_INJURED_ALONE, "injured, coefficients taken as true")                                  \
    X(FIELD_RATIO_INJURED, "ratio of injured")                                                     \
    X(FIELD_MEDIAN, "median")                                                                      \
    X(FIELD_MEDIAN_DIFFERENCE, "difference of medians")                                            \
    X(FIELD_UNWEIGHTED, "rate above x, not weighted")                                              \
    X(FIELD_FIXED, "rate above x, weights taken as known")

enum {
#define FIELD_NAME(name, text) name,
    FIELD_FIGURES(FIELD_NAME)
#undef FIELD_NAME
        FIELD_COUNT
};

static const char *const FIELD_TEXT[FIELD_COUNT] = {
#define FIELD_TEXT_OF(name, text) text,
    FIELD_FIGURES(FIELD_TEXT_OF)
#undef FIELD_TEXT_OF
};

typedef struct field_counts {
    double given[FIELD_COUNT];
    double hits[FIELD_COUNT];
    double effective; /* sum over studies, share of the units */
} field_counts;

enum { FIELD_TYPES = 3, FIELD_OVERLAPS = 3, FIELD_BINS = 5, FIELD_EVENTS = 3 };
enum { EVENT_CRASH, EVENT_ABOVE, EVENT_INJURED };

static const double STUDY_TYPE[FIELD_TYPES] = {0.55, 0.30, 0.15};
static const double FIELD_TYPE[FIELD_TYPES] = {0.25, 0.49, 0.26};
static const double STUDY_OVERLAP[FIELD_OVERLAPS] = {0.25, 0.45, 0.30};
static const double FIELD_OVERLAP[FIELD_OVERLAPS] = {0.35, 0.40, 0.25};
static const double BIN_END[FIELD_BINS - 1] = {14.0, 18.0, 22.0, 28.0};
#define FIELD_MU (SIMULATED_MU - 0.15) /* of the field's severity */
#define FIELD_X 24.0

/* True coefficients of the injury risk and their covariance. */
static const double RISK_TRUE[3] = {-5.0, 0.15, -0.6};
static const double RISK_TRIANGLE[6] = {0.09, -0.0028, 1.2e-4, -0.01, 0.0002, 0.03};
#define RISK_FREEDOM 15.0

static inline size_t field_bin(double severity)
{
    size_t b = 0;
    while (b < FIELD_BINS - 1 && severity > BIN_END[b])
        b++;
    return b;
}

static inline double field_bin_share(size_t bin, double mu)
{
    double low = bin ? gsl_cdf_ugaussian_P((log(BIN_END[bin - 1]) - mu) / SIMULATED_SD) : 0.0;
    double high =
        bin < FIELD_BINS - 1 ? gsl_cdf_ugaussian_P((log(BIN_END[bin]) - mu) / SIMULATED_SD) : 1.0;
    return high - low;
}

static inline cp_raking field_raking(void)
{
    cp_raking r = {.count = 3, .cap = INFINITY};
    r.margin[0] = (cp_raking_margin){.count = FIELD_TYPES};
    r.margin[1] = (cp_raking_margin){.count = FIELD_BINS, .ordered = true};
    r.margin[2] = (cp_raking_margin){.count = FIELD_OVERLAPS, .ordered = true};
    for (size_t k = 0; k < FIELD_TYPES; k++)
        r.margin[0].target[k] = FIELD_TYPE[k];
    for (size_t k = 0; k < FIELD_BINS; k++)
        r.margin[1].target[k] = field_bin_share(k, FIELD_MU);
    for (size_t k = 0; k < FIELD_OVERLAPS; k++)
        r.margin[2].target[k] = FIELD_OVERLAP[k];
    return r;
}

static inline cp_risk_function field_risk(const double coefficient[3])
{
    static const char *const TYPE[FIELD_TYPES] = {"0", "1", "2"};
    cp_risk_function f;
    cp_risk_term term = {.of = CP_RISK_CRASH_TYPE, .add = coefficient[2]};
    cp_error error = {0};
    snprintf(term.name, sizeof term.name, "%s", TYPE[1]);
    if (cp_risk_function_create("logistic", "g", coefficient, 2, &f, &error) != CP_OK ||
        cp_risk_function_add_term(&f, &term, &error) != CP_OK ||
        cp_risk_function_set_covariance(&f, RISK_TRIANGLE, 6, RISK_FREEDOM, &error) != CP_OK)
        abort();
    return f;
}

/* The coefficients of a study: those of a field sample of which the covariance is known (its
 * estimate is not drawn, so that t is used where z would do). */
static inline cp_risk_function field_risk_drawn(uint64_t seed)
{
    // Cholesky's factor of the covariance.
    double l[3][3] = {{0.0}}, drawn[3];
    cp_rng_key key = cp_rng_key_number(cp_rng_key_text(cp_rng_key_seed(seed), "risk"), 3);
    for (size_t i = 0; i < 3; i++)
        for (size_t j = 0; j <= i; j++) {
            double sum = RISK_TRIANGLE[i * (i + 1) / 2 + j];
            for (size_t k = 0; k < j; k++)
                sum -= l[i][k] * l[j][k];
            l[i][j] = i == j ? sqrt(sum) : sum / l[j][j];
        }
    for (size_t i = 0; i < 3; i++) {
        drawn[i] = RISK_TRUE[i];
        for (size_t k = 0; k <= i; k++)
            drawn[i] += l[i][k] * cp_rng_normal(key, k);
    }
    return field_risk(drawn);
}

/* A variant's units with all that cp_raked_arm borrows. */
typedef struct field_arm {
    simulated_variant variant;
    cp_raking_classes *classes;
    double *event;
    cp_raked_arm arm;
} field_arm;

static inline const char *field_type_text(const cp_raking_classes *c)
{
    return c->of[0] == 0 ? "0" : c->of[0] == 1 ? "1" : "2";
}

static inline unsigned char field_draw(double u, const double *share, size_t count)
{
    size_t k = 0;
    while (k + 1 < count && u >= share[k])
        u -= share[k++];
    return (unsigned char)k;
}

static inline field_arm field_arm_of(const simulated_design *d, uint64_t seed, int variant,
                                     const cp_risk_function *risk)
{
    field_arm a = {.variant = simulate_variant(d, seed, variant)};
    const cp_sample *s = &a.variant.sample;
    cp_rng_key key =
        cp_rng_key_number(cp_rng_key_text(cp_rng_key_seed(seed), "classes"), (uint64_t)variant);
    a.classes = calloc(s->count + 1, sizeof *a.classes);
    a.event = calloc(FIELD_EVENTS * (s->count + 1), sizeof *a.event);
    if (!a.classes || !a.event)
        abort();
    for (size_t k = 0; k < s->count; k++) {
        cp_raking_classes *c = &a.classes[k];
        c->of[0] = field_draw(cp_rng_uniform(key, 2 * k), STUDY_TYPE, FIELD_TYPES);
        c->of[1] = (unsigned char)field_bin(s->value[k]);
        c->of[2] = field_draw(cp_rng_uniform(key, 2 * k + 1), STUDY_OVERLAP, FIELD_OVERLAPS);
        a.event[FIELD_EVENTS * k + EVENT_CRASH] = 1.0;
        a.event[FIELD_EVENTS * k + EVENT_ABOVE] = s->value[k] > FIELD_X;
        a.event[FIELD_EVENTS * k + EVENT_INJURED] =
            cp_risk_probability(risk, s->value[k], field_type_text(c));
    }
    a.arm = (cp_raked_arm){.count = s->count,
                           .cluster = s->cluster,
                           .classes = a.classes,
                           .event = a.event,
                           .severity = s->value,
                           .severities = s->count,
                           .cluster_count = s->cluster_count,
                           .exposure = a.variant.exposure};
    return a;
}

static inline void field_arm_destroy(field_arm *a)
{
    simulated_variant_destroy(&a->variant);
    free(a->classes);
    free(a->event);
}

/* What is true of a variant: events per exposure and the median, weighted as the field and not. */
typedef struct field_truth {
    double rate[FIELD_EVENTS];
    double rate_unweighted[FIELD_EVENTS];
    double median;
} field_truth;

static inline field_truth field_truth_of(const simulated_design *d, int variant)
{
    enum { STEPS = 20000 };
    static double cumulated[STEPS];
    field_truth t = {{0.0}, {0.0}, NAN};
    cp_risk_function risk = field_risk(RISK_TRUE);
    double mu = SIMULATED_MU + (variant ? d->shift : 0.0), sum = 0.0;
    double crashes = d->mean_crashes / 100.0 * (variant ? d->rate_ratio : 1.0);
    for (size_t k = 0; k < STEPS; k++) {
        double severity =
            exp(mu + SIMULATED_SD * gsl_cdf_ugaussian_Pinv(((double)k + 0.5) / STEPS));
        size_t bin = field_bin(severity);
        double of_bin = field_bin_share(bin, FIELD_MU) / field_bin_share(bin, SIMULATED_MU);
        double injured[2] = {0.0, 0.0}; // by the study's types, by the field's
        for (unsigned char type = 0; type < FIELD_TYPES; type++) {
            cp_raking_classes c = {{type}};
            double p = cp_risk_probability(&risk, severity, field_type_text(&c));
            injured[0] += STUDY_TYPE[type] * p;
            injured[1] += FIELD_TYPE[type] * p;
        }
        double event[2][FIELD_EVENTS] = {
            {1.0, severity > FIELD_X, injured[0]},
            {of_bin, of_bin * (severity > FIELD_X), of_bin * injured[1]}};
        for (size_t e = 0; e < FIELD_EVENTS; e++) {
            t.rate_unweighted[e] += crashes * event[0][e] / STEPS;
            t.rate[e] += crashes * event[1][e] / STEPS;
        }
        sum += of_bin;
        cumulated[k] = sum;
    }
    size_t middle = 0;
    while (cumulated[middle] < 0.5 * sum)
        middle++;
    t.median = exp(mu + SIMULATED_SD * gsl_cdf_ugaussian_Pinv(((double)middle + 0.5) / STEPS));
    return t;
}

static inline void field_count(field_counts *c, int figure, cp_interval i, double truth)
{
    if (i.status != CP_INTERVAL_VALUE)
        return;
    c->given[figure]++;
    c->hits[figure] += i.low <= truth && truth <= i.high;
}

// Gradient of the weighted sum of risks by the coefficients, over that sum.
static inline void field_gradient(const field_arm *a, const double *weight,
                                  const cp_risk_function *risk, double *gradient)
{
    double sum = 0.0;
    for (size_t k = 0; k < CP_RISK_PARAMETERS_MAX; k++)
        gradient[k] = 0.0;
    for (size_t k = 0; k < a->arm.count; k++)
        sum += weight[k] * cp_risk_add(risk, a->arm.severity[k], field_type_text(&a->classes[k]),
                                       weight[k], gradient);
    for (size_t k = 0; k < CP_RISK_PARAMETERS_MAX; k++)
        gradient[k] /= sum;
}

static inline void field_count_injured(const cp_raked *r, const field_arm arm[2],
                                       const cp_raked_figures *f, const cp_risk_function *risk,
                                       const field_truth truth[2], field_counts *c)
{
    double gradient[2][CP_RISK_PARAMETERS_MAX], apart[CP_RISK_PARAMETERS_MAX];
    for (int g = 0; g < 2; g++) {
        double *weight = calloc(arm[g].arm.count + 1, sizeof *weight);
        if (!weight)
            abort();
        cp_raked_weights(r, &f->factors, g, weight);
        field_gradient(&arm[g], weight, risk, gradient[g]);
        free(weight);
    }
    for (size_t k = 0; k < CP_RISK_PARAMETERS_MAX; k++)
        apart[k] = gradient[1][k] - gradient[0][k];
    const cp_interval *alone = f->arm[0].rate_interval;
    field_count(c, FIELD_INJURED_ALONE, alone[EVENT_INJURED], truth[0].rate[EVENT_INJURED]);
    field_count(c, FIELD_INJURED,
                cp_risk_widened(f->arm[0].rate[EVENT_INJURED], alone[EVENT_INJURED],
                                sqrt(cp_risk_variance(risk, gradient[0])), RISK_FREEDOM),
                truth[0].rate[EVENT_INJURED]);
    field_count(c, FIELD_RATIO_INJURED,
                cp_risk_widened(f->ratio[EVENT_INJURED], f->ratio_interval[EVENT_INJURED],
                                sqrt(cp_risk_variance(risk, apart)), RISK_FREEDOM),
                truth[1].rate[EVENT_INJURED] / truth[0].rate[EVENT_INJURED]);
}

/* One study. fixed: also with weights that are taken as known. */
static inline void field_study(const simulated_design *d, uint64_t seed, size_t repetitions,
                               bool fixed, const field_truth truth[2], field_counts *c)
{
    cp_risk_function risk = field_risk_drawn(seed);
    cp_raking raking = field_raking();
    field_arm arm[2] = {field_arm_of(d, seed, 0, &risk), field_arm_of(d, seed, 1, &risk)};
    cp_raked r = {.raking = &raking, .events = FIELD_EVENTS, .arm = {arm[0].arm, arm[1].arm}};
    cp_resampling resampling = cp_resampling_default();
    resampling.repetitions = repetitions;
    resampling.seed = seed;
    resampling.paired = d->paired;
    resampling.cluster_count[0] = resampling.cluster_count[1] = d->replications;
    cp_raked_figures f;
    cp_error error = {0};
    if (cp_raked_of(&r, &resampling, &f, &error) != CP_OK)
        abort();
    c->effective += f.arm[0].effective / (double)arm[0].arm.count;
    field_count(c, FIELD_RATE_ABOVE, f.arm[0].rate_interval[EVENT_ABOVE],
                truth[0].rate[EVENT_ABOVE]);
    field_count(c, FIELD_RATIO, f.ratio_interval[EVENT_CRASH],
                truth[1].rate[EVENT_CRASH] / truth[0].rate[EVENT_CRASH]);
    field_count(c, FIELD_RATIO_ABOVE, f.ratio_interval[EVENT_ABOVE],
                truth[1].rate[EVENT_ABOVE] / truth[0].rate[EVENT_ABOVE]);
    field_count(c, FIELD_MEDIAN, f.arm[0].quantile_interval[CP_RAKED_MEDIAN], truth[0].median);
    field_count(c, FIELD_MEDIAN_DIFFERENCE, f.difference_interval[CP_RAKED_MEDIAN],
                truth[1].median - truth[0].median);
    field_count_injured(&r, arm, &f, &risk, truth, c);

    // Without weights, and with those of this sample in every resample.
    if (fixed) {
        r.raking = NULL;
        if (cp_raked_of(&r, &resampling, &f, &error) != CP_OK)
            abort();
        field_count(c, FIELD_UNWEIGHTED, f.arm[0].rate_interval[EVENT_ABOVE],
                    truth[0].rate_unweighted[EVENT_ABOVE]);
        r.raking = &raking;
        cp_raking_factors own;
        double units[(FIELD_TYPES + 1) * (FIELD_BINS + 1) * (FIELD_OVERLAPS + 1)] = {0.0};
        double room[(FIELD_TYPES + 1) * (FIELD_BINS + 1) * (FIELD_OVERLAPS + 1)];
        for (size_t k = 0; k < arm[0].arm.count; k++)
            units[cp_raking_cell(&raking, &arm[0].classes[k])]++;
        cp_raking_rake(&raking, units, room, &own);
        for (size_t k = 0; k < arm[0].arm.count; k++)
            for (size_t e = 0; e < FIELD_EVENTS; e++)
                arm[0].event[FIELD_EVENTS * k + e] *=
                    cp_raking_weight(&raking, &own, &arm[0].classes[k]);
        r.raking = NULL;
        if (cp_raked_of(&r, &resampling, &f, &error) != CP_OK)
            abort();
        field_count(c, FIELD_FIXED, f.arm[0].rate_interval[EVENT_ABOVE],
                    truth[0].rate[EVENT_ABOVE]);
    }
    field_arm_destroy(&arm[0]);
    field_arm_destroy(&arm[1]);
}

#endif
