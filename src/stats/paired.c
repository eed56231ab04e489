/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/paired.h"

#include "core/rng.h"

#include <gsl/gsl_sort.h>

#include <math.h>
#include <stdlib.h>

static double times(const cp_sample *sample, const unsigned *weight, size_t k)
{
    return weight ? weight[sample->cluster[k]] : 1.0;
}

// Walsh averages <= bound: of all ordered pairs half, and half of each value with itself. As j
// falls, the i that fit move up.
static double walsh_up_to(const cp_sample *sample, const unsigned *weight, double bound)
{
    double ordered = 0.0, itself = 0.0, fitting = 0.0;
    size_t i = 0;
    for (size_t j = sample->count; j-- > 0;) {
        for (; i < sample->count && 0.5 * (sample->value[i] + sample->value[j]) <= bound; i++)
            fitting += times(sample, weight, i);
        ordered += times(sample, weight, j) * fitting;
        itself += sample->value[j] <= bound ? times(sample, weight, j) : 0.0;
    }
    return 0.5 * (ordered + itself);
}

// The smallest Walsh average above bound.
static double walsh_after(const cp_sample *sample, const unsigned *weight, double bound)
{
    double smallest = INFINITY;
    size_t i = 0;
    for (size_t j = sample->count; j-- > 0;) {
        while (i < sample->count && 0.5 * (sample->value[i] + sample->value[j]) <= bound)
            i++;
        if (times(sample, weight, j) <= 0.0)
            continue;
        size_t drawn = i;
        while (drawn < sample->count && times(sample, weight, drawn) <= 0.0)
            drawn++;
        if (drawn < sample->count)
            smallest = fmin(smallest, 0.5 * (sample->value[drawn] + sample->value[j]));
    }
    return smallest;
}

double cp_paired_hodges_lehmann(const cp_sample *sample, const unsigned *weight)
{
    double total = (double)cp_sample_weighted_count(sample, weight);
    if (total <= 0.0)
        return NAN;

    // The smallest number with at least `rank` averages up to it is one of them: bisect down to
    // neighbouring doubles. low never has enough, high always.
    double averages = 0.5 * total * (total + 1.0), rank = floor(0.5 * (averages + 1.0));
    double low = nextafter(sample->value[0], -INFINITY), high = sample->value[sample->count - 1];
    for (;;) {
        double middle = 0.5 * low + 0.5 * high;
        if (!(middle > low && middle < high))
            break;
        if (walsh_up_to(sample, weight, middle) >= rank)
            high = middle;
        else
            low = middle;
    }
    // An even number of averages has two in the middle.
    double next = high;
    if (floor(0.5 * averages) + 1.0 > walsh_up_to(sample, weight, high))
        next = walsh_after(sample, weight, high);
    return 0.5 * (high + next);
}

static void paired_statistics(const unsigned *weight_a, const unsigned *weight_b,
                              const void *context, double *value)
{
    (void)weight_b;
    value[0] = cp_sample_mean(context, weight_a);
    value[1] = cp_paired_hodges_lehmann(context, weight_a);
}

// Ranks of |d| with their signs, summed over each cluster; zeros have no rank, ties share one.
static cp_status rank_sums(const cp_sample *sample, double *cluster_sum, double *v, cp_error *error)
{
    size_t count = 0;
    double *size = calloc(sample->count + 1, sizeof *size);
    size_t *order = calloc(sample->count + 1, sizeof *order);
    size_t *origin = calloc(sample->count + 1, sizeof *origin);
    cp_status status = CP_OK;
    if (!size || !order || !origin) {
        status = cp_fail_memory(error, "signed ranks");
        goto done;
    }
    for (size_t k = 0; k < sample->count; k++) {
        if (sample->value[k] != 0.0) {
            size[count] = fabs(sample->value[k]);
            origin[count++] = k;
        }
    }
    gsl_sort_index(order, size, 1, count);
    for (size_t begin = 0, end; begin < count; begin = end) {
        for (end = begin; end < count && size[order[end]] == size[order[begin]]; end++)
            ;
        double rank = 0.5 * (double)(begin + end + 1);
        for (size_t place = begin; place < end; place++) {
            size_t k = origin[order[place]];
            cluster_sum[sample->cluster[k]] += sample->value[k] > 0.0 ? rank : -rank;
            *v += sample->value[k] > 0.0 ? rank : 0.0;
        }
    }

done:
    free(origin);
    free(order);
    free(size);
    return status;
}

// Without any effect a replication's differences could as well have had the other sign.
static cp_status signed_rank(const cp_sample *sample, uint64_t seed, size_t permutations,
                             cp_permutation_test *test, cp_error *error)
{
    *test = (cp_permutation_test){NAN, NAN};
    double *cluster_sum = calloc(sample->cluster_count + 1, sizeof *cluster_sum);
    if (!cluster_sum)
        return cp_fail_memory(error, "signed ranks");
    double v = 0.0, observed = 0.0, scale = 0.0, extreme = 0.0;
    cp_status status = rank_sums(sample, cluster_sum, &v, error);
    for (size_t c = 0; c < sample->cluster_count; c++) {
        observed += cluster_sum[c];
        scale += fabs(cluster_sum[c]);
    }
    if (status == CP_OK && sample->count > 0)
        test->statistic = v;
    cp_rng_key base = cp_rng_key_text(cp_rng_key_seed(seed), "sign flip");
    for (size_t number = 1; status == CP_OK && number <= permutations; number++) {
        cp_rng_key key = cp_rng_key_number(base, number);
        double flipped = 0.0;
        for (size_t c = 0; c < sample->cluster_count; c++)
            flipped += cp_rng_uniform(key, c) < 0.5 ? -cluster_sum[c] : cluster_sum[c];
        extreme += fabs(flipped) >= fabs(observed) - 1e-12 * scale;
    }
    if (status == CP_OK && sample->count > 0 && permutations > 0)
        test->p = (1.0 + extreme) / (1.0 + (double)permutations);
    free(cluster_sum);
    return status;
}

cp_status cp_paired_compare(const cp_sample *differences, const cp_resampling *resampling,
                            size_t permutations, cp_paired *paired, cp_error *error)
{
    *paired = (cp_paired){
        .count = differences->count,
        .mean = cp_sample_mean(differences, NULL),
        .hodges_lehmann = cp_paired_hodges_lehmann(differences, NULL),
    };
    for (size_t k = 0; k < differences->count; k++) {
        paired->lower += differences->value[k] < 0.0;
        paired->higher += differences->value[k] > 0.0;
    }
    if (cp_sample_too_few(differences)) {
        paired->mean_interval = paired->hodges_lehmann_interval =
            (cp_interval){CP_INTERVAL_TOO_FEW_CRASHES, NAN, NAN};
        return signed_rank(differences, resampling->seed, 0, &paired->signed_rank, error);
    }
    cp_resampling informed = *resampling;
    informed.informative[0] = cp_sample_informative(differences);
    cp_interval interval[2];
    cp_status status =
        cp_bootstrap_many(&informed, paired_statistics, 2, differences, interval, error);
    if (status != CP_OK)
        return status;
    paired->mean_interval = interval[0];
    paired->hodges_lehmann_interval = interval[1];
    return signed_rank(differences, resampling->seed, permutations, &paired->signed_rank, error);
}
