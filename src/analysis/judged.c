/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/judged.h"

#include "analysis/exceedance_figures.h"

#include <math.h>
#include <stdlib.h>

/* What is gathered before the samples are made: a row a crash of the study, a column a variant of
 * the study. */
typedef struct table {
    const cp_study_data *data;
    size_t baseline;
    double *severity[CP_EXCEEDED_COUNT]; /* NAN: not judged */
    unsigned char *avoided;              /* the same cells */
    unsigned char *seen;                 /* of each variant: has pairs in the slice */
    size_t *crash;                       /* of the slice */
    size_t *cluster;                     /* of each of these */
    size_t count;
    double *events; /* room for the replications */
} table;

static double *cell(const table *t, int what, size_t crash, size_t variant)
{
    return &t->severity[what][crash * t->data->variant_count + variant];
}

static cp_status create_table(table *t, cp_error *error)
{
    size_t cells = t->data->crash_count * t->data->variant_count;
    bool good = true;
    for (int what = 0; what < CP_EXCEEDED_COUNT; what++) {
        t->severity[what] = malloc((cells + 1) * sizeof *t->severity[what]);
        good &= t->severity[what] != NULL;
        for (size_t k = 0; good && k < cells; k++)
            t->severity[what][k] = NAN;
    }
    t->avoided = calloc(cells + 1, sizeof *t->avoided);
    t->seen = calloc(t->data->variant_count + 1, sizeof *t->seen);
    t->crash = calloc(t->data->crash_count + 1, sizeof *t->crash);
    t->cluster = calloc(t->data->crash_count + 1, sizeof *t->cluster);
    t->events = calloc(t->data->replication_count + 1, sizeof *t->events);
    good &= t->avoided && t->seen && t->crash && t->cluster && t->events;
    return good ? CP_OK : cp_fail_memory(error, "crashes judged with every treatment");
}

static void destroy_table(table *t)
{
    for (int what = 0; what < CP_EXCEEDED_COUNT; what++)
        free(t->severity[what]);
    free(t->avoided);
    free(t->seen);
    free(t->crash);
    free(t->cluster);
    free(t->events);
}

// The larger delta-v of frontally struck vehicles; both crashes of a pair alike.
static void raise_delta_v(const table *t, const cp_study_vehicle *v, size_t variant)
{
    double *value = cell(t, CP_EXCEEDED_DELTA_V, v->crash, variant);
    if (v->frontal && !(*value >= v->delta_v_m_s))
        *value = v->delta_v_m_s;
}

// Severities of every pair; what is avoided, or left-censored, lies below every value.
static void fill_table(table *t)
{
    const cp_study_data *data = t->data;
    for (size_t k = 0; k < data->vehicle_count; k++)
        raise_delta_v(t, &data->vehicle[k], t->baseline);
    for (size_t k = 0; k < data->treated_count; k++)
        raise_delta_v(t, &data->treated[k].vehicle, data->treated[k].variant);
    for (size_t k = 0; k < data->pair_count; k++) {
        const cp_study_pair *pair = &data->pair[k];
        if (pair->outcome == CP_OUTCOME_INVALID)
            continue;
        for (int g = 0; g < 2; g++)
            *cell(t, CP_EXCEEDED_OLC, pair->crash, g ? pair->variant : t->baseline) =
                pair->olc_g[g] > 0.0    ? pair->olc_g[g]
                : isnan(pair->olc_g[g]) ? NAN
                                        : -INFINITY;
        if (pair->outcome == CP_OUTCOME_AVOIDED) {
            *cell(t, CP_EXCEEDED_DELTA_V, pair->crash, pair->variant) = -INFINITY;
            t->avoided[pair->crash * data->variant_count + pair->variant] = 1;
        }
    }
}

// The frontal crashes of the slice, and which treatments have pairs there.
static void choose_crashes(table *t, const cp_replication_set *set, cp_slice slice, int scope)
{
    const cp_study_data *data = t->data;
    for (size_t k = 0; k < data->crash_count; k++) {
        const cp_study_crash *crash = &data->crash[k];
        size_t cluster = cp_replication_set_cluster(set, crash->replication);
        if (cluster == SIZE_MAX || !cp_slice_has_frontal_crash(data, slice, crash) ||
            (scope == CP_SCOPE_INSIDE && !crash->inside))
            continue;
        t->crash[t->count] = k;
        t->cluster[t->count++] = cluster;
    }
    for (size_t k = 0; k < data->pair_count; k++)
        if (cp_slice_has_frontal_crash(data, slice, &data->crash[data->pair[k].crash]))
            t->seen[data->pair[k].variant] = 1;
    t->seen[t->baseline] = 0; // comes first by itself
}

static bool is_judged(const table *t, size_t crash)
{
    for (size_t v = 0; v < t->data->variant_count; v++)
        for (int what = 0; what < CP_EXCEEDED_COUNT; what++)
            if ((t->seen[v] || v == t->baseline) && isnan(*cell(t, what, crash, v)))
                return false;
    return true;
}

static void keep_judged(table *t, cp_judged *judged)
{
    size_t kept = 0;
    for (size_t k = 0; k < t->count; k++) {
        if (!is_judged(t, t->crash[k])) {
            judged->left_out++;
            continue;
        }
        t->crash[kept] = t->crash[k];
        t->cluster[kept++] = t->cluster[k];
    }
    t->count = judged->crashes = kept;
}

static cp_status make_variant(const table *t, const cp_replication_set *set,
                              const cp_resampling *resampling, cp_judged_variant *v,
                              cp_error *error)
{
    double *value = calloc(t->count + 1, sizeof *value);
    cp_status status = value ? CP_OK : cp_fail_memory(error, "a treatment's severities");
    for (int what = 0; what < CP_EXCEEDED_COUNT && status == CP_OK; what++) {
        v->avoided = 0;
        for (size_t k = 0; k < t->count; k++) {
            value[k] = *cell(t, what, t->crash[k], v->variant);
            v->avoided += t->avoided[t->crash[k] * t->data->variant_count + v->variant];
        }
        status = cp_sample_create(value, t->cluster, t->count, set->count, &v->sample[what], error);
        if (status == CP_OK && t->count > 0)
            status = cp_band_of_ecdf(&v->sample[what], resampling, &v->band[what], error);
        if (status == CP_OK)
            cp_exceedance_curve(&v->sample[what], set, what, t->events, v->curve[what]);
    }
    free(value);
    return status;
}

static cp_status make_variants(const table *t, const cp_replication_set *set,
                               const cp_resampling *resampling, cp_judged *judged, cp_error *error)
{
    judged->variant = calloc(t->data->variant_count + 1, sizeof *judged->variant);
    if (!judged->variant)
        return cp_fail_memory(error, "the variants of a study");
    judged->variant[judged->variant_count++].variant = t->baseline;
    for (size_t v = 0; v < t->data->variant_count; v++)
        if (t->seen[v])
            judged->variant[judged->variant_count++].variant = v;
    cp_status status = CP_OK;
    for (size_t k = 0; k < judged->variant_count && status == CP_OK; k++) {
        cp_judged_variant *v = &judged->variant[k];
        for (int what = 0; what < CP_EXCEEDED_COUNT; what++)
            v->band[what] = (cp_band){CP_INTERVAL_UNDEFINED, NAN};
        status = make_variant(t, set, resampling, v, error);
    }
    return status;
}

cp_status cp_judged_create(const cp_study_data *data, size_t baseline, cp_slice slice, int scope,
                           const cp_comparison_options *options, cp_judged *judged, cp_error *error)
{
    *judged = (cp_judged){0};
    if (data->pair_count == 0)
        return CP_OK;
    cp_replication_set set = {0};
    table t = {.data = data, .baseline = baseline};
    cp_status status = create_table(&t, error);
    if (status == CP_OK)
        status = cp_replication_set_create(data, slice, baseline, &set, error);
    if (status == CP_OK) {
        fill_table(&t);
        choose_crashes(&t, &set, slice, scope);
        keep_judged(&t, judged);
        cp_resampling resampling = cp_resampling_default();
        resampling.repetitions = options->repetitions;
        resampling.seed = data->seed;
        resampling.cluster_count[0] = set.count;
        resampling.stratum[0] = set.stratum;
        status = make_variants(&t, &set, &resampling, judged, error);
    }
    cp_replication_set_destroy(&set);
    destroy_table(&t);
    return status;
}

void cp_judged_destroy(cp_judged *judged)
{
    for (size_t k = 0; k < judged->variant_count; k++)
        for (int what = 0; what < CP_EXCEEDED_COUNT; what++)
            cp_sample_destroy(&judged->variant[k].sample[what]);
    free(judged->variant);
    *judged = (cp_judged){0};
}

const cp_judged_variant *cp_judged_find(const cp_judged *judged, size_t variant)
{
    for (size_t k = 0; k < judged->variant_count; k++)
        if (judged->variant[k].variant == variant)
            return &judged->variant[k];
    return NULL;
}
