/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/convergence.h"

#include "analysis/counterfactual.h"
#include "analysis/slice_sample.h"

#include <math.h>
#include <stdlib.h>

const char *const CP_CONVERGING_TEXT[] = {
#define CP_CONVERGING_TEXT_OF(name, text) [name] = text,
    CP_CONVERGING(CP_CONVERGING_TEXT_OF)
#undef CP_CONVERGING_TEXT_OF
};

/* What every series is made from. first: the beginning of a set, filled again for each point. */
typedef struct maker {
    const cp_study_data *data;
    cp_slice slice;
    cp_replication_set set[2];   /* of baseline and treatment */
    cp_replication_set first[2]; /* room for as many */
} maker;

// The replications of a set come scenario by scenario: the first ones of each.
static void take_first(const cp_replication_set *set, size_t of_each, cp_replication_set *first)
{
    size_t begun = 0;
    first->count = 0;
    for (size_t k = 0; k < set->count; k++) {
        begun = k > 0 && set->stratum[k] == set->stratum[k - 1] ? begun : k;
        if (k - begun >= of_each)
            continue;
        first->replication[first->count] = set->replication[k];
        first->stratum[first->count] = set->stratum[k];
        first->frontal_crashes[first->count] = set->frontal_crashes[k];
        first->vehicle_km[first->count++] = set->vehicle_km[k];
    }
}

// Replications of the scenario that has most.
static size_t longest(const cp_replication_set *set)
{
    size_t most = 0, own = 0;
    for (size_t k = 0; k < set->count; k++) {
        own = k > 0 && set->stratum[k] == set->stratum[k - 1] ? own + 1 : 1;
        most = own > most ? own : most;
    }
    return most;
}

static void point_of_rate(const maker *m, cp_convergence_point *point)
{
    cp_exposure exposure = cp_replication_set_exposure(&m->first[0]);
    cp_widening widening;
    point->replications = m->first[0].count;
    point->value = cp_rate(&exposure) * CP_RATE_PER_KM;
    point->interval = cp_rate_widened(&exposure, m->first[0].stratum, 0.95, &widening);
    point->interval.low *= CP_RATE_PER_KM;
    point->interval.high *= CP_RATE_PER_KM;
}

static void point_of_ratio(const maker *m, cp_convergence_point *point)
{
    const cp_replication_set *first = m->first;
    cp_exposure a = cp_replication_set_exposure(&first[0]);
    cp_exposure b = cp_replication_set_exposure(&first[1]);
    cp_resampling resampling = cp_resampling_default();
    for (int g = 0; g < 2; g++) {
        resampling.cluster_count[g] = first[g].count;
        resampling.stratum[g] = first[g].stratum;
    }
    resampling.paired = m->data->paired;
    cp_widening widening;
    point->replications = first[1].count;
    point->value = cp_rate_ratio(&a, &b, first[0].stratum, first[1].stratum);
    point->interval = cp_rate_ratio_widened(&a, &b, &resampling, &widening);
}

static cp_status point_of_avoided(const maker *m, size_t variant, cp_convergence_point *point,
                                  cp_error *error)
{
    cp_counterfactual_figures figures = {.variant = variant};
    cp_status status = cp_counterfactual_outcomes(m->data, m->slice, &m->first[0], &figures, error);
    point->replications = m->first[0].count;
    point->value = figures.valid > 0
                       ? (double)figures.outcome[CP_OUTCOME_AVOIDED] / (double)figures.valid
                       : NAN;
    point->interval = figures.share[CP_OUTCOME_AVOIDED];
    return status;
}

// All points of a series; the sets are those of the baseline and its variant.
static cp_status make_points(maker *m, cp_converging what, cp_convergence_series *series,
                             cp_error *error)
{
    size_t most = longest(&m->set[what == CP_CONVERGING_RATE_RATIO]);
    size_t points = most < CP_CONVERGENCE_POINTS_MAX ? most : CP_CONVERGENCE_POINTS_MAX;
    for (size_t k = 0; k < points; k++) {
        cp_convergence_point *point = &series->point[series->count++];
        for (int g = 0; g < 2; g++)
            take_first(&m->set[g], most * (k + 1) / points, &m->first[g]);
        if (what == CP_CONVERGING_RATE)
            point_of_rate(m, point);
        else if (what == CP_CONVERGING_RATE_RATIO)
            point_of_ratio(m, point);
        else {
            cp_status status = point_of_avoided(m, series->variant, point, error);
            if (status != CP_OK)
                return status;
        }
    }
    return CP_OK;
}

static cp_status make_series(const cp_study_data *data, size_t baseline, cp_slice slice,
                             cp_converging what, cp_convergence_series *series, cp_error *error)
{
    maker m = {.data = data, .slice = slice};
    size_t own = what == CP_CONVERGING_RATE_RATIO ? series->variant : baseline;
    cp_status status = cp_replication_set_create(data, slice, baseline, &m.set[0], error);
    if (status == CP_OK)
        status = cp_replication_set_create(data, slice, own, &m.set[1], error);
    if (status == CP_OK && data->paired)
        cp_replication_set_match(data, &m.set[0], &m.set[1]);
    for (int g = 0; g < 2 && status == CP_OK; g++)
        status = cp_replication_set_create(data, slice, g ? own : baseline, &m.first[g], error);
    if (status == CP_OK)
        status = make_points(&m, what, series, error);
    for (int g = 0; g < 2; g++) {
        cp_replication_set_destroy(&m.set[g]);
        cp_replication_set_destroy(&m.first[g]);
    }
    return status;
}

static bool has_replications(const cp_study_data *data, size_t variant)
{
    for (size_t k = 0; k < data->replication_count; k++)
        if (data->replication[k].variant == variant)
            return true;
    return false;
}

static bool has_pairs(const cp_study_data *data, size_t variant)
{
    for (size_t k = 0; k < data->pair_count; k++)
        if (data->pair[k].variant == variant)
            return true;
    return false;
}

cp_status cp_convergence_create(const cp_study_data *data, size_t baseline, cp_slice slice,
                                cp_convergence *convergence, cp_error *error)
{
    *convergence = (cp_convergence){.what = data->counterfactual ? CP_CONVERGING_AVOIDED
                                                                 : CP_CONVERGING_RATE_RATIO};
    convergence->series = calloc(data->variant_count + 1, sizeof *convergence->series);
    if (!convergence->series)
        return cp_fail_memory(error, "the convergence of a study");
    for (size_t v = 0; v < data->variant_count; v++)
        if (v != baseline &&
            (data->counterfactual ? has_pairs(data, v) : has_replications(data, v)))
            convergence->series[convergence->count++].variant = v;
    if (convergence->count == 0) {
        convergence->what = CP_CONVERGING_RATE;
        convergence->series[convergence->count++].variant = baseline;
    }
    cp_status status = CP_OK;
    for (size_t k = 0; k < convergence->count && status == CP_OK; k++)
        status =
            make_series(data, baseline, slice, convergence->what, &convergence->series[k], error);
    return status;
}

void cp_convergence_destroy(cp_convergence *convergence)
{
    free(convergence->series);
    *convergence = (cp_convergence){0};
}
