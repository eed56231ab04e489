/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/bootstrap.h"

#include "core/rng.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sort.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Clusters listed stratum by stratum, so that a draw within a stratum is one index into a run. */
typedef struct strata {
    size_t count;   /* clusters */
    size_t *member; /* clusters, ordered by stratum */
    size_t *first;  /* of each place: where its stratum's run begins */
    size_t *size;   /* of each place: clusters of its stratum */
} strata;

const char *cp_interval_status_text(cp_interval_status status)
{
    static const char *const TEXT[] = {
#define CP_INTERVAL_TEXT(name, text) text,
        CP_INTERVAL_STATUSES(CP_INTERVAL_TEXT)
#undef CP_INTERVAL_TEXT
    };
    return TEXT[status];
}

cp_resampling cp_resampling_default(void)
{
    return (cp_resampling){.repetitions = 2000, .seed = 1, .level_1 = 0.95};
}

static void strata_destroy(strata *s)
{
    free(s->member);
    free(s->first);
    free(s->size);
    *s = (strata){0};
}

static cp_status strata_create(size_t count, const size_t *stratum, strata *s, cp_error *error)
{
    *s = (strata){.count = count};
    s->member = calloc(count + 1, sizeof *s->member);
    s->first = calloc(count + 1, sizeof *s->first);
    s->size = calloc(count + 1, sizeof *s->size);
    double *key = calloc(count + 1, sizeof *key);
    if (!s->member || !s->first || !s->size || !key) {
        free(key);
        strata_destroy(s);
        return cp_fail_memory(error, "resampling");
    }
    for (size_t k = 0; k < count; k++)
        key[k] = stratum ? (double)stratum[k] : 0.0;
    gsl_sort_index(s->member, key, 1, count);

    // Each place learns the run of equal strata it stands in.
    for (size_t begin = 0, end; begin < count; begin = end) {
        for (end = begin; end < count && key[s->member[end]] == key[s->member[begin]]; end++)
            ;
        for (size_t place = begin; place < end; place++) {
            s->first[place] = begin;
            s->size[place] = end - begin;
        }
    }
    free(key);
    return CP_OK;
}

// One resample: as many draws within each stratum as it has clusters.
static void draw(const strata *s, cp_rng_key key, unsigned *weight)
{
    memset(weight, 0, s->count * sizeof *weight);
    for (size_t place = 0; place < s->count; place++) {
        size_t drawn = (size_t)(cp_rng_uniform(key, place) * (double)s->size[place]);
        weight[s->member[s->first[place] + drawn]]++;
    }
}

/* Everything one interval needs; group 1 shares group 0's weights when paired. */
typedef struct plan {
    const cp_resampling *resampling;
    cp_statistic statistic;
    const void *context;
    strata group[2];
    unsigned *weight[2];
    size_t group_count; /* groups that are drawn of their own */
} plan;

static double evaluate(const plan *p)
{
    const cp_resampling *r = p->resampling;
    const unsigned *b = r->paired ? p->weight[0] : r->cluster_count[1] ? p->weight[1] : NULL;
    return p->statistic(p->weight[0], b, p->context);
}

static void weights_to_one(plan *p)
{
    for (size_t g = 0; g < 2; g++)
        for (size_t k = 0; k < p->group[g].count; k++)
            p->weight[g][k] = 1;
}

// Acceleration from the jackknife over clusters, strata weighted as in Davison and Hinkley 1997,
// eq. 5.24: sum of l^3/n^3 over 6 (sum of l^2/n^2)^1.5 with l = (n - 1)(mean - value left out).
static double acceleration(plan *p, double *left_out)
{
    double squares = 0.0, cubes = 0.0;
    for (size_t g = 0; g < p->group_count; g++) {
        const strata *s = &p->group[g];
        for (size_t place = 0; place < s->count; place++) {
            weights_to_one(p);
            p->weight[g][s->member[place]] = 0;
            left_out[place] = evaluate(p);
            if (!isfinite(left_out[place]))
                return 0.0; // an open or missing value has no influence to measure
        }
        for (size_t place = 0; place < s->count; place++) {
            double mean = 0.0, n = (double)s->size[place];
            for (size_t other = 0; other < s->size[place]; other++)
                mean += left_out[s->first[place] + other] / n;
            double influence = (n - 1.0) * (mean - left_out[place]) / n;
            squares += influence * influence;
            cubes += influence * influence * influence;
        }
    }
    return squares > 0.0 ? cubes / (6.0 * pow(squares, 1.5)) : 0.0;
}

// The bound of probability alpha: the order statistic nearest to alpha (B + 1).
static double bound(const double *sorted, size_t count, double alpha)
{
    double rank = alpha * (double)(count + 1);
    if (rank < 1.0)
        rank = 1.0;
    if (rank > (double)count)
        rank = (double)count;
    return sorted[(size_t)(rank + 0.5) - 1];
}

static cp_interval bca(plan *p, double *resampled, size_t count, double *left_out, double estimate)
{
    // Bias correction: where the estimate stands among the resamples, ties counted half.
    double below = 0.0;
    for (size_t k = 0; k < count; k++)
        below += resampled[k] < estimate ? 1.0 : resampled[k] == estimate ? 0.5 : 0.0;
    double share = below / (double)count;
    if (!(share > 0.0 && share < 1.0))
        return (cp_interval){CP_INTERVAL_UNDEFINED, NAN, NAN};
    double z0 = gsl_cdf_ugaussian_Pinv(share);
    double a = acceleration(p, left_out);

    gsl_sort(resampled, 1, count);
    double z = gsl_cdf_ugaussian_Pinv(0.5 * (1.0 + p->resampling->level_1));
    double low = z0 + (z0 - z) / (1.0 - a * (z0 - z));
    double high = z0 + (z0 + z) / (1.0 - a * (z0 + z));
    return (cp_interval){CP_INTERVAL_VALUE, bound(resampled, count, gsl_cdf_ugaussian_P(low)),
                         bound(resampled, count, gsl_cdf_ugaussian_P(high))};
}

static cp_interval resample(plan *p, double *resampled, double *left_out)
{
    const cp_interval undefined = {CP_INTERVAL_UNDEFINED, NAN, NAN};
    weights_to_one(p);
    double estimate = evaluate(p);
    if (!isfinite(estimate))
        return undefined;

    // Repetition r of group g has its own key, so neither order nor number of groups matters.
    size_t count = 0;
    cp_rng_key seed = cp_rng_key_text(cp_rng_key_seed(p->resampling->seed), "bootstrap");
    for (size_t r = 0; r < p->resampling->repetitions; r++) {
        for (size_t g = 0; g < p->group_count; g++)
            draw(&p->group[g], cp_rng_key_number(cp_rng_key_number(seed, r), g), p->weight[g]);
        double value = evaluate(p);
        if (!isnan(value))
            resampled[count++] = value;
    }
    if (count == 0 || (double)count < 0.95 * (double)p->resampling->repetitions)
        return undefined;
    return bca(p, resampled, count, left_out, estimate);
}

cp_status cp_bootstrap(const cp_resampling *resampling, cp_statistic statistic, const void *context,
                       cp_interval *interval, cp_error *error)
{
    const size_t *clusters = resampling->cluster_count;
    *interval = (cp_interval){CP_INTERVAL_TOO_FEW_REPLICATIONS, NAN, NAN};
    if (clusters[0] < CP_BOOTSTRAP_CLUSTERS_MIN ||
        (clusters[1] > 0 && clusters[1] < CP_BOOTSTRAP_CLUSTERS_MIN))
        return CP_OK;

    plan p = {.resampling = resampling, .statistic = statistic, .context = context};
    p.group_count = clusters[1] && !resampling->paired ? 2 : 1;
    cp_status status = CP_OK;
    size_t most = clusters[0] > clusters[1] ? clusters[0] : clusters[1];
    double *resampled = calloc(resampling->repetitions + 1, sizeof *resampled);
    double *left_out = calloc(most + 1, sizeof *left_out);
    for (size_t g = 0; g < 2; g++)
        p.weight[g] = calloc(clusters[g] + 1, sizeof *p.weight[g]);
    if (!resampled || !left_out || !p.weight[0] || !p.weight[1]) {
        status = cp_fail_memory(error, "bootstrap");
        goto done;
    }
    for (size_t g = 0; g < 2 && status == CP_OK; g++)
        status = strata_create(clusters[g], resampling->stratum[g], &p.group[g], error);
    if (status == CP_OK)
        *interval = resample(&p, resampled, left_out);

done:
    strata_destroy(&p.group[0]);
    strata_destroy(&p.group[1]);
    free(p.weight[0]);
    free(p.weight[1]);
    free(left_out);
    free(resampled);
    return status;
}
