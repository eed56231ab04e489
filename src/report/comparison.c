/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/comparison.h"

#include "report/slice_sample.h"

#include <math.h>
#include <stdlib.h>

const char *const CP_SCOPE_TEXT[CP_SCOPE_COUNT] = {"all", "inside"};

cp_comparison_options cp_comparison_options_default(void)
{
    return (cp_comparison_options){.repetitions = 2000, .permutations = 1999};
}

// Crashes of a variant in the slice, counted by what they are.
static void count_crashes(const cp_study_data *data, cp_slice slice, cp_variant_figures *figures)
{
    for (size_t k = 0; k < data->crash_count; k++) {
        const cp_study_crash *crash = &data->crash[k];
        const cp_study_replication *replication = &data->replication[crash->replication];
        if (replication->variant != figures->variant || !cp_slice_has_crash(data, slice, crash))
            continue;
        figures->crashes++;
        figures->frontal_crashes += crash->frontal;
        figures->front_front_inside += cp_study_crash_front_front(data, crash) && crash->inside;
    }
}

static void count_vehicles(const cp_study_data *data, cp_slice slice, cp_variant_figures *figures)
{
    for (size_t k = 0; k < data->vehicle_count; k++) {
        const cp_study_vehicle *vehicle = &data->vehicle[k];
        const cp_study_crash *crash = &data->crash[vehicle->crash];
        if (data->replication[crash->replication].variant != figures->variant ||
            !cp_slice_has_crash(data, slice, crash))
            continue;
        figures->frontal_vehicles++;
        figures->inside += vehicle->validity == 0;
        figures->simulation_failed += vehicle->olc == CP_OLC_FAILED;
    }
}

static cp_status describe_quantity(const cp_study_data *data, const cp_replication_set *set,
                                   cp_slice slice, cp_slice_quantity quantity,
                                   cp_description *description, cp_error *error)
{
    for (int scope = 0; scope < CP_SCOPE_COUNT; scope++) {
        cp_sample sample;
        cp_status status = cp_slice_sample(data, set, slice, scope, quantity, &sample, error);
        if (status != CP_OK)
            return status;
        description[scope] = cp_describe(&sample);
        cp_sample_destroy(&sample);
    }
    return CP_OK;
}

static cp_status figure_rate(const cp_study_data *data, const cp_replication_set *set,
                             cp_variant_figures *figures, cp_error *error)
{
    cp_exposure exposure = cp_replication_set_exposure(set);
    for (size_t k = 0; k < set->count; k++) {
        figures->vehicle_km += set->vehicle_km[k];
        figures->vehicle_h += data->replication[set->replication[k]].vehicle_h;
    }
    figures->rate = cp_rate(&exposure) * CP_RATE_PER_KM;
    figures->dispersion_1 = cp_rate_dispersion(&exposure, set->stratum);
    figures->rate_garwood = (cp_interval){CP_INTERVAL_UNDEFINED, NAN, NAN};
    if (figures->vehicle_km > 0.0) {
        double scale = CP_RATE_PER_KM / figures->vehicle_km;
        figures->rate_garwood = cp_rate_garwood((double)figures->frontal_crashes, 0.95);
        figures->rate_garwood.low *= scale;
        figures->rate_garwood.high *= scale;
    }
    cp_status status =
        cp_rate_bootstrap(&exposure, set->stratum, data->seed, &figures->rate_bootstrap, error);
    figures->rate_bootstrap.low *= CP_RATE_PER_KM;
    figures->rate_bootstrap.high *= CP_RATE_PER_KM;
    return status;
}

static cp_status figure_variant(const cp_study_data *data, cp_slice slice,
                                cp_variant_figures *figures, cp_error *error)
{
    count_crashes(data, slice, figures);
    count_vehicles(data, slice, figures);
    cp_replication_set set;
    cp_status status = cp_replication_set_create(data, slice, figures->variant, &set, error);
    if (status != CP_OK)
        return status;
    figures->replications = set.count;
    status = figure_rate(data, &set, figures, error);
    if (status == CP_OK)
        status = describe_quantity(data, &set, slice, CP_QUANTITY_OLC, figures->olc_g, error);
    if (status == CP_OK)
        status =
            describe_quantity(data, &set, slice, CP_QUANTITY_DELTA_V, figures->delta_v_m_s, error);
    if (status == CP_OK)
        status = describe_quantity(data, &set, slice, CP_QUANTITY_CLOSING_SPEED,
                                   figures->closing_speed_m_s, error);
    cp_replication_set_destroy(&set);
    return status;
}

static cp_status contrast_severity(const cp_study_data *data, const cp_replication_set set[2],
                                   cp_slice slice, const cp_resampling *resampling,
                                   size_t permutations, cp_contrast_figures *figures,
                                   cp_error *error)
{
    for (int scope = 0; scope < CP_SCOPE_COUNT; scope++) {
        cp_sample sample[2] = {{0}, {0}};
        cp_status status = CP_OK;
        for (size_t g = 0; g < 2 && status == CP_OK; g++)
            status =
                cp_slice_sample(data, &set[g], slice, scope, CP_QUANTITY_OLC, &sample[g], error);
        if (status == CP_OK)
            status = cp_contrast_samples(&sample[0], &sample[1], resampling, permutations,
                                         &figures->olc_g[scope], error);
        cp_sample_destroy(&sample[0]);
        cp_sample_destroy(&sample[1]);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

static cp_status contrast_rates(const cp_replication_set set[2], const cp_resampling *resampling,
                                size_t permutations, cp_contrast_figures *figures, cp_error *error)
{
    cp_exposure a = cp_replication_set_exposure(&set[0]);
    cp_exposure b = cp_replication_set_exposure(&set[1]);
    figures->rate_ratio = cp_rate_ratio(&a, &b);
    figures->rate_ratio_poisson = cp_rate_ratio_poisson(&a, &b, resampling->level_1);
    cp_status status =
        cp_rate_ratio_bootstrap(&a, &b, resampling, &figures->rate_ratio_bootstrap, error);
    cp_permutation_test test = {NAN, NAN};
    if (status == CP_OK)
        status = cp_contrast_rates(&a, &b, resampling, permutations, &test, error);
    figures->rate_p = test.p;
    return status;
}

static cp_status contrast_variant(const cp_study_data *data, const cp_comparison *comparison,
                                  const cp_comparison_options *options,
                                  cp_contrast_figures *figures, cp_error *error)
{
    cp_replication_set set[2] = {{0}, {0}};
    cp_slice slice = comparison->slice;
    cp_status status = cp_replication_set_create(data, slice, comparison->baseline, &set[0], error);
    if (status == CP_OK)
        status = cp_replication_set_create(data, slice, figures->variant, &set[1], error);
    if (status != CP_OK)
        goto done;

    // Paired seeds are compared over the seeds that both variants have finished.
    if (data->paired)
        cp_replication_set_match(data, &set[0], &set[1]);
    cp_resampling resampling = cp_resampling_default();
    resampling.repetitions = options->repetitions;
    resampling.seed = data->seed;
    resampling.paired = data->paired;
    for (size_t g = 0; g < 2; g++) {
        figures->replications[g] = resampling.cluster_count[g] = set[g].count;
        resampling.stratum[g] = set[g].stratum;
    }
    status = contrast_rates(set, &resampling, options->permutations, figures, error);
    if (status == CP_OK)
        status =
            contrast_severity(data, set, slice, &resampling, options->permutations, figures, error);

done:
    cp_replication_set_destroy(&set[0]);
    cp_replication_set_destroy(&set[1]);
    return status;
}

// Several treatments against one baseline: every family of p-values is adjusted together.
static cp_status adjust(cp_comparison *comparison, cp_error *error)
{
    size_t count = comparison->contrast_count;
    double *p = calloc(count + 1, sizeof *p);
    if (!p)
        return cp_fail_memory(error, "Holm's adjustment");
    cp_status status = CP_OK;
    for (int family = -1; family < CP_SCOPE_COUNT && status == CP_OK; family++) {
        for (size_t k = 0; k < count; k++)
            p[k] = family < 0 ? comparison->contrast[k].rate_p
                              : comparison->contrast[k].olc_g[family].mann_whitney.p;
        status = cp_holm_adjust(p, count, error);
        for (size_t k = 0; k < count; k++)
            *(family < 0 ? &comparison->contrast[k].rate_p_holm
                         : &comparison->contrast[k].olc_p_holm[family]) = p[k];
    }
    free(p);
    return status;
}

cp_status cp_compare(const cp_study_data *data, size_t baseline, cp_slice slice,
                     const cp_comparison_options *options, cp_comparison *comparison,
                     cp_error *error)
{
    *comparison = (cp_comparison){.slice = slice, .baseline = baseline};
    comparison->variant = calloc(data->variant_count + 1, sizeof *comparison->variant);
    comparison->contrast = calloc(data->variant_count + 1, sizeof *comparison->contrast);
    if (!comparison->variant || !comparison->contrast)
        return cp_fail_memory(error, "a comparison");

    cp_status status = CP_OK;
    for (size_t k = 0; k < data->variant_count && status == CP_OK; k++) {
        cp_variant_figures *figures = &comparison->variant[comparison->variant_count++];
        figures->variant = k;
        status = figure_variant(data, slice, figures, error);
        if (status != CP_OK || k == baseline)
            continue;
        cp_contrast_figures *contrast = &comparison->contrast[comparison->contrast_count++];
        contrast->variant = k;
        status = contrast_variant(data, comparison, options, contrast, error);
    }
    return status == CP_OK ? adjust(comparison, error) : status;
}

void cp_comparison_destroy(cp_comparison *comparison)
{
    free(comparison->variant);
    free(comparison->contrast);
    *comparison = (cp_comparison){0};
}
