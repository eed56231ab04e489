/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/model_uncertainty.h"

#include "stats/pooled.h"

#include <math.h>
#include <stdlib.h>

static cp_status make_room(const cp_model_ensemble *ensemble, cp_estimate **of_set, cp_error *error)
{
    *of_set = calloc(ensemble->count, sizeof **of_set);
    return *of_set ? CP_OK : cp_fail_memory(error, "the model's uncertainty");
}

static double median_statistic(const unsigned *weight_a, const unsigned *weight_b,
                               const void *context)
{
    (void)weight_b;
    return cp_sample_quantile(context, weight_a, 0.5);
}

static cp_status median_interval(const cp_sample *sample, cp_estimate median,
                                 const cp_resampling *resampling, cp_interval *interval,
                                 cp_error *error)
{
    cp_resampling informed = *resampling;
    informed.informative[0] = cp_sample_informative(sample);
    *interval = (cp_interval){CP_INTERVAL_TOO_FEW_CRASHES, NAN, NAN};
    if (cp_sample_too_few(sample))
        return CP_OK;
    if (median.relation != CP_EXACTLY) {
        interval->status = CP_INTERVAL_CENSORED;
        return CP_OK;
    }
    return cp_bootstrap(&informed, median_statistic, sample, interval, error);
}

// Frontally struck vehicles of the sample that keep their own OLC in every set.
static size_t count_without(const cp_study_data *data, const cp_model_ensemble *ensemble,
                            const cp_replication_set *set, cp_slice slice)
{
    size_t without = 0;
    for (size_t k = 0; k < data->vehicle_count; k++) {
        const cp_study_vehicle *vehicle = &data->vehicle[k];
        const cp_study_crash *crash = &data->crash[vehicle->crash];
        without += vehicle->frontal && vehicle->olc != CP_OLC_FAILED && isnan(ensemble->olc_g[k]) &&
                   (!slice.chosen || slice.chosen[k]) && cp_slice_has_crash(data, slice, crash) &&
                   cp_replication_set_cluster(set, crash->replication) != SIZE_MAX;
    }
    return without;
}

cp_status cp_model_uncertainty_variant(const cp_study_data *data, const cp_model_ensemble *ensemble,
                                       const cp_replication_set *set, cp_slice slice,
                                       const cp_resampling *resampling, cp_variant_figures *figures,
                                       cp_error *error)
{
    if (!ensemble || ensemble->count < CP_MODEL_SETS_MIN)
        return CP_OK;
    cp_estimate *of_set = NULL, own = {CP_NO_VALUE, NAN};
    cp_interval interval;
    cp_sample sample = {0};
    cp_status status = make_room(ensemble, &of_set, error);
    if (status == CP_OK)
        status = cp_slice_sample(data, set, slice, CP_SCOPE_ALL, CP_QUANTITY_OLC, &sample, error);
    if (status == CP_OK) {
        own = cp_describe_quantile(&sample, 0.5);
        status = median_interval(&sample, own, resampling, &interval, error);
    }
    cp_sample_destroy(&sample);
    for (size_t m = 0; m < ensemble->count && status == CP_OK; m++) {
        const cp_study_data by_set = cp_model_ensemble_study(ensemble, data, m);
        status =
            cp_slice_sample(&by_set, set, slice, CP_SCOPE_ALL, CP_QUANTITY_OLC, &sample, error);
        if (status == CP_OK)
            of_set[m] = cp_describe_quantile(&sample, 0.5);
        cp_sample_destroy(&sample);
    }
    if (status == CP_OK) {
        figures->without_sets = count_without(data, ensemble, set, slice);
        figures->olc_median_model = cp_model_part_of(own, interval, of_set, ensemble->count);
    }
    free(of_set);
    return status;
}

// Both figures by one set.
static cp_status contrast_by_set(const cp_study_data *by_set, const cp_replication_set set[2],
                                 cp_slice slice, const cp_resampling *resampling,
                                 cp_estimate *difference, cp_estimate *delta, cp_error *error)
{
    cp_sample sample[2] = {{0}, {0}};
    cp_pooled pooled = {0};
    cp_superiority superiority;
    cp_status status = CP_OK;
    for (size_t g = 0; g < 2 && status == CP_OK; g++)
        status = cp_slice_sample(by_set, &set[g], slice, CP_SCOPE_ALL, CP_QUANTITY_OLC, &sample[g],
                                 error);
    if (status == CP_OK)
        status = cp_pooled_create(&sample[0], &sample[1], resampling->stratum[0],
                                  resampling->stratum[1], &pooled, error);
    if (status == CP_OK)
        status = cp_superiority_of(&sample[0], &sample[1], resampling, &superiority, error);
    if (status == CP_OK) {
        *difference = cp_estimate_difference(cp_pooled_estimate(&pooled, 0, CP_POOLED_MEDIAN),
                                             cp_pooled_estimate(&pooled, 1, CP_POOLED_MEDIAN));
        *delta = cp_estimate_of(superiority.cliffs_delta);
    }
    cp_pooled_destroy(&pooled);
    cp_sample_destroy(&sample[0]);
    cp_sample_destroy(&sample[1]);
    return status;
}

// No effect size lies beyond -1 or 1.
static void bound_to_one(cp_interval *interval)
{
    interval->low = interval->low < -1.0 ? -1.0 : interval->low;
    interval->high = interval->high > 1.0 ? 1.0 : interval->high;
}

cp_status cp_model_uncertainty_contrast(const cp_study_data *data,
                                        const cp_model_ensemble *ensemble,
                                        const cp_replication_set set[2], cp_slice slice,
                                        const cp_resampling *resampling,
                                        cp_contrast_figures *figures, cp_error *error)
{
    if (!ensemble || ensemble->count < CP_MODEL_SETS_MIN)
        return CP_OK;
    cp_estimate *difference = NULL, *delta = NULL;
    cp_status status = make_room(ensemble, &difference, error);
    if (status == CP_OK)
        status = make_room(ensemble, &delta, error);
    for (size_t m = 0; m < ensemble->count && status == CP_OK; m++) {
        const cp_study_data by_set = cp_model_ensemble_study(ensemble, data, m);
        status = contrast_by_set(&by_set, set, slice, resampling, &difference[m], &delta[m], error);
    }
    if (status == CP_OK) {
        const cp_contrast *own = &figures->severity[CP_QUANTITY_OLC];
        const cp_superiority *s = &own->superiority;
        cp_interval interval = s->interval;
        if (s->status != CP_INTERVAL_VALUE)
            interval = (cp_interval){s->status, NAN, NAN};
        figures->median_model = cp_model_part_of(own->median_difference, own->median_interval,
                                                 difference, ensemble->count);
        figures->delta_model =
            cp_model_part_of(cp_estimate_of(s->cliffs_delta), interval, delta, ensemble->count);
        bound_to_one(&figures->delta_model.combined);
    }
    free(difference);
    free(delta);
    return status;
}
