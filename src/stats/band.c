/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/band.h"

#include <gsl/gsl_sort.h>

#include <math.h>
#include <stdlib.h>

/* Largest distances are collected through the bootstrap's own draws. */
typedef struct collector {
    const cp_sample *sample;
    const size_t *size; /* observations of each cluster */
    double *distance;
    size_t count;
} collector;

// Largest distance between the distribution functions of a resample and of the sample.
static double largest_distance(const collector *c, const unsigned *weight)
{
    const cp_sample *sample = c->sample;
    double total = 0.0, passed = 0.0, largest = 0.0;
    for (size_t k = 0; k < sample->cluster_count; k++)
        total += (double)weight[k] * (double)c->size[k];
    if (total <= 0.0)
        return NAN;
    for (size_t k = 0; k < sample->count; k++) {
        passed += weight[sample->cluster[k]];
        bool step_ends = k + 1 == sample->count || sample->value[k + 1] != sample->value[k];
        if (!step_ends)
            continue;
        double apart = fabs(passed / total - (double)(k + 1) / (double)sample->count);
        largest = apart > largest ? apart : largest;
    }
    return largest;
}

static void collect(void *context, const unsigned *weight, const unsigned *unused)
{
    (void)unused;
    collector *c = context;
    double distance = largest_distance(c, weight);
    if (!isnan(distance))
        c->distance[c->count++] = distance;
}

cp_status cp_band_of_ecdf(const cp_sample *sample, const cp_resampling *resampling, cp_band *band,
                          cp_error *error)
{
    *band = (cp_band){cp_bootstrap_allowed(resampling), NAN};
    if (band->status != CP_INTERVAL_VALUE)
        return CP_OK;
    if (cp_sample_too_few(sample)) {
        band->status = CP_INTERVAL_TOO_FEW_CRASHES;
        return CP_OK;
    }
    band->status = CP_INTERVAL_UNDEFINED;
    size_t *size = calloc(sample->cluster_count + 1, sizeof *size);
    double *distance = calloc(resampling->repetitions + 1, sizeof *distance);
    cp_status status = CP_OK;
    if (!size || !distance) {
        status = cp_fail_memory(error, "a confidence band");
        goto done;
    }
    for (size_t k = 0; k < sample->count; k++)
        size[sample->cluster[k]]++;
    collector c = {.sample = sample, .size = size, .distance = distance};
    double scale = INFINITY;
    status = cp_bootstrap_draws(resampling, collect, &c, &scale, error);
    if (status == CP_OK && sample->count > 0 &&
        (double)c.count >= 0.95 * (double)resampling->repetitions && isfinite(scale)) {
        gsl_sort(distance, 1, c.count);
        size_t rank = (size_t)ceil(resampling->level_1 * (double)(c.count + 1));
        rank = rank > c.count ? c.count : rank;
        *band = (cp_band){CP_INTERVAL_VALUE, fmin(1.0, scale * distance[rank - 1])};
    }

done:
    free(distance);
    free(size);
    return status;
}
