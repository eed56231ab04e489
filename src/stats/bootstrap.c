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
    return (cp_resampling){.repetitions = 2000, .seed = 1, .level_1 = 0.95, .expanded = true};
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

/* Resamples that give the estimate again; with more of them their quantiles are not to be trusted.
 */
#define ALIKE_SHARE 0.5

/* Everything the intervals need; group 1 shares group 0's weights when paired. */
typedef struct plan {
    const cp_resampling *resampling;
    cp_statistics statistics;
    size_t count; /* statistics */
    const void *context;
    strata group[2];
    unsigned *weight[2];
    size_t group_count; /* groups that are drawn of their own */
    double *estimate;   /* of each statistic */
    double *resampled;  /* repetitions of the first statistic, then of the next */
    double *left_out;   /* of each statistic: values without cluster 0, 1, ... of all groups */
    double *value;      /* what one evaluation gives */
} plan;

static void plan_destroy(plan *p)
{
    for (size_t g = 0; g < 2; g++) {
        strata_destroy(&p->group[g]);
        free(p->weight[g]);
    }
    free(p->estimate);
    free(p->resampled);
    free(p->left_out);
    free(p->value);
}

static cp_status plan_create(const cp_resampling *resampling, cp_statistics statistics,
                             size_t count, const void *context, plan *p, cp_error *error)
{
    const size_t *clusters = resampling->cluster_count;
    *p = (plan){.resampling = resampling,
                .statistics = statistics,
                .count = count,
                .context = context,
                .group_count = clusters[1] && !resampling->paired ? 2 : 1};
    p->estimate = calloc(count + 1, sizeof *p->estimate);
    p->value = calloc(count + 1, sizeof *p->value);
    p->resampled = calloc(count * (resampling->repetitions + 1), sizeof *p->resampled);
    p->left_out = calloc(count * (clusters[0] + clusters[1] + 1), sizeof *p->left_out);
    for (size_t g = 0; g < 2; g++)
        p->weight[g] = calloc(clusters[g] + 1, sizeof *p->weight[g]);
    if (!p->estimate || !p->value || !p->resampled || !p->left_out || !p->weight[0] ||
        !p->weight[1])
        return cp_fail_memory(error, "bootstrap");
    for (size_t g = 0; g < 2; g++) {
        cp_status status = strata_create(clusters[g], resampling->stratum[g], &p->group[g], error);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

static const unsigned *weight_of_second(const plan *p)
{
    const cp_resampling *r = p->resampling;
    return r->paired ? p->weight[0] : r->cluster_count[1] ? p->weight[1] : NULL;
}

static void evaluate(plan *p, double *value)
{
    p->statistics(p->weight[0], weight_of_second(p), p->context, value);
}

static void weights_to_one(plan *p)
{
    for (size_t g = 0; g < 2; g++)
        for (size_t k = 0; k < p->group[g].count; k++)
            p->weight[g][k] = 1;
}

// Every statistic with each cluster left out in turn, in the order of the strata's places.
static void jackknife(plan *p)
{
    size_t clusters = p->resampling->cluster_count[0] + p->resampling->cluster_count[1];
    size_t before = 0;
    weights_to_one(p);
    for (size_t g = 0; g < p->group_count; g++) {
        for (size_t place = 0; place < p->group[g].count; place++) {
            p->weight[g][p->group[g].member[place]] = 0;
            evaluate(p, p->value);
            p->weight[g][p->group[g].member[place]] = 1;
            for (size_t s = 0; s < p->count; s++)
                p->left_out[s * clusters + before + place] = p->value[s];
        }
        before += p->group[g].count;
    }
}

// Repetition r of group g has its own key, so neither order nor number of groups matters.
static void draw_groups(plan *p, cp_rng_key seed, size_t r)
{
    for (size_t g = 0; g < p->group_count; g++)
        draw(&p->group[g], cp_rng_key_number(cp_rng_key_number(seed, r), g), p->weight[g]);
}

static void resample(plan *p)
{
    cp_rng_key seed = cp_rng_key_text(cp_rng_key_seed(p->resampling->seed), "bootstrap");
    for (size_t r = 0; r < p->resampling->repetitions; r++) {
        draw_groups(p, seed, r);
        evaluate(p, p->value);
        for (size_t s = 0; s < p->count; s++)
            p->resampled[s * p->resampling->repetitions + r] = p->value[s];
    }
}

// Acceleration of a statistic from the jackknife, strata weighted as in Davison and Hinkley 1997,
// eq. 5.24: sum of l^3/n^3 over 6 (sum of l^2/n^2)^1.5 with l = (n - 1)(mean - value left out).
static double acceleration(const plan *p, size_t statistic)
{
    size_t clusters = p->resampling->cluster_count[0] + p->resampling->cluster_count[1];
    const double *left_out = p->left_out + statistic * clusters;
    double squares = 0.0, cubes = 0.0;
    for (size_t g = 0; g < p->group_count; g++) {
        const strata *s = &p->group[g];
        for (size_t place = 0; place < s->count; place++) {
            if (!isfinite(left_out[place]))
                return 0.0; // an open or missing value has no influence to measure
            double mean = 0.0, n = (double)s->size[place];
            for (size_t other = 0; other < s->size[place]; other++)
                mean += left_out[s->first[place] + other] / n;
            double influence = (n - 1.0) * (mean - left_out[place]) / n;
            squares += influence * influence;
            cubes += influence * influence * influence;
        }
        left_out += s->count;
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

static double degrees_of_freedom(const strata *s)
{
    size_t count = 0;
    for (size_t place = 0; place < s->count; place++)
        count += s->first[place] == place;
    return (double)(s->count - count);
}

// How many standard errors the interval reaches to either side: the normal quantile, for few
// clusters that of t and the factor by which resampled variances are too small.
static double reach(const plan *p)
{
    double tail = 0.5 * (1.0 + p->resampling->level_1);
    if (!p->resampling->expanded)
        return gsl_cdf_ugaussian_Pinv(tail);
    double fewest = INFINITY, freedom = INFINITY;
    for (size_t g = 0; g < p->group_count; g++) {
        double own = degrees_of_freedom(&p->group[g]), count = (double)p->group[g].count;
        double informative = (double)p->resampling->informative[g];
        // Pairs are drawn together: the group with fewer that say anything is what counts.
        double other = (double)p->resampling->informative[1];
        if (p->resampling->paired && other > 0.0 && other < informative)
            informative = other;
        if (informative > 0.0 && informative < count) {
            own = fmax(1.0, own - (count - informative));
            count = informative;
        }
        if (own < freedom) {
            fewest = count;
            freedom = own;
        }
    }
    return freedom >= 1.0 ? sqrt(fewest / freedom) * gsl_cdf_tdist_Pinv(tail, freedom) : INFINITY;
}

// BCa's bend of a normal quantile; past its pole all of the resamples lie on one side.
static double bent(double z0, double z, double a)
{
    double scale = 1.0 - a * z;
    return scale > 0.0 ? z0 + z / scale : z * INFINITY;
}

static cp_interval bca(const plan *p, size_t statistic)
{
    const cp_interval undefined = {CP_INTERVAL_UNDEFINED, NAN, NAN};
    double estimate = p->estimate[statistic];
    double *resampled = p->resampled + statistic * p->resampling->repetitions;
    size_t count = 0;
    for (size_t r = 0; r < p->resampling->repetitions; r++)
        if (!isnan(resampled[r]))
            resampled[count++] = resampled[r];
    if (!isfinite(estimate) || count == 0 ||
        (double)count < 0.95 * (double)p->resampling->repetitions)
        return undefined;

    // Bias correction: where the estimate stands among the resamples, ties counted half.
    double below = 0.0, same = 0.0, rounding = 1e-9 * fabs(estimate);
    for (size_t k = 0; k < count; k++) {
        below += resampled[k] < estimate ? 1.0 : resampled[k] == estimate ? 0.5 : 0.0;
        same += fabs(resampled[k] - estimate) <= rounding;
    }
    if (same > ALIKE_SHARE * (double)count)
        return (cp_interval){CP_INTERVAL_ALL_ALIKE, NAN, NAN};
    double share = below / (double)count;
    if (!(share > 0.0 && share < 1.0))
        return undefined;
    double z0 = gsl_cdf_ugaussian_Pinv(share), a = acceleration(p, statistic), z = reach(p);

    gsl_sort(resampled, 1, count);
    double low = gsl_cdf_ugaussian_P(bent(z0, z0 - z, a));
    double high = gsl_cdf_ugaussian_P(bent(z0, z0 + z, a));
    return (cp_interval){CP_INTERVAL_VALUE, bound(resampled, count, low),
                         bound(resampled, count, high)};
}

cp_interval_status cp_bootstrap_allowed(const cp_resampling *resampling)
{
    for (size_t g = 0; g < 2; g++) {
        size_t count = resampling->cluster_count[g];
        if (g == 1 && count == 0)
            continue;
        if (count < CP_BOOTSTRAP_CLUSTERS_MIN)
            return CP_INTERVAL_TOO_FEW_REPLICATIONS;
        // Clusters that are alone in their stratum come into every resample once. Strata stand
        // together as a rule, so the neighbour tells at once.
        const size_t *stratum = resampling->stratum[g];
        for (size_t k = 0; stratum && k < count; k++) {
            bool alone = (k == 0 || stratum[k - 1] != stratum[k]) &&
                         (k + 1 == count || stratum[k + 1] != stratum[k]);
            for (size_t other = 0; alone && other < count; other++)
                alone = other == k || stratum[other] != stratum[k];
            if (alone)
                return CP_INTERVAL_TOO_FEW_REPLICATIONS;
        }
    }
    return CP_INTERVAL_VALUE;
}

cp_status cp_bootstrap_many(const cp_resampling *resampling, cp_statistics statistics, size_t count,
                            const void *context, cp_interval *interval, cp_error *error)
{
    cp_interval_status allowed = cp_bootstrap_allowed(resampling);
    for (size_t s = 0; s < count; s++)
        interval[s] = (cp_interval){allowed, NAN, NAN};
    if (allowed != CP_INTERVAL_VALUE)
        return CP_OK;

    plan p;
    cp_status status = plan_create(resampling, statistics, count, context, &p, error);
    if (status == CP_OK) {
        weights_to_one(&p);
        evaluate(&p, p.estimate);
        jackknife(&p);
        resample(&p);
        for (size_t s = 0; s < count; s++)
            interval[s] = bca(&p, s);
    }
    plan_destroy(&p);
    return status;
}

/* One statistic as a list of one. */
typedef struct single {
    cp_statistic statistic;
    const void *context;
} single;

static void evaluate_single(const unsigned *weight_a, const unsigned *weight_b, const void *context,
                            double *value)
{
    const single *one = context;
    *value = one->statistic(weight_a, weight_b, one->context);
}

cp_status cp_bootstrap(const cp_resampling *resampling, cp_statistic statistic, const void *context,
                       cp_interval *interval, cp_error *error)
{
    const single one = {statistic, context};
    return cp_bootstrap_many(resampling, evaluate_single, 1, &one, interval, error);
}

cp_status cp_bootstrap_draws(const cp_resampling *resampling, cp_draw draw_done, void *context,
                             double *scale, cp_error *error)
{
    plan p;
    cp_status status = plan_create(resampling, NULL, 0, NULL, &p, error);
    cp_rng_key seed = cp_rng_key_text(cp_rng_key_seed(resampling->seed), "bootstrap");
    for (size_t r = 0; status == CP_OK && r < resampling->repetitions; r++) {
        draw_groups(&p, seed, r);
        draw_done(context, p.weight[0], weight_of_second(&p));
    }
    if (status == CP_OK && scale) {
        *scale = 1.0;
        for (size_t g = 0; g < p.group_count; g++) {
            double freedom = degrees_of_freedom(&p.group[g]);
            *scale =
                fmax(*scale, freedom >= 1.0 ? sqrt((double)p.group[g].count / freedom) : INFINITY);
        }
    }
    plan_destroy(&p);
    return status;
}
