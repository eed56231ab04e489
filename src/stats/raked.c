/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/raked.h"

#include "stats/contrast.h"
#include "stats/sample.h"
#include "stats/weighted.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Where each figure of one evaluation stands: rates of both arms, ratios, quantiles of both arms,
 * differences. */
enum {
    RATES = 0,
    RATIOS = RATES + 2 * CP_RAKED_EVENTS_MAX,
    QUANTILES = RATIOS + CP_RAKED_EVENTS_MAX,
    DIFFERENCES = QUANTILES + 2 * CP_RAKED_QUANTILES,
    FIGURES = DIFFERENCES + CP_RAKED_QUANTILES
};

static const double PROBABILITY[CP_RAKED_QUANTILES] = {0.5, 0.9};

/* What evaluations share. */
typedef struct work {
    const cp_raked *raked;
    size_t strata;
    double effective_clusters[2];
    bool quantiles;    /* what is evaluated: these, or rates and ratios */
    size_t *cell[2];   /* of each unit */
    double *units;     /* of each cell, of the baseline's resample */
    double *of_cell;   /* weight */
    double *weight[2]; /* of each unit */
    unsigned *times[2];
    double *exposure; /* 2 x strata */
    double *event;    /* 2 x strata x events */
    cp_raking_factors factors;
} work;

static void work_destroy(work *w)
{
    for (int g = 0; g < 2; g++) {
        free(w->cell[g]);
        free(w->weight[g]);
        free(w->times[g]);
    }
    free(w->units);
    free(w->of_cell);
    free(w->exposure);
    free(w->event);
}

static cp_status work_create(const cp_raked *raked, work *w, cp_error *error)
{
    *w = (work){.raked = raked, .strata = 1};
    for (int g = 0; g < 2; g++)
        for (size_t c = 0; raked->arm[g].stratum && c < raked->arm[g].cluster_count; c++)
            if (raked->arm[g].stratum[c] >= w->strata)
                w->strata = raked->arm[g].stratum[c] + 1;
    size_t cells = raked->raking ? cp_raking_cells(raked->raking) : 1;
    w->units = calloc(cells, sizeof *w->units);
    w->of_cell = calloc(cells, sizeof *w->of_cell);
    w->exposure = calloc(2 * w->strata, sizeof *w->exposure);
    w->event = calloc(2 * w->strata * (raked->events + 1), sizeof *w->event);
    bool made = w->units && w->of_cell && w->exposure && w->event;
    for (int g = 0; g < 2; g++) {
        const cp_raked_arm *arm = &raked->arm[g];
        w->cell[g] = calloc(arm->count + 1, sizeof *w->cell[g]);
        w->weight[g] = calloc(arm->count + 1, sizeof *w->weight[g]);
        w->times[g] = calloc(arm->count + 1, sizeof *w->times[g]);
        made = made && w->cell[g] && w->weight[g] && w->times[g];
        for (size_t k = 0; made && raked->raking && k < arm->count; k++)
            w->cell[g][k] = cp_raking_cell(raked->raking, &arm->classes[k]);
    }
    return made ? CP_OK : cp_fail_memory(error, "weighted crashes");
}

// ---- one evaluation --------------------------------------------------------------------------

// How often each unit occurs in a resample, and its weight from the resample's own raking.
static void weigh(work *w, const unsigned *const of_cluster[2])
{
    const cp_raked *r = w->raked;
    for (int g = 0; g < 2; g++)
        for (size_t k = 0; k < r->arm[g].count; k++)
            w->times[g][k] = of_cluster[g] ? of_cluster[g][r->arm[g].cluster[k]] : 1;
    if (r->raking) {
        memset(w->units, 0, cp_raking_cells(r->raking) * sizeof *w->units);
        for (size_t k = 0; k < r->arm[0].count; k++)
            w->units[w->cell[0][k]] += w->times[0][k];
        cp_raking_rake(r->raking, w->units, w->of_cell, &w->factors);
    }
    for (int g = 0; g < 2; g++)
        for (size_t k = 0; k < r->arm[g].count; k++)
            w->weight[g][k] = r->raking ? w->of_cell[w->cell[g][k]] : 1.0;
}

static double *events_of(const work *w, int g, size_t stratum)
{
    return w->event + ((size_t)g * w->strata + stratum) * w->raked->events;
}

// Exposure and weighted events by stratum.
static void sum_events(work *w, const unsigned *const of_cluster[2])
{
    const cp_raked *r = w->raked;
    memset(w->exposure, 0, 2 * w->strata * sizeof *w->exposure);
    memset(w->event, 0, 2 * w->strata * r->events * sizeof *w->event);
    for (int g = 0; g < 2; g++) {
        const cp_raked_arm *arm = &r->arm[g];
        for (size_t c = 0; c < arm->cluster_count; c++)
            w->exposure[(size_t)g * w->strata + (arm->stratum ? arm->stratum[c] : 0)] +=
                (of_cluster[g] ? of_cluster[g][c] : 1) * arm->exposure[c];
        for (size_t k = 0; k < arm->count; k++) {
            double counted = w->times[g][k] * w->weight[g][k];
            double *sum = events_of(w, g, arm->stratum ? arm->stratum[arm->cluster[k]] : 0);
            for (size_t e = 0; counted > 0.0 && e < r->events; e++)
                sum[e] += counted * arm->event[k * r->events + e];
        }
    }
}

static void take_rates(const work *w, double *value)
{
    for (size_t e = 0; e < w->raked->events; e++) {
        double sum[2] = {0.0, 0.0}, exposure[2] = {0.0, 0.0}, shared[2] = {0.0, 0.0};
        for (size_t s = 0; s < w->strata; s++) {
            double x[2] = {w->exposure[s], w->exposure[w->strata + s]};
            for (int g = 0; g < 2; g++) {
                double events = events_of(w, g, s)[e];
                sum[g] += events;
                exposure[g] += x[g];
                if (x[0] > 0.0 && x[1] > 0.0)
                    shared[g] += events * x[!g] / (x[0] + x[1]);
            }
        }
        for (size_t g = 0; g < 2; g++)
            value[RATES + g * CP_RAKED_EVENTS_MAX + e] =
                exposure[g] > 0.0 ? sum[g] / exposure[g] : NAN;
        value[RATIOS + e] = shared[0] > 0.0   ? shared[1] / shared[0]
                            : shared[1] > 0.0 ? INFINITY
                                              : NAN;
    }
}

static void take_quantiles(const work *w, double *value)
{
    for (size_t q = 0; q < CP_RAKED_QUANTILES; q++) {
        double found[2];
        for (size_t g = 0; g < 2; g++) {
            const cp_raked_arm *arm = &w->raked->arm[g];
            found[g] = cp_weighted_quantile(arm->severity, w->weight[g], w->times[g],
                                            arm->severities, PROBABILITY[q]);
            value[QUANTILES + g * CP_RAKED_QUANTILES + q] = found[g];
        }
        value[DIFFERENCES + q] = found[1] - found[0];
    }
}

static void evaluate(const unsigned *weight_a, const unsigned *weight_b, const void *context,
                     double *value)
{
    work *w = *(work *const *)context;
    const unsigned *const of_cluster[2] = {weight_a, weight_b};
    for (size_t k = 0; k < FIGURES; k++)
        value[k] = NAN;
    weigh(w, of_cluster);
    if (w->quantiles) {
        take_quantiles(w, value);
    } else {
        sum_events(w, of_cluster);
        take_rates(w, value);
    }
}

// ---- all of it -------------------------------------------------------------------------------

// Whether too few clusters have anything of an event for resamples to show how it scatters.
static bool event_too_few(const work *w, int g, size_t event)
{
    const cp_raked_arm *arm = &w->raked->arm[g];
    size_t found[CP_SAMPLE_CLUSTERS_MIN], there = 0;
    for (size_t k = 0; k < arm->count && there < CP_SAMPLE_CLUSTERS_MIN; k++) {
        bool known = !(w->weight[g][k] * arm->event[k * w->raked->events + event] > 0.0);
        for (size_t f = 0; f < there; f++)
            known |= found[f] == arm->cluster[k];
        if (!known)
            found[there++] = arm->cluster[k];
    }
    return there < CP_SAMPLE_CLUSTERS_MIN;
}

// Kish's number of clusters by the weight their severities have together.
static double effective_clusters(const work *w, int g, double *room)
{
    const cp_raked_arm *arm = &w->raked->arm[g];
    for (size_t c = 0; c < arm->cluster_count; c++)
        room[c] = 0.0;
    for (size_t k = 0; k < arm->severities; k++)
        room[arm->cluster[k]] += w->weight[g][k];
    return cp_weighted_effective(room, arm->cluster_count);
}

static bool quantile_too_few(const work *w, int g, int quantile)
{
    const cp_raked_arm *arm = &w->raked->arm[g];
    double least =
        quantile == CP_RAKED_P90 ? CP_CONTRAST_P90_OBSERVATIONS_MIN : CP_SAMPLE_OBSERVATIONS_MIN;
    if (w->raked->raking)
        least = g == 0 ? CP_RAKED_QUANTILE_EFFECTIVE_MIN : 0.5 * CP_RAKED_QUANTILE_EFFECTIVE_MIN;
    return w->effective_clusters[g] < CP_SAMPLE_CLUSTERS_MIN ||
           cp_weighted_effective(w->weight[g], arm->severities) < least;
}

static cp_interval unless(bool too_few, cp_interval interval)
{
    return too_few ? (cp_interval){CP_INTERVAL_TOO_FEW_CRASHES, NAN, NAN} : interval;
}

static void give(const work *w, const double *value, const cp_interval *interval,
                 cp_raked_figures *figures)
{
    const cp_raked *r = w->raked;
    bool few[2];
    for (int g = 0; g < 2; g++)
        figures->arm[g].effective = cp_weighted_effective(w->weight[g], r->arm[g].count);
    bool small = r->raking && figures->arm[0].effective < CP_RAKED_EFFECTIVE_MIN;
    for (size_t e = 0; e < r->events; e++) {
        for (size_t g = 0; g < 2; g++) {
            size_t at = RATES + g * CP_RAKED_EVENTS_MAX + e;
            few[g] = small || event_too_few(w, (int)g, e);
            figures->arm[g].rate[e] = value[at];
            figures->arm[g].rate_interval[e] = unless(few[g], interval[at]);
        }
        figures->ratio[e] = isfinite(value[RATIOS + e]) ? value[RATIOS + e] : NAN;
        figures->ratio_interval[e] = unless(few[0] || few[1], interval[RATIOS + e]);
    }
    for (size_t q = 0; q < CP_RAKED_QUANTILES; q++) {
        for (size_t g = 0; g < 2; g++) {
            size_t at = QUANTILES + g * CP_RAKED_QUANTILES + q;
            few[g] = small || quantile_too_few(w, (int)g, (int)q);
            figures->arm[g].quantile[q] = value[at];
            figures->arm[g].quantile_interval[q] = unless(few[g], interval[at]);
        }
        figures->difference[q] = value[DIFFERENCES + q];
        figures->difference_interval[q] = unless(few[0] || few[1], interval[DIFFERENCES + q]);
    }
    figures->factors = w->factors;
}

// The sample itself: its weights are what the rules for intervals look at.
static cp_status look_at_sample(work *w, double *value, cp_error *error)
{
    double quantiles[FIGURES];
    work *shared = w;
    w->quantiles = true;
    evaluate(NULL, NULL, &shared, quantiles);
    w->quantiles = false;
    evaluate(NULL, NULL, &shared, value);
    for (size_t k = QUANTILES; k < FIGURES; k++)
        value[k] = quantiles[k];
    for (int g = 0; g < 2; g++) {
        double *room = calloc(w->raked->arm[g].cluster_count + 1, sizeof *room);
        if (!room)
            return cp_fail_memory(error, "weighted crashes");
        w->effective_clusters[g] = effective_clusters(w, g, room);
        free(room);
    }
    return CP_OK;
}

cp_status cp_raked_of(const cp_raked *raked, const cp_resampling *resampling,
                      cp_raked_figures *figures, cp_error *error)
{
    *figures = (cp_raked_figures){0};
    work w;
    work *shared = &w;
    double value[FIGURES];
    cp_interval interval[FIGURES], of_quantiles[FIGURES];
    cp_status status = work_create(raked, &w, error);
    if (status == CP_OK)
        status = look_at_sample(&w, value, error);
    if (status == CP_OK)
        status = cp_bootstrap_many(resampling, evaluate, FIGURES, &shared, interval, error);

    // Severities of few clusters: the same resamples with the reach of as many as count.
    cp_resampling informed = *resampling;
    for (int g = 0; g < 2 && status == CP_OK; g++)
        informed.informative[g] = (size_t)w.effective_clusters[g];
    w.quantiles = true;
    if (status == CP_OK)
        status = cp_bootstrap_many(&informed, evaluate, FIGURES, &shared, of_quantiles, error);
    for (size_t k = QUANTILES; status == CP_OK && k < FIGURES; k++)
        interval[k] = of_quantiles[k];
    if (status == CP_OK) {
        status = look_at_sample(&w, value, error);
        give(&w, value, interval, figures);
    }
    work_destroy(&w);
    return status;
}

void cp_raked_weights(const cp_raked *raked, const cp_raking_factors *factors, int arm,
                      double *weight)
{
    const cp_raked_arm *a = &raked->arm[arm];
    for (size_t k = 0; k < a->count; k++)
        weight[k] = raked->raking ? cp_raking_weight(raked->raking, factors, &a->classes[k]) : 1.0;
}
