/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/field_comparison.h"

#include "analysis/field_shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What all figures of a comparison share. */
typedef struct job {
    const cp_study_data *data;
    const cp_comparison_options *options;
    const cp_field_request *request;
    cp_comparison *comparison;
    cp_field_margins all;     /* margins asked for */
    cp_field_margins lasting; /* without delta-v, which treatments change */
} job;

/* One run of weighted figures: the baseline's crashes, and those of a treatment. */
typedef struct run {
    const cp_field_margins *margins;
    cp_replication_set set[2];
    cp_field_source source[2];
    cp_field_units units[2]; /* with pairs the second is unused */
    bool pairs;
    cp_raked raked;
    cp_resampling resampling;
    double *weight[2];
} run;

static void run_destroy(run *r)
{
    for (int g = 0; g < 2; g++) {
        cp_field_units_destroy(&r->units[g]);
        cp_replication_set_destroy(&r->set[g]);
        free(r->weight[g]);
    }
}

static const cp_field_units *units_of(const run *r, int g)
{
    return &r->units[r->pairs ? 0 : g];
}

// The arms from the sets: one, two, or the pairs of a treatment.
static cp_status prepare(const job *j, const cp_field_margins *margins, size_t treatment,
                         bool pairs, run *r, cp_error *error)
{
    cp_slice slice = j->comparison->slice;
    *r = (run){.margins = margins, .pairs = pairs, .resampling = cp_resampling_default()};
    r->resampling.seed = j->data->seed;
    cp_status status =
        cp_replication_set_create(j->data, slice, j->comparison->baseline, &r->set[0], error);
    bool two = treatment != SIZE_MAX;
    if (status == CP_OK && two)
        status = cp_replication_set_create(
            j->data, slice, pairs ? j->comparison->baseline : treatment, &r->set[1], error);
    if (status == CP_OK && two && !pairs && j->data->paired)
        cp_replication_set_match(j->data, &r->set[0], &r->set[1]);
    for (int g = 0; g < 2 && status == CP_OK && (g == 0 || two); g++) {
        r->source[g] =
            (cp_field_source){j->data, j->request, margins, &r->set[g], slice, j->options->above};
        if (g == 0 || !pairs)
            status = cp_field_units_create(&r->source[g], pairs ? treatment : SIZE_MAX,
                                           &r->units[g], error);
        if (status != CP_OK)
            return status;
        r->raked.arm[g] = cp_field_units_arm(&r->source[g], units_of(r, g), pairs && g == 1);
        r->weight[g] = calloc(r->raked.arm[g].count + 1, sizeof *r->weight[g]);
        if (!r->weight[g])
            return cp_fail_memory(error, "weights");
        r->resampling.cluster_count[g] = r->set[g].count;
        r->resampling.stratum[g] = r->set[g].stratum;
    }
    r->raked.events = cp_field_events(j->data);
    r->resampling.paired = two && (pairs || j->data->paired);
    return status;
}

static void per_million(cp_interval *interval)
{
    interval->low *= CP_RATE_PER_KM;
    interval->high *= CP_RATE_PER_KM;
}

// Rates per 10^6 veh-km, and what is uncertain of the risk functions into the intervals.
static void finish(const job *j, const run *r, bool weighted, cp_raked_figures *f)
{
    for (size_t k = 0; k < j->data->risk_count; k++) {
        const cp_risk_function *function = &j->data->risk[k].function;
        size_t e = CP_FIELD_INJURED + k;
        cp_injury_sum sum[2];
        for (int g = 0; g < 2 && r->weight[g]; g++) {
            sum[g] = cp_field_units_injured(&r->source[g], units_of(r, g),
                                            weighted ? r->weight[g] : NULL, k, r->pairs && g == 1);
            double se = sqrt(cp_risk_variance(function, sum[g].gradient)) / sum[g].expected;
            f->arm[g].rate_interval[e] = cp_risk_widened(
                f->arm[g].rate[e], f->arm[g].rate_interval[e], se, function->freedom);
        }
        if (r->weight[1])
            f->ratio_interval[e] =
                cp_risk_widened(f->ratio[e], f->ratio_interval[e],
                                cp_injury_ratio_se(function, &sum[0], &sum[1]), function->freedom);
    }
    for (int g = 0; g < 2; g++)
        for (size_t e = 0; e < r->raked.events; e++) {
            f->arm[g].rate[e] *= CP_RATE_PER_KM;
            per_million(&f->arm[g].rate_interval[e]);
        }
}

// Figures of a run, weighted or not; the weights stay in it.
static cp_status figure(const job *j, run *r, bool weighted, cp_raked_figures *figures,
                        cp_error *error)
{
    r->resampling.repetitions = j->options->repetitions;
    r->raked.raking = weighted ? &r->margins->raking : NULL;
    cp_status status = cp_raked_of(&r->raked, &r->resampling, figures, error);
    for (int g = 0; g < 2 && status == CP_OK && r->weight[g]; g++)
        cp_raked_weights(&r->raked, &figures->factors, g, r->weight[g]);
    if (status == CP_OK)
        finish(j, r, weighted, figures);
    return status;
}

// One arm of a run beside the field.
static cp_status figure_arm(const job *j, const run *r, int g, const cp_raked_figures figures[2],
                            bool weighted, cp_field_variant **to, cp_error *error)
{
    cp_field_variant *v = *to = calloc(1, sizeof *v);
    if (!v)
        return cp_fail_memory(error, "figures beside the field's");
    v->field = j->request->table->name;
    v->weighted = weighted;
    memcpy(v->above, j->options->above, sizeof v->above);
    v->figures[0] = figures[0].arm[g];
    if (weighted)
        v->figures[1] = figures[1].arm[g];
    for (size_t e = 0; !weighted && e < CP_RAKED_EVENTS_MAX; e++)
        v->figures[1].rate[e] = NAN;
    for (size_t q = 0; !weighted && q < CP_RAKED_QUANTILES; q++)
        v->figures[1].quantile[q] = NAN;
    v->gap_1 = weighted ? figures[1].factors.gap_1 : NAN;
    return cp_field_shape_of(&r->source[g], &r->units[g], weighted ? r->weight[g] : NULL, &v->shape,
                             error);
}

static cp_status figure_baseline(const job *j, cp_variant_figures *to, cp_error *error)
{
    run r = {0};
    cp_raked_figures figures[2];
    cp_status status = prepare(j, &j->all, SIZE_MAX, false, &r, error);
    for (int weighted = 0; weighted < 2 && status == CP_OK; weighted++)
        status = figure(j, &r, weighted, &figures[weighted], error);
    if (status == CP_OK)
        status = figure_arm(j, &r, 0, figures, true, &to->field, error);
    run_destroy(&r);
    return status;
}

// Treated units of which a class is none of the baseline's.
static size_t count_unlike(const run *r)
{
    size_t unlike = 0;
    bool there[CP_RAKING_MARGINS_MAX][CP_RAKING_CLASSES_MAX] = {{false}};
    size_t margins = r->margins->raking.count;
    for (size_t k = 0; k < r->units[0].count; k++)
        for (size_t m = 0; m < margins; m++)
            if (r->units[0].classes[k].of[m] != CP_RAKING_UNKNOWN)
                there[m][r->units[0].classes[k].of[m]] = true;
    for (size_t k = 0; k < r->units[1].count; k++) {
        bool known = true;
        for (size_t m = 0; m < margins; m++) {
            unsigned char own = r->units[1].classes[k].of[m];
            known &= own == CP_RAKING_UNKNOWN || there[m][own];
        }
        unlike += !known;
    }
    return unlike;
}

// One way of weighing a treatment against the baseline; to_variant (may be NULL): its own figures.
static cp_status figure_way(const job *j, const cp_field_margins *margins, size_t treatment,
                            bool pairs, int way, cp_field_contrast *c,
                            cp_variant_figures *to_variant, cp_error *error)
{
    run r = {0};
    cp_status status = prepare(j, margins, treatment, pairs, &r, error);
    if (status == CP_OK)
        status = figure(j, &r, way != CP_FIELD_PLAIN, &c->figures[way], error);
    if (status == CP_OK && way == CP_FIELD_WEIGHTED)
        c->unlike = pairs ? 0 : count_unlike(&r);
    if (status == CP_OK && to_variant)
        status = figure_arm(j, &r, 1, c->figures, false, &to_variant->field, error);
    run_destroy(&r);
    return status;
}

// A treatment against the baseline, or its pairs.
static cp_status figure_treatment(const job *j, size_t treatment, bool pairs,
                                  cp_field_contrast **to, cp_variant_figures *to_variant,
                                  cp_error *error)
{
    cp_field_contrast *c = *to = calloc(1, sizeof *c);
    if (!c)
        return cp_fail_memory(error, "figures beside the field's");
    bool all = pairs || j->request->exact || j->lasting.raking.count == 0 ||
               j->lasting.raking.count == j->all.raking.count;
    memcpy(c->above, j->options->above, sizeof c->above);
    c->delta_v_too = !all;
    cp_status status =
        figure_way(j, &j->all, treatment, pairs, CP_FIELD_PLAIN, c, to_variant, error);
    if (status == CP_OK)
        status = figure_way(j, all ? &j->all : &j->lasting, treatment, pairs, CP_FIELD_WEIGHTED, c,
                            NULL, error);
    if (status == CP_OK && !all)
        status = figure_way(j, &j->all, treatment, pairs, CP_FIELD_DELTA_V_TOO, c, NULL, error);
    return status;
}

static cp_variant_figures *variant_of(cp_comparison *comparison, size_t variant)
{
    for (size_t k = 0; k < comparison->variant_count; k++)
        if (comparison->variant[k].variant == variant)
            return &comparison->variant[k];
    return NULL;
}

cp_status cp_field_compare(const cp_study_data *data, const cp_comparison_options *options,
                           cp_comparison *comparison, cp_error *error)
{
    job j = {.data = data, .options = options, .request = options->field, .comparison = comparison};
    if (cp_field_events(data) > CP_RAKED_EVENTS_MAX)
        return cp_fail(error, CP_BAD_INPUT,
                       "table risk_function: with a field at most %d rows may have use_as = "
                       "'default', found %zu",
                       CP_RAKED_EVENTS_MAX - CP_FIELD_INJURED, data->risk_count);
    cp_status status = cp_field_margins_of(options->field, CP_FIELD_MARGIN_COUNT, &j.all, error);
    if (status == CP_OK)
        status = cp_field_margins_of(options->field, CP_FIELD_DELTA_V, &j.lasting, error);
    if (status == CP_OK && j.all.raking.count == 0)
        status =
            cp_fail(error, CP_BAD_INPUT, "field %s: none of the margins to rake is known in it",
                    options->field->table->name);
    cp_variant_figures *baseline = variant_of(comparison, comparison->baseline);
    if (status == CP_OK && baseline)
        status = figure_baseline(&j, baseline, error);
    for (size_t k = 0; k < comparison->contrast_count && status == CP_OK; k++) {
        cp_contrast_figures *c = &comparison->contrast[k];
        status = figure_treatment(&j, c->variant, false, &c->field,
                                  variant_of(comparison, c->variant), error);
    }
    for (size_t k = 0; k < comparison->counterfactual_count && status == CP_OK; k++) {
        cp_counterfactual_figures *c = &comparison->counterfactual[k];
        status = figure_treatment(&j, c->variant, true, &c->field, NULL, error);
    }
    return status;
}
