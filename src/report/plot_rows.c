/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/plot_data.h"

#include "analysis/comparison.h"

#include <math.h>
#include <stdlib.h>

// ---- rates, differences, benefits
// ---------------------------------------------------------

/* One row of a figure of intervals. */
typedef struct row {
    size_t variant;
    const char *label;
    double value;
    cp_interval interval;
} row;

static bool closed(const row *r)
{
    return r->interval.status == CP_INTERVAL_VALUE && isfinite(r->interval.low) &&
           isfinite(r->interval.high);
}

static void put_row(cp_plot *p, const row *r)
{
    if (isnan(r->value))
        return;
    char label[512];
    snprintf(label, sizeof label, "%.200s%s%.200s", cp_plot_name(p, r->variant),
             *r->label ? ": " : "", r->label);
    cp_plot_text(p->out, label);
    fprintf(p->out, "\t%.9g\t%zu", r->value, p->drawn);
    // No bar where there is no interval: none of no width is drawn.
    if (closed(r)) {
        fprintf(p->out, "\t%.9g\t%.9g\n", r->interval.low, r->interval.high);
        fprintf(p->bars, "%zu ", p->drawn);
    } else {
        fputs("\tNaN\tNaN\n", p->out);
    }
    fprintf(p->variants, "%zu ", r->variant);
    p->block_count++;
    p->drawn++;
}

static void write_rows(cp_plot *p, const row *rows, size_t count)
{
    for (size_t k = 0; k < count; k++)
        put_row(p, &rows[k]);
}

cp_status cp_plot_rates(cp_plot *p, cp_error *error)
{
    const cp_comparison *c = p->comparison;
    row *rows = calloc(c->variant_count + 1, sizeof *rows);
    if (!rows)
        return cp_fail_memory(error, "a figure");
    for (size_t k = 0; k < c->variant_count; k++) {
        const cp_variant_figures *v = &c->variant[k];
        bool bootstrap = v->rate_bootstrap.status == CP_INTERVAL_VALUE;
        rows[k] =
            (row){v->variant, bootstrap ? "" : "Poisson, widened", v->rate, cp_rate_interval(v)};
    }
    write_rows(p, rows, c->variant_count);
    free(rows);
    return CP_OK;
}

// A difference that censoring leaves open has no place on an axis.
static double known(cp_estimate estimate)
{
    return estimate.relation == CP_EXACTLY ? estimate.value : NAN;
}

cp_status cp_plot_difference(cp_plot *p, cp_error *error)
{
    const cp_comparison *c = p->comparison;
    row *rows = calloc(3 * c->contrast_count + 2 * c->counterfactual_count + 1, sizeof *rows);
    if (!rows)
        return cp_fail_memory(error, "a figure");
    size_t count = 0;
    for (size_t k = 0; k < c->contrast_count; k++) {
        const cp_contrast *o = &c->contrast[k].severity[CP_QUANTITY_OLC];
        size_t v = c->contrast[k].variant;
        rows[count++] = (row){v, "median", known(o->median_difference), o->median_interval};
        rows[count++] = (row){v, "mean", known(o->mean_difference), o->mean_interval};
        rows[count++] = (row){v, "90 % quantile", known(o->p90_difference), o->p90_interval};
    }
    for (size_t k = 0; k < c->counterfactual_count; k++) {
        const cp_counterfactual_figures *f = &c->counterfactual[k];
        rows[count++] =
            (row){f->variant, "all pairs, avoided = 0 g", f->olc_g[CP_PAIRED_ALL].hodges_lehmann,
                  f->olc_g[CP_PAIRED_ALL].hodges_lehmann_interval};
        rows[count++] = (row){f->variant, "crashing", f->olc_g[CP_PAIRED_CRASHING].hodges_lehmann,
                              f->olc_g[CP_PAIRED_CRASHING].hodges_lehmann_interval};
    }
    write_rows(p, rows, count);
    free(rows);
    return CP_OK;
}

cp_status cp_plot_benefit(cp_plot *p, cp_error *error)
{
    const cp_comparison *c = p->comparison;
    size_t risks = p->data->risk_count, count = 0;
    size_t most = risks * (c->contrast_count + c->counterfactual_count);
    row *rows = calloc(most + 1, sizeof *rows);
    char(*label)[128] = calloc(most + 1, sizeof *label);
    if (!rows || !label) {
        free(rows);
        free(label);
        return cp_fail_memory(error, "a figure");
    }
    for (size_t k = 0; k < c->contrast_count + c->counterfactual_count; k++) {
        bool pairs = k >= c->contrast_count;
        const cp_counterfactual_figures *f = &c->counterfactual[pairs ? k - c->contrast_count : 0];
        for (size_t r = 0; r < risks; r++, count++) {
            const cp_benefit_figures *b = pairs ? &f->benefit[r] : &c->contrast[k].benefit[r];
            const cp_study_risk *risk = &p->data->risk[r];
            snprintf(label[count], sizeof label[count], "%.50s (%.50s)", risk->level, risk->name);
            rows[count] =
                (row){pairs ? f->variant : c->contrast[k].variant,
                      label[count],
                      100.0 * b->benefit_1,
                      {b->interval.status, 100.0 * b->interval.low, 100.0 * b->interval.high}};
        }
    }
    write_rows(p, rows, count);
    free(rows);
    free(label);
    return CP_OK;
}

// ---- scenario by scenario ----------------------------------------------------------------------

size_t cp_plot_treatments(const cp_comparison *comparison, size_t *variant)
{
    size_t count = 0;
    for (size_t k = 0; k < comparison->contrast_count; k++)
        variant[count++] = comparison->contrast[k].variant;
    for (size_t k = 0; k < comparison->counterfactual_count; k++)
        variant[count++] = comparison->counterfactual[k].variant;
    return count;
}

cp_plot_headline cp_plot_headline_of(const cp_comparison *comparison, size_t variant)
{
    for (size_t k = 0; k < comparison->contrast_count; k++) {
        const cp_contrast_figures *c = &comparison->contrast[k];
        if (c->variant == variant)
            return (cp_plot_headline){c->rate_ratio, cp_rate_ratio_interval(c)};
    }
    for (size_t k = 0; k < comparison->counterfactual_count; k++) {
        const cp_counterfactual_figures *c = &comparison->counterfactual[k];
        cp_interval share = c->share[CP_OUTCOME_AVOIDED];
        if (c->variant == variant && c->valid > 0)
            return (cp_plot_headline){100.0 * (double)c->outcome[CP_OUTCOME_AVOIDED] /
                                          (double)c->valid,
                                      {share.status, 100.0 * share.low, 100.0 * share.high}};
    }
    return (cp_plot_headline){NAN, {CP_INTERVAL_UNDEFINED, NAN, NAN}};
}

cp_status cp_plot_compare_scenario(const cp_plot *p, size_t scenario, cp_comparison *comparison,
                                   cp_error *error)
{
    cp_slice slice = p->comparison->slice;
    slice.scenario = scenario;
    return cp_compare(p->data, p->comparison->baseline, slice, &p->options, comparison, error);
}

static bool in_figure(const cp_plot *p, size_t scenario)
{
    return p->comparison->slice.scenario == CP_SLICE_ALL ||
           p->comparison->slice.scenario == scenario;
}

static void put_headline(cp_plot *p, const cp_comparison *comparison, size_t variant,
                         const char *label)
{
    cp_plot_headline h = cp_plot_headline_of(comparison, variant);
    put_row(p, &(row){variant, label, h.value, h.interval});
}

cp_status cp_plot_forest(cp_plot *p, cp_error *error)
{
    const cp_study_data *data = p->data;
    size_t *treatment = calloc(data->variant_count + 1, sizeof *treatment), scenarios = 0;
    cp_comparison *of = calloc(data->scenario_count + 1, sizeof *of);
    cp_status status = treatment && of ? CP_OK : cp_fail_memory(error, "a figure");
    for (size_t s = 0; s < data->scenario_count && status == CP_OK; s++)
        if (in_figure(p, s)) {
            scenarios++;
            status = cp_plot_compare_scenario(p, s, &of[s], error);
        }
    size_t count = status == CP_OK ? cp_plot_treatments(p->comparison, treatment) : 0;
    if (status == CP_OK && count == 0)
        status = cp_fail(error, CP_BAD_INPUT, "forest needs a treatment besides the baseline");
    for (size_t k = 0; k < count; k++) {
        for (size_t s = 0; s < data->scenario_count; s++)
            if (in_figure(p, s))
                put_headline(p, &of[s], treatment[k], data->scenario[s].name);
        if (scenarios > 1)
            put_headline(p, p->comparison, treatment[k],
                         data->counterfactual ? "all" : "all, stratified");
    }
    for (size_t s = 0; of && s < data->scenario_count; s++)
        cp_comparison_destroy(&of[s]);
    free(of);
    free(treatment);
    return status;
}
