/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/superiority.h"

#include <gsl/gsl_cdf.h>

#include <math.h>
#include <stdlib.h>

/* What one cluster contributes. */
typedef struct contribution {
    double size; /* observations */
    double wins; /* pairs of one of its observations with one of the other sample's in its stratum
                    in which b is higher, ties half */
    double own;  /* of these with its partner's observations, when paired */
} contribution;

typedef struct stratum_sum {
    double size[2];
    double wins;
    double passed[2]; /* of a walk */
    double tied[2];
} stratum_sum;

typedef struct work {
    const cp_sample *sample[2];
    const cp_resampling *resampling;
    bool paired; /* a pair of clusters is left out together */
    size_t strata;
    stratum_sum *stratum;
    contribution *cluster[2];
    double weight_sum; /* of the strata that have both */
    double delta_sum;
    double *left_out; /* delta without each cluster of one group */
} work;

static size_t stratum_of(const work *w, int group, size_t cluster)
{
    const size_t *stratum = w->resampling->stratum[group];
    return stratum ? stratum[cluster] : 0;
}

static void destroy(work *w)
{
    free(w->stratum);
    free(w->cluster[0]);
    free(w->cluster[1]);
    free(w->left_out);
}

static cp_status create(const cp_sample *a, const cp_sample *b, const cp_resampling *resampling,
                        work *w, cp_error *error)
{
    *w = (work){
        .sample = {a, b}, .resampling = resampling, .paired = resampling->paired, .strata = 1};
    for (int g = 0; g < 2; g++)
        for (size_t c = 0; c < w->sample[g]->cluster_count; c++)
            w->strata = stratum_of(w, g, c) >= w->strata ? stratum_of(w, g, c) + 1 : w->strata;
    size_t most = a->cluster_count > b->cluster_count ? a->cluster_count : b->cluster_count;
    w->stratum = calloc(w->strata, sizeof *w->stratum);
    w->left_out = calloc(most + 1, sizeof *w->left_out);
    for (int g = 0; g < 2; g++)
        w->cluster[g] = calloc(w->sample[g]->cluster_count + 1, sizeof *w->cluster[g]);
    return w->stratum && w->left_out && w->cluster[0] && w->cluster[1]
               ? CP_OK
               : cp_fail_memory(error, "a comparison of two samples");
}

// One walk up the values of both samples; ties move together and count half.
static void count_wins(work *w)
{
    for (int g = 0; g < 2; g++) {
        for (size_t k = 0; k < w->sample[g]->count; k++) {
            size_t c = w->sample[g]->cluster[k];
            w->cluster[g][c].size++;
            w->stratum[stratum_of(w, g, c)].size[g]++;
        }
    }
    size_t at[2] = {0, 0};
    while (at[0] < w->sample[0]->count || at[1] < w->sample[1]->count) {
        double value = INFINITY;
        for (int g = 0; g < 2; g++)
            if (at[g] < w->sample[g]->count)
                value = fmin(value, w->sample[g]->value[at[g]]);
        size_t end[2];
        for (int g = 0; g < 2; g++) {
            for (end[g] = at[g];
                 end[g] < w->sample[g]->count && w->sample[g]->value[end[g]] == value; end[g]++)
                w->stratum[stratum_of(w, g, w->sample[g]->cluster[end[g]])].tied[g]++;
        }
        for (int g = 0; g < 2; g++) {
            for (size_t k = at[g]; k < end[g]; k++) {
                size_t c = w->sample[g]->cluster[k];
                stratum_sum *s = &w->stratum[stratum_of(w, g, c)];
                double wins = g ? s->passed[0] + 0.5 * s->tied[0]
                                : s->size[1] - s->passed[1] - 0.5 * s->tied[1];
                w->cluster[g][c].wins += wins;
                s->wins += g ? wins : 0.0;
            }
        }
        for (int g = 0; g < 2; g++) {
            for (; at[g] < end[g]; at[g]++) {
                stratum_sum *s = &w->stratum[stratum_of(w, g, w->sample[g]->cluster[at[g]])];
                s->passed[g]++;
                s->tied[g] = 0.0;
            }
        }
    }
}

// Wins within each pair of clusters: what leaving both out would subtract twice.
static cp_status count_own_wins(work *w, cp_error *error)
{
    size_t count = w->sample[0]->count, clusters = w->sample[0]->cluster_count;
    size_t *first = calloc(clusters + 2, sizeof *first);
    double *value = calloc(count + 1, sizeof *value);
    if (!first || !value) {
        free(first);
        free(value);
        return cp_fail_memory(error, "a comparison of two samples");
    }
    // The values of a, cluster by cluster: first[c + 1] runs up to where cluster c + 1 begins.
    for (size_t k = 0; k < count; k++)
        first[w->sample[0]->cluster[k] + 2]++;
    for (size_t c = 0; c < clusters; c++)
        first[c + 2] += first[c + 1];
    for (size_t k = 0; k < count; k++)
        value[first[w->sample[0]->cluster[k] + 1]++] = w->sample[0]->value[k];
    for (size_t k = 0; k < w->sample[1]->count; k++) {
        size_t c = w->sample[1]->cluster[k];
        double of_b = w->sample[1]->value[k];
        for (size_t j = first[c]; j < first[c + 1]; j++)
            w->cluster[0][c].own += of_b > value[j] ? 1.0 : of_b == value[j] ? 0.5 : 0.0;
    }
    free(first);
    free(value);
    return CP_OK;
}

static double weight_of(double a, double b)
{
    return a > 0.0 && b > 0.0 ? a * b / (a + b) : 0.0;
}

// Weighted delta of a stratum: 2 U / (n_a n_b) - 1 times its weight.
static double weighted_delta(double a, double b, double wins)
{
    return a > 0.0 && b > 0.0 ? weight_of(a, b) * (2.0 * wins / (a * b) - 1.0) : 0.0;
}

// Delta of all strata without cluster c of a group, or without the pair c.
static double delta_without(const work *w, int group, size_t c)
{
    const stratum_sum *s = &w->stratum[stratum_of(w, group, c)];
    double size[2] = {s->size[0], s->size[1]}, wins = s->wins;
    for (int g = 0; g < 2; g++) {
        if (g != group && !w->paired)
            continue;
        size[g] -= w->cluster[g][c].size;
        wins -= w->cluster[g][c].wins;
    }
    wins += w->paired ? w->cluster[0][c].own : 0.0;
    double weight = w->weight_sum - weight_of(s->size[0], s->size[1]) + weight_of(size[0], size[1]);
    double delta = w->delta_sum - weighted_delta(s->size[0], s->size[1], s->wins) +
                   weighted_delta(size[0], size[1], wins);
    return weight > 1e-9 ? delta / weight : NAN;
}

// Variance of delta by leaving out each cluster of a group in turn. Strata of one cluster are one.
static double jackknife(const work *w, int group)
{
    double variance = 0.0, lone_sum = 0.0, lone_squares = 0.0, lone = 0.0;
    size_t clusters = w->sample[group]->cluster_count;
    for (size_t c = 0; c < clusters; c++)
        w->left_out[c] = delta_without(w, group, c);
    for (size_t s = 0; s < w->strata; s++) {
        double count = 0.0, sum = 0.0, squares = 0.0;
        for (size_t c = 0; c < clusters; c++) {
            if (stratum_of(w, group, c) != s)
                continue;
            count++;
            sum += w->left_out[c];
        }
        for (size_t c = 0; c < clusters; c++)
            if (stratum_of(w, group, c) == s)
                squares += (w->left_out[c] - sum / count) * (w->left_out[c] - sum / count);
        if (count == 1.0) {
            lone++;
            lone_sum += sum;
            lone_squares += sum * sum;
        } else if (count > 1.0) {
            variance += (count - 1.0) / count * squares;
        }
    }
    if (lone > 1.0)
        variance += (lone - 1.0) / lone * fmax(0.0, lone_squares - lone_sum * lone_sum / lone);
    return variance;
}

// Kish's effective number of clusters of a group, less one a stratum; strata of one are one.
static double effective_freedom(const work *w, int group)
{
    double freedom = 0.0, lone = 0.0, lone_squares = 0.0;
    for (size_t s = 0; s < w->strata; s++) {
        double count = 0.0, squares = 0.0, total = w->stratum[s].size[group];
        for (size_t c = 0; c < w->sample[group]->cluster_count; c++) {
            if (stratum_of(w, group, c) != s)
                continue;
            count++;
            squares += w->cluster[group][c].size * w->cluster[group][c].size;
        }
        if (squares <= 0.0)
            continue;
        if (count > 1.0) {
            freedom += total * total / squares - 1.0;
        } else {
            lone += total;
            lone_squares += squares;
        }
    }
    if (lone_squares > 0.0)
        freedom += lone * lone / lone_squares - 1.0;
    return fmax(freedom, 1.0);
}

static double clusters_there(const work *w, int group, size_t stratum)
{
    double there = 0.0;
    for (size_t c = 0; c < w->sample[group]->cluster_count; c++)
        there += stratum_of(w, group, c) == stratum && w->cluster[group][c].size > 0.0;
    return there;
}

// How likely complete separation is at most, without any difference.
static double separation_bound(const work *w)
{
    double log_p = log(2.0);
    for (size_t s = 0; s < w->strata && !w->paired; s++) {
        double a = clusters_there(w, 0, s), b = clusters_there(w, 1, s);
        if (a > 0.0 && b > 0.0)
            log_p -= lgamma(a + b + 1.0) - lgamma(a + 1.0) - lgamma(b + 1.0);
    }
    for (size_t c = 0; w->paired && c < w->sample[0]->cluster_count; c++)
        if (w->cluster[0][c].size > 0.0 && w->cluster[1][c].size > 0.0)
            log_p -= log(2.0);
    return fmin(1.0, exp(log_p));
}

// Standard error and degrees of freedom; then test and interval.
static void infer(work *w, cp_superiority *result)
{
    if (cp_sample_too_few(w->sample[0]) || cp_sample_too_few(w->sample[1]))
        return;
    result->status = CP_INTERVAL_VALUE;
    bool paired = w->paired;
    double both = paired ? jackknife(w, 0) : NAN;
    double part[2], freedom[2] = {effective_freedom(w, 0), effective_freedom(w, 1)};
    w->paired = false;
    for (int g = 0; g < 2; g++)
        part[g] = jackknife(w, g);
    w->paired = paired;
    double sum = part[0] + part[1], variance = paired ? both : sum;
    result->standard_error = sqrt(variance);
    result->freedom = sum * sum / (part[0] * part[0] / freedom[0] + part[1] * part[1] / freedom[1]);
    // Pairs that are left out together cannot show more than they are.
    if (paired)
        result->freedom = fmin(result->freedom, fmin(freedom[0], freedom[1]));
    if (!(variance > 1e-24) || !isfinite(result->freedom)) {
        result->status = result->interval.status = CP_INTERVAL_ALL_ALIKE;
        if (fabs(result->cliffs_delta) > 1.0 - 1e-12)
            result->p = separation_bound(w);
        return;
    }
    double delta = result->cliffs_delta, se = result->standard_error;
    double t = gsl_cdf_tdist_Pinv(0.5 * (1.0 + w->resampling->level_1), result->freedom);
    result->p = 2.0 * gsl_cdf_tdist_Q(fabs(delta) / se, result->freedom);
    result->interval =
        (cp_interval){CP_INTERVAL_VALUE, fmax(-1.0, delta - t * se), fmin(1.0, delta + t * se)};
}

cp_status cp_superiority_of(const cp_sample *a, const cp_sample *b, const cp_resampling *resampling,
                            cp_superiority *superiority, cp_error *error)
{
    *superiority = (cp_superiority){.cliffs_delta = NAN,
                                    .standard_error = NAN,
                                    .freedom = NAN,
                                    .status = CP_INTERVAL_TOO_FEW_CRASHES,
                                    .p = NAN,
                                    .interval = {CP_INTERVAL_TOO_FEW_CRASHES, NAN, NAN}};
    work w;
    cp_status status = create(a, b, resampling, &w, error);
    if (status == CP_OK) {
        count_wins(&w);
        if (resampling->paired)
            status = count_own_wins(&w, error);
    }
    if (status == CP_OK) {
        for (size_t s = 0; s < w.strata; s++) {
            const stratum_sum *x = &w.stratum[s];
            w.weight_sum += weight_of(x->size[0], x->size[1]);
            w.delta_sum += weighted_delta(x->size[0], x->size[1], x->wins);
        }
        if (w.weight_sum > 0.0) {
            superiority->cliffs_delta = w.delta_sum / w.weight_sum;
            infer(&w, superiority);
        }
    }
    destroy(&w);
    return status;
}
