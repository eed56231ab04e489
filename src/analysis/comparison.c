/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/comparison.h"

#include "analysis/class_error.h"
#include "analysis/counterfactual.h"
#include "analysis/exceedance_figures.h"
#include "analysis/field_comparison.h"
#include "analysis/model_uncertainty.h"
#include "analysis/slice_sample.h"

#include <math.h>
#include <stdlib.h>

#define PRECISION_TARGET_1 0.1

// ---- one variant ---------------------------------------------------------------------------

// Crashes of a variant in the slice, counted by what they are.
static void count_crashes(const cp_study_data *data, cp_slice slice, cp_variant_figures *figures)
{
    for (size_t k = 0; k < data->crash_count; k++) {
        const cp_study_crash *crash = &data->crash[k];
        if (data->replication[crash->replication].variant != figures->variant ||
            !cp_slice_has_crash(data, slice, crash))
            continue;
        bool frontal = cp_slice_has_frontal_crash(data, slice, crash);
        figures->crashes++;
        figures->frontal_crashes += frontal;
        figures->front_front_inside +=
            frontal && cp_study_crash_front_front(data, crash) && crash->inside;
    }
}

static void count_vehicles(const cp_study_data *data, cp_slice slice, cp_variant_figures *figures)
{
    for (size_t k = 0; k < data->vehicle_count; k++) {
        const cp_study_vehicle *vehicle = &data->vehicle[k];
        const cp_study_crash *crash = &data->crash[vehicle->crash];
        if (!vehicle->frontal || (slice.chosen && !slice.chosen[k]) ||
            data->replication[crash->replication].variant != figures->variant ||
            !cp_slice_has_crash(data, slice, crash))
            continue;
        figures->frontal_vehicles++;
        figures->inside += vehicle->validity == 0;
        figures->simulation_failed += vehicle->olc == CP_OLC_FAILED;
    }
}

static cp_resampling resampling_of(const cp_study_data *data, const cp_comparison_options *options,
                                   const cp_replication_set *a, const cp_replication_set *b)
{
    cp_resampling resampling = cp_resampling_default();
    resampling.repetitions = options->repetitions;
    resampling.seed = data->seed;
    resampling.cluster_count[0] = a->count;
    resampling.stratum[0] = a->stratum;
    if (b) {
        resampling.cluster_count[1] = b->count;
        resampling.stratum[1] = b->stratum;
        resampling.paired = data->paired;
    }
    return resampling;
}

static double mean_statistic(const unsigned *weight_a, const unsigned *weight_b,
                             const void *context)
{
    (void)weight_b;
    return cp_sample_mean(context, weight_a);
}

// No mean is known of censored vehicles, and none is to be trusted of a few.
static cp_status figure_mean(const cp_sample *sample, const cp_resampling *resampling,
                             cp_interval *interval, cp_error *error)
{
    cp_resampling informed = *resampling;
    informed.informative[0] = cp_sample_informative(sample);
    *interval = (cp_interval){CP_INTERVAL_TOO_FEW_CRASHES, NAN, NAN};
    if (cp_sample_censored(sample) > 0)
        interval->status = CP_INTERVAL_CENSORED;
    else if (!cp_sample_too_few(sample))
        return cp_bootstrap(&informed, mean_statistic, sample, interval, error);
    return CP_OK;
}

// What is given of OLC alone: interval and precision of its mean, band of its distribution.
static cp_status figure_olc(const cp_sample *sample, const cp_resampling *resampling, int scope,
                            cp_variant_figures *figures, cp_error *error)
{
    cp_interval *interval = &figures->olc_mean_interval[scope];
    cp_status status = figure_mean(sample, resampling, interval, error);
    if (status != CP_OK)
        return status;
    figures->olc_mean_precision[scope] = cp_precision_of(cp_sample_mean(sample, NULL), *interval,
                                                         sample->cluster_count, PRECISION_TARGET_1);
    return cp_band_of_ecdf(sample, resampling, &figures->olc_band[scope], error);
}

static cp_status describe(const cp_study_data *data, const cp_replication_set *set, cp_slice slice,
                          const cp_resampling *resampling, cp_variant_figures *figures,
                          cp_error *error)
{
    for (int q = 0; q < CP_QUANTITY_COUNT; q++) {
        for (int scope = 0; scope < CP_SCOPE_COUNT; scope++) {
            cp_sample sample;
            cp_status status = cp_slice_sample(data, set, slice, scope, q, &sample, error);
            if (status != CP_OK)
                return status;
            figures->description[q][scope] = cp_describe(&sample);
            if (q == CP_QUANTITY_OLC)
                status = figure_olc(&sample, resampling, scope, figures, error);
            cp_sample_destroy(&sample);
            if (status != CP_OK)
                return status;
        }
    }
    return CP_OK;
}

static cp_status figure_injuries(const cp_study_data *data, const cp_replication_set *set,
                                 cp_slice slice, cp_variant_figures *figures, cp_error *error)
{
    double *expected = calloc(set->count + 1, sizeof *expected);
    if (!expected)
        return cp_fail_memory(error, "expected injuries");
    cp_status status = CP_OK;
    for (int scope = 0; scope < CP_SCOPE_COUNT; scope++) {
        for (size_t k = 0; k < data->risk_count && status == CP_OK; k++) {
            cp_injury_figures *injury = &figures->injury[scope][k];
            cp_injury_sum sum;
            const cp_risk_function *function = &data->risk[k].function;
            cp_slice_injuries(data, set, slice, scope, &data->risk[k], expected, &sum);
            injury->drivers = sum.drivers;
            injury->unknown = sum.unknown;
            injury->expected = sum.expected;
            injury->parameters_se_1 = sqrt(cp_risk_variance(function, sum.gradient)) / sum.expected;
            cp_exposure exposure = {set->count, expected, set->vehicle_km};
            injury->rate = cp_rate(&exposure) * CP_RATE_PER_KM;
            status = cp_rate_bootstrap(&exposure, set->stratum, data->seed, &injury->rate_interval,
                                       error);
            injury->rate_interval.low *= CP_RATE_PER_KM;
            injury->rate_interval.high *= CP_RATE_PER_KM;
            injury->rate_interval = cp_risk_widened(injury->rate, injury->rate_interval,
                                                    injury->parameters_se_1, function->freedom);
        }
    }
    free(expected);
    return status;
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
    figures->rate_widened = cp_rate_widened(&exposure, set->stratum, 0.95, &figures->rate_widening);
    figures->rate_widened.low *= CP_RATE_PER_KM;
    figures->rate_widened.high *= CP_RATE_PER_KM;
    cp_status status =
        cp_rate_bootstrap(&exposure, set->stratum, data->seed, &figures->rate_bootstrap, error);
    figures->rate_bootstrap.low *= CP_RATE_PER_KM;
    figures->rate_bootstrap.high *= CP_RATE_PER_KM;
    figures->rate_precision =
        cp_precision_of(figures->rate, cp_rate_interval(figures), set->count, PRECISION_TARGET_1);
    return status;
}

static cp_status figure_variant(const cp_study_data *data, cp_slice slice,
                                const cp_comparison_options *options, cp_variant_figures *figures,
                                cp_error *error)
{
    for (int scope = 0; scope < CP_SCOPE_COUNT; scope++) {
        figures->injury[scope] = calloc(data->risk_count + 1, sizeof *figures->injury[scope]);
        if (!figures->injury[scope])
            return cp_fail_memory(error, "expected injuries");
    }
    count_crashes(data, slice, figures);
    count_vehicles(data, slice, figures);
    cp_replication_set set;
    cp_status status = cp_replication_set_create(data, slice, figures->variant, &set, error);
    if (status != CP_OK)
        return status;
    figures->replications = set.count;
    cp_resampling resampling = resampling_of(data, options, &set, NULL);
    status = figure_rate(data, &set, figures, error);
    if (status == CP_OK)
        status = describe(data, &set, slice, &resampling, figures, error);
    if (status == CP_OK)
        status = cp_model_uncertainty_variant(data, options->ensemble, &set, slice, &resampling,
                                              figures, error);
    if (status == CP_OK)
        status = figure_injuries(data, &set, slice, figures, error);
    if (status == CP_OK)
        status = cp_exceedance_figure(data, &set, slice, options, figures, error);
    cp_replication_set_destroy(&set);
    return status;
}

// ---- a treatment against the baseline --------------------------------------------------------

static cp_status contrast_severity(const cp_study_data *data, const cp_replication_set set[2],
                                   cp_slice slice, const cp_resampling *resampling,
                                   cp_contrast_figures *figures, cp_error *error)
{
    for (int q = 0; q < CP_QUANTITIES_COMPARED; q++) {
        cp_sample sample[2] = {{0}, {0}};
        cp_status status = CP_OK;
        for (size_t g = 0; g < 2 && status == CP_OK; g++)
            status = cp_slice_sample(data, &set[g], slice, CP_SCOPE_ALL, q, &sample[g], error);
        if (status == CP_OK)
            status = cp_contrast_samples(&sample[0], &sample[1], resampling, &figures->severity[q],
                                         error);
        cp_sample_destroy(&sample[0]);
        cp_sample_destroy(&sample[1]);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

// Cliff's delta is least with the treatment's unknown severities lowest and the baseline's highest.
static cp_status bound_severity(const cp_study_data *data, const cp_replication_set set[2],
                                cp_slice slice, const cp_resampling *resampling,
                                cp_contrast_figures *figures, cp_error *error)
{
    for (int end = 0; end < 2; end++) {
        cp_sample sample[2] = {{0}, {0}};
        cp_status status = CP_OK;
        for (int g = 0; g < 2 && status == CP_OK; g++)
            status = cp_slice_bound(data, &set[g], slice, g == end, &sample[g], error);
        if (status == CP_OK)
            status = cp_superiority_of(&sample[0], &sample[1], resampling, &figures->olc_bound[end],
                                       error);
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
    figures->rate_ratio = cp_rate_ratio(&a, &b, set[0].stratum, set[1].stratum);
    figures->rate_ratio_widened =
        cp_rate_ratio_widened(&a, &b, resampling, &figures->rate_ratio_widening);
    cp_status status =
        cp_rate_ratio_bootstrap(&a, &b, resampling, &figures->rate_ratio_bootstrap, error);
    figures->rate_ratio_precision = cp_precision_of(
        figures->rate_ratio, cp_rate_ratio_interval(figures), set[1].count, PRECISION_TARGET_1);
    cp_permutation_test test = {NAN, NAN};
    if (status == CP_OK)
        status = cp_contrast_rates(&a, &b, resampling, permutations, &test, error);
    figures->rate_p = test.p;
    return status;
}

static double total(const double *value, size_t count)
{
    double sum = 0.0;
    for (size_t k = 0; k < count; k++)
        sum += value[k];
    return sum;
}

// Benefit is 1 - rate ratio, and so are the bounds of its interval, the other way round.
static cp_status contrast_benefit(const cp_study_data *data, const cp_replication_set set[2],
                                  cp_slice slice, const cp_resampling *resampling, size_t risk,
                                  double *expected[2], cp_benefit_figures *benefit, cp_error *error)
{
    cp_exposure exposure[2];
    cp_injury_sum sum[2];
    double known[2], open[2];
    const cp_risk_function *function = &data->risk[risk].function;
    for (int g = 0; g < 2; g++) {
        cp_injury_sum inside;
        cp_slice_injuries(data, &set[g], slice, CP_SCOPE_INSIDE, &data->risk[risk], expected[g],
                          &inside);
        known[g] = total(expected[g], set[g].count);
        cp_slice_injuries(data, &set[g], slice, CP_SCOPE_ALL, &data->risk[risk], expected[g],
                          &sum[g]);
        open[g] = (double)(sum[g].drivers + sum[g].unknown - inside.drivers);
        exposure[g] = (cp_exposure){set[g].count, expected[g], set[g].vehicle_km};
    }
    cp_interval ratio;
    benefit->baseline = total(expected[0], set[0].count);
    benefit->treatment = total(expected[1], set[1].count);
    benefit->benefit_1 =
        1.0 - cp_rate_ratio(&exposure[0], &exposure[1], set[0].stratum, set[1].stratum);
    cp_status status =
        cp_rate_ratio_bootstrap(&exposure[0], &exposure[1], resampling, &ratio, error);
    benefit->parameters_se_1 = cp_injury_ratio_se(function, &sum[0], &sum[1]);
    ratio = cp_risk_widened(1.0 - benefit->benefit_1, ratio, benefit->parameters_se_1,
                            function->freedom);
    benefit->interval = (cp_interval){ratio.status, 1.0 - ratio.high, 1.0 - ratio.low};

    // At worst every unknown driver of the treatment is injured and none of the baseline.
    double km = total(set[0].vehicle_km, set[0].count) / total(set[1].vehicle_km, set[1].count);
    benefit->bound[0] = 1.0 - km * (known[1] + open[1]) / known[0];
    benefit->bound[1] = 1.0 - km * known[1] / (known[0] + open[0]);
    if (ratio.status == CP_INTERVAL_TOO_FEW_CRASHES)
        benefit->bound[0] = benefit->bound[1] = NAN;
    return status;
}

static cp_status contrast_injuries(const cp_study_data *data, const cp_replication_set set[2],
                                   cp_slice slice, const cp_resampling *resampling,
                                   cp_contrast_figures *figures, cp_error *error)
{
    double *expected[2] = {calloc(set[0].count + 1, sizeof(double)),
                           calloc(set[1].count + 1, sizeof(double))};
    cp_status status = CP_OK;
    if (!expected[0] || !expected[1])
        status = cp_fail_memory(error, "expected injuries");
    for (size_t k = 0; k < data->risk_count && status == CP_OK; k++)
        status = contrast_benefit(data, set, slice, resampling, k, expected, &figures->benefit[k],
                                  error);
    free(expected[0]);
    free(expected[1]);
    return status;
}

// What the errors of the classes of tests leave open.
static cp_status contrast_class_errors(const cp_study_data *data, const cp_replication_set set[2],
                                       cp_slice slice, cp_contrast_figures *figures,
                                       cp_error *error)
{
    cp_class_error found;
    cp_status status = cp_class_error_of(data, set, slice, &found, error);
    if (status != CP_OK)
        return status;
    for (size_t g = 0; g < 2; g++) {
        figures->class_vehicles[g] = found.vehicles[g];
        figures->class_without[g] = found.without[g];
    }
    figures->class_error_g = found.error_g;
    return CP_OK;
}

static cp_status contrast_variant(const cp_study_data *data, const cp_comparison *comparison,
                                  const cp_comparison_options *options,
                                  cp_contrast_figures *figures, cp_error *error)
{
    cp_replication_set set[2] = {{0}, {0}};
    cp_slice slice = comparison->slice;
    figures->benefit = calloc(data->risk_count + 1, sizeof *figures->benefit);
    if (!figures->benefit)
        return cp_fail_memory(error, "expected injuries");
    cp_status status = cp_replication_set_create(data, slice, comparison->baseline, &set[0], error);
    if (status == CP_OK)
        status = cp_replication_set_create(data, slice, figures->variant, &set[1], error);
    if (status != CP_OK)
        goto done;

    // Paired seeds are compared over the seeds that both variants have finished.
    size_t finished[2] = {set[0].count, set[1].count};
    if (data->paired)
        cp_replication_set_match(data, &set[0], &set[1]);
    for (int g = 0; g < 2; g++) {
        figures->partnerless[g] = finished[g] - set[g].count;
        figures->frontal_crashes[g] = (size_t)total(set[g].frontal_crashes, set[g].count);
    }
    cp_resampling resampling = resampling_of(data, options, &set[0], &set[1]);
    figures->replications[0] = set[0].count;
    figures->replications[1] = set[1].count;
    status = contrast_rates(set, &resampling, options->permutations, figures, error);
    if (status == CP_OK)
        status = contrast_severity(data, set, slice, &resampling, figures, error);
    if (status == CP_OK)
        status = cp_model_uncertainty_contrast(data, options->ensemble, set, slice, &resampling,
                                               figures, error);
    if (status == CP_OK && options->ensemble)
        status = contrast_class_errors(data, set, slice, figures, error);
    if (status == CP_OK)
        status = bound_severity(data, set, slice, &resampling, figures, error);
    if (status == CP_OK)
        status = cp_exceedance_contrast(data, set, slice, &resampling, options, figures, error);
    if (status == CP_OK)
        status = contrast_injuries(data, set, slice, &resampling, figures, error);

done:
    cp_replication_set_destroy(&set[0]);
    cp_replication_set_destroy(&set[1]);
    return status;
}

// ---- all of them -------------------------------------------------------------------------------

enum { P_OF_CONTRAST = 1 + 2 * CP_QUANTITIES_COMPARED };

// Where a p-value of a contrast and its adjusted one stand.
static double *p_of(cp_contrast_figures *c, size_t number, bool adjusted)
{
    if (number == 0)
        return adjusted ? &c->rate_p_holm : &c->rate_p;
    size_t q = (number - 1) / 2;
    if (number % 2 == 1)
        return adjusted ? &c->severity_p_holm[q] : &c->severity[q].superiority.p;
    return adjusted ? &c->distance_p_holm[q] : &c->severity[q].distance_p;
}

// Every p-value a comparison prints is of one family.
static cp_status adjust(cp_comparison *comparison, cp_error *error)
{
    size_t count = P_OF_CONTRAST * comparison->contrast_count;
    double *p = calloc(count + 1, sizeof *p);
    if (!p)
        return cp_fail_memory(error, "Holm's adjustment");
    for (size_t k = 0; k < count; k++)
        p[k] = *p_of(&comparison->contrast[k / P_OF_CONTRAST], k % P_OF_CONTRAST, false);
    cp_status status = cp_holm_adjust(p, count, error);
    for (size_t k = 0; k < count; k++)
        *p_of(&comparison->contrast[k / P_OF_CONTRAST], k % P_OF_CONTRAST, true) = p[k];
    free(p);
    return status;
}

cp_status cp_compare(const cp_study_data *data, size_t baseline, cp_slice slice,
                     const cp_comparison_options *options, cp_comparison *comparison,
                     cp_error *error)
{
    *comparison =
        (cp_comparison){.slice = slice, .baseline = baseline, .risk_count = data->risk_count};
    comparison->variant = calloc(data->variant_count + 1, sizeof *comparison->variant);
    comparison->contrast = calloc(data->variant_count + 1, sizeof *comparison->contrast);
    if (!comparison->variant || !comparison->contrast)
        return cp_fail_memory(error, "a comparison");

    // In the counterfactual design only the baseline has replications of its own.
    cp_status status = CP_OK;
    for (size_t k = 0; k < data->variant_count && status == CP_OK; k++) {
        if (data->counterfactual && k != baseline)
            continue;
        cp_variant_figures *figures = &comparison->variant[comparison->variant_count++];
        figures->variant = k;
        status = figure_variant(data, slice, options, figures, error);
        if (status != CP_OK || k == baseline)
            continue;
        cp_contrast_figures *contrast = &comparison->contrast[comparison->contrast_count++];
        contrast->variant = k;
        status = contrast_variant(data, comparison, options, contrast, error);
    }
    if (status == CP_OK && data->counterfactual)
        status = cp_compare_counterfactual(data, options, comparison, error);
    if (status == CP_OK && options->field)
        status = cp_field_compare(data, options, comparison, error);
    return status == CP_OK ? adjust(comparison, error) : status;
}
