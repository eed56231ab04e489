/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/sample.h"

#include <gsl/gsl_sort.h>

#include <math.h>
#include <stdlib.h>

static unsigned weight_of(const cp_sample *sample, const unsigned *weight, size_t k)
{
    return weight ? weight[sample->cluster[k]] : 1;
}

cp_status cp_sample_create(const double *value, const size_t *cluster, size_t count,
                           size_t cluster_count, cp_sample *sample, cp_error *error)
{
    *sample = (cp_sample){.count = count, .cluster_count = cluster_count};
    cp_status status = CP_OK;
    size_t *order = calloc(count + 1, sizeof *order);
    sample->value = calloc(count + 1, sizeof *sample->value);
    sample->cluster = calloc(count + 1, sizeof *sample->cluster);
    if (!order || !sample->value || !sample->cluster) {
        status = cp_fail_memory(error, "a sample");
        goto failed;
    }
    for (size_t k = 0; k < count; k++) {
        if (isnan(value[k]) || (isinf(value[k]) && value[k] > 0.0) || cluster[k] >= cluster_count) {
            status = cp_fail(error, CP_BAD_INPUT,
                             "observation %zu of a sample must be finite or -infinity and of a "
                             "cluster < %zu, found %g of cluster %zu",
                             k, cluster_count, value[k], cluster[k]);
            goto failed;
        }
    }

    // Sorted once; every resample walks the same order.
    gsl_sort_index(order, value, 1, count);
    for (size_t k = 0; k < count; k++) {
        sample->value[k] = value[order[k]];
        sample->cluster[k] = cluster[order[k]];
    }
    free(order);
    return CP_OK;

failed:
    free(order);
    cp_sample_destroy(sample);
    return status;
}

void cp_sample_destroy(cp_sample *sample)
{
    free(sample->value);
    free(sample->cluster);
    *sample = (cp_sample){0};
}

size_t cp_sample_informative(const cp_sample *sample)
{
    // Without memory 0, which means all of them.
    size_t informative = 0;
    unsigned char *seen = calloc(sample->cluster_count + 1, 1);
    for (size_t k = 0; seen && k < sample->count; k++) {
        informative += !seen[sample->cluster[k]];
        seen[sample->cluster[k]] = 1;
    }
    free(seen);
    return informative;
}

size_t cp_sample_censored(const cp_sample *sample)
{
    size_t censored = 0;
    while (censored < sample->count && isinf(sample->value[censored]))
        censored++;
    return censored;
}

bool cp_sample_too_few(const cp_sample *sample)
{
    if (sample->count < CP_SAMPLE_OBSERVATIONS_MIN)
        return true;
    // So few clusters are found by looking for each of them.
    size_t found[CP_SAMPLE_CLUSTERS_MIN], there = 0;
    for (size_t k = 0; k < sample->count && there < CP_SAMPLE_CLUSTERS_MIN; k++) {
        bool known = false;
        for (size_t f = 0; f < there; f++)
            known |= found[f] == sample->cluster[k];
        if (!known)
            found[there++] = sample->cluster[k];
    }
    return there < CP_SAMPLE_CLUSTERS_MIN;
}

size_t cp_sample_weighted_count(const cp_sample *sample, const unsigned *weight)
{
    size_t total = 0;
    for (size_t k = 0; k < sample->count; k++)
        total += weight_of(sample, weight, k);
    return total;
}

double cp_sample_mean(const cp_sample *sample, const unsigned *weight)
{
    double sum = 0.0;
    size_t total = 0;
    for (size_t k = cp_sample_censored(sample); k < sample->count; k++) {
        unsigned times = weight_of(sample, weight, k);
        sum += times * sample->value[k];
        total += times;
    }
    return total ? sum / (double)total : NAN;
}

double cp_sample_quantile(const cp_sample *sample, const unsigned *weight, double p)
{
    size_t total = cp_sample_weighted_count(sample, weight);
    if (total == 0)
        return NAN;
    double place = p * (double)(total - 1);
    size_t lower = (size_t)floor(place);
    double share = place - (double)lower;

    // Walk to the observation that covers rank lower (from 0), then on to the one of lower + 1.
    size_t passed = 0, k = 0;
    while (passed + weight_of(sample, weight, k) <= lower)
        passed += weight_of(sample, weight, k++);
    double low = sample->value[k];
    // Below lies no value to interpolate from: the quantile is censored too.
    if (share <= 0.0 || isinf(low))
        return low;
    while (passed + weight_of(sample, weight, k) <= lower + 1)
        passed += weight_of(sample, weight, k++);
    return low + share * (sample->value[k] - low);
}

double cp_sample_cliffs_delta(const cp_sample *a, const unsigned *weight_a, const cp_sample *b,
                              const unsigned *weight_b)
{
    double total_a = (double)cp_sample_weighted_count(a, weight_a);
    double total_b = (double)cp_sample_weighted_count(b, weight_b);
    if (total_a <= 0.0 || total_b <= 0.0)
        return NAN;

    // For each b, values of a below it minus values of a above it, both orders walked once.
    double below = 0.0, not_above = 0.0, sum = 0.0;
    size_t i = 0, j = 0;
    for (size_t k = 0; k < b->count; k++) {
        for (; i < a->count && a->value[i] < b->value[k]; i++)
            below += weight_of(a, weight_a, i);
        for (; j < a->count && a->value[j] <= b->value[k]; j++)
            not_above += weight_of(a, weight_a, j);
        sum += weight_of(b, weight_b, k) * (below - (total_a - not_above));
    }
    return sum / (total_a * total_b);
}
