/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/contrast.h"

#include "stats/permutation.h"
#include "stats/pooled.h"

#include <gsl/gsl_sort.h>

#include <math.h>
#include <stdlib.h>

// At least as extreme, up to rounding of sums taken in another order.
static bool as_extreme(double permuted, double observed)
{
    if (isinf(observed))
        return permuted >= observed;
    return permuted >= observed - 1e-12 * fmax(1.0, fabs(observed));
}

static void differences(const unsigned *weight_a, const unsigned *weight_b, const void *context,
                        double *value)
{
    cp_pooled_differences(context, weight_a, weight_b, value);
}

/* Distances of resamples from what was observed. */
typedef struct distances {
    const cp_pooled *pooled;
    const double *centre;
    double scale;
    double observed;
    double valid;
    double *value;
} distances;

static void collect(void *context, const unsigned *weight_a, const unsigned *weight_b)
{
    distances *d = context;
    double distance = cp_pooled_distance(d->pooled, weight_a, weight_b, d->centre);
    if (!isnan(distance))
        d->value[(size_t)d->valid++] = distance;
}

// As if the functions were the same: how far resamples stray from the difference as observed.
static cp_status test_distance(const cp_pooled *p, const cp_resampling *resampling,
                               cp_contrast *contrast, cp_error *error)
{
    contrast->distance = cp_pooled_distance(p, NULL, NULL, NULL);
    contrast->distance_p = NAN;
    if (contrast->superiority.status != CP_INTERVAL_VALUE || resampling->repetitions == 0 ||
        cp_bootstrap_allowed(resampling) != CP_INTERVAL_VALUE)
        return CP_OK;
    double *centre = calloc(p->count + 1, sizeof *centre);
    double *value = calloc(resampling->repetitions + 1, sizeof *value);
    cp_status status = CP_OK;
    if (!centre || !value) {
        status = cp_fail_memory(error, "the distance of two distributions");
        goto done;
    }
    cp_pooled_centre(p, centre);
    distances d = {.pooled = p, .centre = centre, .value = value};
    double scale = INFINITY, extreme = 0.0;
    status = cp_bootstrap_draws(resampling, collect, &d, &scale, error);
    for (size_t k = 0; k < (size_t)d.valid; k++)
        extreme += as_extreme(scale * value[k], contrast->distance);
    if (status == CP_OK && d.valid >= 0.95 * (double)resampling->repetitions)
        contrast->distance_p = (1.0 + extreme) / (1.0 + d.valid);

done:
    free(centre);
    free(value);
    return status;
}

// An interval where both samples have enough for one.
static cp_interval given(const cp_contrast *contrast, cp_estimate difference, cp_interval interval)
{
    if (contrast->superiority.status == CP_INTERVAL_TOO_FEW_CRASHES)
        return (cp_interval){CP_INTERVAL_TOO_FEW_CRASHES, NAN, NAN};
    if (difference.relation != CP_EXACTLY && interval.status == CP_INTERVAL_UNDEFINED)
        return (cp_interval){CP_INTERVAL_CENSORED, NAN, NAN};
    return interval;
}

cp_status cp_contrast_samples(const cp_sample *a, const cp_sample *b,
                              const cp_resampling *resampling, cp_contrast *contrast,
                              cp_error *error)
{
    *contrast = (cp_contrast){.distance = NAN, .distance_p = NAN};
    cp_pooled p;
    cp_interval interval[CP_POOLED_COUNT];
    cp_status status =
        cp_pooled_create(a, b, resampling->stratum[0], resampling->stratum[1], &p, error);
    if (status == CP_OK)
        status = cp_superiority_of(a, b, resampling, &contrast->superiority, error);
    cp_resampling informed = *resampling;
    informed.informative[0] = cp_sample_informative(a);
    informed.informative[1] = cp_sample_informative(b);
    if (status == CP_OK)
        status = cp_bootstrap_many(&informed, differences, CP_POOLED_COUNT, &p, interval, error);
    if (status == CP_OK) {
        cp_estimate difference[CP_POOLED_COUNT];
        for (int f = 0; f < CP_POOLED_COUNT; f++)
            difference[f] =
                cp_estimate_difference(cp_pooled_estimate(&p, 0, f), cp_pooled_estimate(&p, 1, f));
        for (int g = 0; g < 2; g++) {
            contrast->compared[g] = cp_pooled_compared(&p, g);
            contrast->median[g] = cp_pooled_estimate(&p, g, CP_POOLED_MEDIAN);
        }
        contrast->mean_difference = difference[CP_POOLED_MEAN];
        contrast->median_difference = difference[CP_POOLED_MEDIAN];
        contrast->p90_difference = difference[CP_POOLED_P90];
        contrast->mean_interval = given(contrast, difference[0], interval[CP_POOLED_MEAN]);
        contrast->median_interval = given(contrast, difference[1], interval[CP_POOLED_MEDIAN]);
        contrast->p90_interval = given(contrast, difference[2], interval[CP_POOLED_P90]);
        if (a->count < CP_CONTRAST_P90_OBSERVATIONS_MIN ||
            b->count < CP_CONTRAST_P90_OBSERVATIONS_MIN)
            contrast->p90_interval = (cp_interval){CP_INTERVAL_TOO_FEW_CRASHES, NAN, NAN};
        status = test_distance(&p, resampling, contrast, error);
    }
    cp_pooled_destroy(&p);
    return status;
}

// Log of the rate ratio of group 1 over group 0 under a labelling; NAN without any exposure.
static double log_ratio(const cp_exposure *a, const cp_exposure *b, const unsigned char *label)
{
    double events[2] = {0.0, 0.0}, exposure[2] = {0.0, 0.0};
    for (size_t k = 0; k < a->cluster_count + b->cluster_count; k++) {
        const cp_exposure *from = k < a->cluster_count ? a : b;
        size_t own = k < a->cluster_count ? k : k - a->cluster_count;
        events[label[k]] += from->events[own];
        exposure[label[k]] += from->exposure[own];
    }
    if (exposure[0] <= 0.0 || exposure[1] <= 0.0 || events[0] + events[1] <= 0.0)
        return NAN;
    return log(events[1] / exposure[1]) - log(events[0] / exposure[0]);
}

cp_status cp_contrast_rates(const cp_exposure *a, const cp_exposure *b,
                            const cp_resampling *resampling, size_t permutations,
                            cp_permutation_test *test, cp_error *error)
{
    *test = (cp_permutation_test){NAN, NAN};
    cp_permutation permutation = {0};
    cp_status status = cp_permutation_create(resampling, &permutation, error);
    if (status != CP_OK)
        return status;
    test->statistic = log_ratio(a, b, permutation.label);
    double events = 0.0;
    for (size_t k = 0; k < a->cluster_count; k++)
        events += a->events[k];
    for (size_t k = 0; k < b->cluster_count; k++)
        events += b->events[k];
    if (!isnan(test->statistic) && permutations > 0 && events >= CP_CONTRAST_EVENTS_MIN) {
        double valid = 0.0, extreme = 0.0;
        for (size_t number = 1; number <= permutations; number++) {
            cp_permutation_set(&permutation, number);
            double permuted = log_ratio(a, b, permutation.label);
            valid += !isnan(permuted);
            extreme += !isnan(permuted) && as_extreme(fabs(permuted), fabs(test->statistic));
        }
        test->p = (1.0 + extreme) / (1.0 + valid);
    }
    cp_permutation_destroy(&permutation);
    return CP_OK;
}

cp_status cp_holm_adjust(double *p, size_t count, cp_error *error)
{
    size_t *order = calloc(count + 1, sizeof *order);
    double *key = calloc(count + 1, sizeof *key);
    if (!order || !key) {
        free(order);
        free(key);
        return cp_fail_memory(error, "Holm's adjustment");
    }
    // Missing p-values sort last and take no part.
    size_t tests = 0;
    for (size_t k = 0; k < count; k++) {
        key[k] = isnan(p[k]) ? INFINITY : p[k];
        tests += !isnan(p[k]);
    }
    gsl_sort_index(order, key, 1, count);

    // The smallest times all tests, the next times one fewer, never falling, at most 1.
    double largest = 0.0;
    for (size_t k = 0; k < tests; k++) {
        largest = fmax(largest, fmin(1.0, (double)(tests - k) * p[order[k]]));
        p[order[k]] = largest;
    }
    free(order);
    free(key);
    return CP_OK;
}
