/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/pooled.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

void cp_pooled_destroy(cp_pooled *pooled)
{
    free(pooled->value);
    free(pooled->cluster);
    free(pooled->group);
    free(pooled->sum);
    free(pooled->finite);
    free(pooled->size);
    *pooled = (cp_pooled){0};
}

cp_status cp_pooled_create(const cp_sample *a, const cp_sample *b, cp_pooled *pooled,
                           cp_error *error)
{
    size_t count = a->count + b->count, clusters = a->cluster_count + b->cluster_count;
    *pooled = (cp_pooled){.sample = {a, b}, .count = count};
    pooled->value = calloc(count + 1, sizeof *pooled->value);
    pooled->cluster = calloc(count + 1, sizeof *pooled->cluster);
    pooled->group = calloc(count + 1, sizeof *pooled->group);
    pooled->sum = calloc(clusters + 1, sizeof *pooled->sum);
    pooled->finite = calloc(clusters + 1, sizeof *pooled->finite);
    pooled->size = calloc(clusters + 1, sizeof *pooled->size);
    if (!pooled->value || !pooled->cluster || !pooled->group || !pooled->sum || !pooled->finite ||
        !pooled->size) {
        cp_pooled_destroy(pooled);
        return cp_fail_memory(error, "two samples");
    }

    // Merge the two sorted samples.
    for (size_t i = 0, j = 0, k = 0; k < count; k++) {
        bool from_a = j == b->count || (i < a->count && a->value[i] <= b->value[j]);
        pooled->value[k] = from_a ? a->value[i] : b->value[j];
        pooled->cluster[k] = from_a ? a->cluster[i++] : a->cluster_count + b->cluster[j++];
        pooled->group[k] = !from_a;
    }
    for (size_t k = 0; k < count; k++) {
        size_t c = pooled->cluster[k];
        pooled->size[c]++;
        if (isfinite(pooled->value[k])) {
            pooled->sum[c] += pooled->value[k];
            pooled->finite[c]++;
        }
    }
    return CP_OK;
}

/* The two order statistics a quantile lies between (type 7), found while walking up. */
typedef struct picker {
    double lower; /* rank from 0 */
    double share; /* of the way to the next */
    double low;
    double high;
} picker;

static picker picker_for(double total, double p)
{
    double place = p * (total - 1.0), lower = floor(place);
    return (picker){.lower = lower, .share = place - lower, .low = NAN, .high = NAN};
}

// count observations of one value stand behind passed others.
static void pick(picker *p, double passed, double count, double value)
{
    if (p->lower >= passed && p->lower < passed + count)
        p->low = value;
    if (p->lower + 1.0 >= passed && p->lower + 1.0 < passed + count)
        p->high = value;
}

static double picked(const picker *p)
{
    // Below lies no value to interpolate from: the quantile is censored too.
    if (p->share <= 0.0 || isinf(p->low))
        return p->low;
    return p->low + p->share * (p->high - p->low);
}

void cp_pooled_differences(const cp_pooled *pooled, const unsigned *weight_a,
                           const unsigned *weight_b, double difference[CP_POOLED_COUNT])
{
    // Totals and means need the clusters only.
    const unsigned *weight[2] = {weight_a, weight_b};
    double total[2] = {0.0, 0.0}, sum[2] = {0.0, 0.0}, finite[2] = {0.0, 0.0};
    size_t offset[2] = {0, pooled->sample[0]->cluster_count};
    for (size_t g = 0; g < 2; g++) {
        for (size_t c = 0; c < pooled->sample[g]->cluster_count; c++) {
            double times = weight[g] ? weight[g][c] : 1.0;
            total[g] += times * pooled->size[offset[g] + c];
            sum[g] += times * pooled->sum[offset[g] + c];
            finite[g] += times * pooled->finite[offset[g] + c];
        }
    }
    difference[CP_POOLED_MEAN] = sum[1] / finite[1] - sum[0] / finite[0]; // 0 / 0 is NAN

    // Ranks and quantiles in one walk; ties move together, a tie with the other group counts half.
    picker median[2] = {picker_for(total[0], 0.5), picker_for(total[1], 0.5)};
    picker p90[2] = {picker_for(total[0], 0.9), picker_for(total[1], 0.9)};
    double passed[2] = {0.0, 0.0}, u = 0.0;
    for (size_t begin = 0, end; begin < pooled->count; begin = end) {
        double tied[2] = {0.0, 0.0}, value = pooled->value[begin];
        for (end = begin; end < pooled->count && pooled->value[end] == value; end++) {
            unsigned char g = pooled->group[end];
            tied[g] += weight[g] ? weight[g][pooled->cluster[end] - offset[g]] : 1.0;
        }
        u += tied[1] * (passed[0] + 0.5 * tied[0]);
        for (size_t g = 0; g < 2; g++) {
            pick(&median[g], passed[g], tied[g], value);
            pick(&p90[g], passed[g], tied[g], value);
            passed[g] += tied[g];
        }
    }
    // Two censored quantiles: -INFINITY - -INFINITY is NAN, the difference does not exist.
    difference[CP_POOLED_MEDIAN] = picked(&median[1]) - picked(&median[0]);
    difference[CP_POOLED_P90] = picked(&p90[1]) - picked(&p90[0]);
    difference[CP_POOLED_CLIFFS_DELTA] = 2.0 * u / (total[0] * total[1]) - 1.0;
}

cp_pooled_ranks cp_pooled_rank(const cp_pooled *pooled, const unsigned char *label)
{
    double total[2] = {0.0, 0.0};
    size_t clusters = pooled->sample[0]->cluster_count + pooled->sample[1]->cluster_count;
    for (size_t c = 0; c < clusters; c++)
        total[label[c]] += pooled->size[c];
    if (total[0] <= 0.0 || total[1] <= 0.0)
        return (cp_pooled_ranks){NAN, NAN, NAN};

    // Walk up the values; ties move together, a tie with the other group counts half.
    cp_pooled_ranks ranks = {0.0, 0.0, 0.0};
    double passed[2] = {0.0, 0.0};
    for (size_t begin = 0, end; begin < pooled->count; begin = end) {
        double tied[2] = {0.0, 0.0};
        for (end = begin; end < pooled->count && pooled->value[end] == pooled->value[begin]; end++)
            tied[label[pooled->cluster[end]]]++;
        ranks.u += tied[1] * (passed[0] + 0.5 * tied[0]);
        passed[0] += tied[0];
        passed[1] += tied[1];
        ranks.ks = fmax(ranks.ks, fabs(passed[0] / total[0] - passed[1] / total[1]));
    }
    ranks.shift = fabs(ranks.u / (total[0] * total[1]) - 0.5);
    return ranks;
}
