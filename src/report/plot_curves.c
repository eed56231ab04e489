/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/plot_data.h"

#include "analysis/any_vehicle.h"
#include "analysis/convergence.h"
#include "analysis/corridor.h"
#include "analysis/slice_sample.h"
#include "core/units.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- distributions -----------------------------------------------------------------------------

// A point of a distribution function and its band, if there is one.
static void put_share(cp_plot *p, double x, double share, double half_width)
{
    if (isnan(half_width))
        fprintf(p->out, "%.6g\t%.6g\tNaN\tNaN\n", x, share);
    else
        fprintf(p->out, "%.6g\t%.6g\t%.6g\t%.6g\n", x, share, fmax(0.0, share - half_width),
                fmin(1.0, share + half_width));
}

// factor: of the unit that is drawn.
static void put_steps(cp_plot *p, const cp_sample *sample, double factor, double half_width)
{
    double n = (double)sample->count, before = 0.0;
    size_t censored = cp_sample_censored(sample);
    // The share before each step and after it, so that lines and areas are stairs.
    before = (double)censored / n;
    put_share(p, 0.0, before, half_width);
    for (size_t k = censored; k < sample->count; k++) {
        double after = (double)(k + 1) / n, x = factor * sample->value[k];
        put_share(p, x, before, half_width);
        put_share(p, x, after, half_width);
        before = after;
    }
    p->drawn += sample->count;
}

static double factor_of(int what)
{
    return what == CP_EXCEEDED_DELTA_V ? cp_km_h_from_m_s(1.0) : 1.0;
}

static void put_distribution(cp_plot *p, size_t variant, const char *title, const cp_sample *sample,
                             int what, double half_width)
{
    cp_plot_begin_block(p, variant, title);
    if (sample->count > 0)
        put_steps(p, sample, factor_of(what), half_width);
    else
        fputs(CP_PLOT_NOTHING, p->out);
}

// Over the frontally struck vehicles of each variant's own replications.
static cp_status distribution_of_vehicles(cp_plot *p, int what, cp_error *error)
{
    const cp_comparison *c = p->comparison;
    cp_slice_quantity quantity =
        what == CP_EXCEEDED_DELTA_V ? CP_QUANTITY_DELTA_V : CP_QUANTITY_OLC;
    for (size_t k = 0; k < c->variant_count; k++) {
        cp_replication_set set;
        cp_sample sample = {0};
        cp_status status =
            cp_replication_set_create(p->data, c->slice, c->variant[k].variant, &set, error);
        if (status == CP_OK)
            status = cp_slice_sample(p->data, &set, c->slice, p->scope, quantity, &sample, error);
        if (status == CP_OK) {
            char title[CP_PLOT_TITLE_SIZE];
            snprintf(title, sizeof title, "%.400s (n = %zu)",
                     cp_plot_name(p, c->variant[k].variant), sample.count);
            put_distribution(p, c->variant[k].variant, title, &sample, what,
                             what == CP_EXCEEDED_OLC ? c->variant[k].olc_band[p->scope].half_width_1
                                                     : NAN);
        }
        cp_sample_destroy(&sample);
        cp_replication_set_destroy(&set);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

// Over the crashes that were judged with every treatment.
static void distribution_of_judged(cp_plot *p, const cp_judged *judged, int what)
{
    for (size_t k = 0; k < judged->variant_count; k++) {
        const cp_judged_variant *v = &judged->variant[k];
        char title[CP_PLOT_TITLE_SIZE];
        snprintf(title, sizeof title, "%.400s (%zu crashes, %zu avoided)",
                 cp_plot_name(p, v->variant), judged->crashes, v->avoided);
        put_distribution(p, v->variant, title, &v->sample[what], what, v->band[what].half_width_1);
    }
}

static void exceedance_of(cp_plot *p, size_t variant, const cp_exceedance *curve, int what)
{
    char title[CP_PLOT_TITLE_SIZE];
    snprintf(title, sizeof title, "%.400s, 95 %% at each point", cp_plot_name(p, variant));
    cp_plot_begin_block(p, variant, title);
    for (size_t j = 0; j < CP_EXCEEDANCE_POINTS; j++) {
        const cp_exceedance *e = &curve[j];
        if (isnan(e->rate)) {
            fputs(CP_PLOT_NOTHING, p->out);
            return;
        }
        fprintf(p->out, "%.6g\t%.6g\t%.6g\t%.6g\n", factor_of(what) * e->x, e->rate,
                e->interval.low, e->interval.high);
        p->drawn += e->crashes;
    }
}

static cp_status judged_of(const cp_plot *p, cp_judged *judged, cp_error *error)
{
    return cp_judged_create(p->data, p->comparison->baseline, p->comparison->slice, p->scope,
                            &p->options, judged, error);
}

cp_status cp_plot_distribution(cp_plot *p, int what, cp_error *error)
{
    if (p->comparison->counterfactual_count == 0)
        return distribution_of_vehicles(p, what, error);
    cp_judged judged;
    cp_status status = judged_of(p, &judged, error);
    if (status == CP_OK)
        distribution_of_judged(p, &judged, what);
    cp_judged_destroy(&judged);
    return status;
}

// Crashes above a severity per vehicle-km over that severity, with the band of single points.
cp_status cp_plot_exceedance(cp_plot *p, int what, cp_error *error)
{
    const cp_comparison *c = p->comparison;
    cp_judged judged = {0};
    cp_status status = c->counterfactual_count > 0 ? judged_of(p, &judged, error) : CP_OK;
    for (size_t k = 0; k < judged.variant_count && status == CP_OK; k++)
        exceedance_of(p, judged.variant[k].variant, judged.variant[k].curve[what], what);
    for (size_t k = 0; k < c->variant_count && c->counterfactual_count == 0; k++)
        exceedance_of(p, c->variant[k].variant, c->variant[k].curve[what], what);
    cp_judged_destroy(&judged);
    return status;
}

// ---- pulses ------------------------------------------------------------------------------------

static void put_corridor(cp_plot *p, size_t variant, const cp_corridor *c)
{
    char title[CP_PLOT_TITLE_SIZE];
    snprintf(title, sizeof title, "%.400s, median, 10–90 %%", cp_plot_name(p, variant));
    cp_plot_begin_block(p, variant, title);
    for (size_t t = 0; t < c->points; t++, p->drawn++)
        fprintf(p->out, "%g\t%g\t%g\t%g\n", 1e3 * CP_CORRIDOR_INTERVAL_S * (double)t, c->p50_g[t],
                c->p10_g[t], c->p90_g[t]);
    if (c->points == 0)
        fputs(CP_PLOT_NOTHING, p->out);
}

// Marks the vehicles of a variant, the study's own and then the treated ones.
static void choose_vehicles(const cp_plot *p, size_t variant, unsigned char *chosen)
{
    for (size_t k = 0; k < cp_any_vehicle_count(p->data); k++) {
        cp_any_vehicle v = cp_any_vehicle_at(p->data, k);
        chosen[k] =
            v.variant == variant && cp_plot_has_vehicle(p, v.vehicle, v.treated ? SIZE_MAX : k);
    }
}

cp_status cp_plot_corridor(cp_plot *p, cp_error *error)
{
    cp_corridor_pulses pulses = {0};
    unsigned char *chosen = calloc(cp_any_vehicle_count(p->data) + 1, sizeof *chosen);
    size_t *variant = calloc(p->data->variant_count + 1, sizeof *variant);
    cp_status status = chosen && variant ? CP_OK : cp_fail_memory(error, "a figure");
    if (status == CP_OK)
        status = cp_corridor_read(p->store, p->data, &pulses, error);
    size_t count = status == CP_OK ? cp_plot_variants(p, variant) : 0;
    for (size_t k = 0; k < count && status == CP_OK; k++) {
        cp_corridor corridor;
        choose_vehicles(p, variant[k], chosen);
        status = cp_corridor_of(&pulses, chosen, &corridor, error);
        if (status == CP_OK)
            put_corridor(p, variant[k], &corridor);
    }
    cp_corridor_destroy(&pulses);
    free(variant);
    free(chosen);
    return status;
}

// ---- injury risk -------------------------------------------------------------------------------

#define RISK_END_KM_H 100

// Functions of a speed, over km/h; those of the crash type for front-front.
cp_status cp_plot_risk(cp_plot *p, cp_error *error)
{
    (void)error;
    for (size_t k = 0; k < p->data->risk_count; k++) {
        const cp_study_risk *risk = &p->data->risk[k];
        if (!cp_predictor_is_speed(risk->predictor))
            continue;
        char title[CP_PLOT_TITLE_SIZE];
        snprintf(title, sizeof title, "%.200s (%.200s)%s%s", risk->level, risk->name,
                 cp_risk_has_crash_type(&risk->function) ? ", front-front" : "",
                 risk->predictor == CP_PREDICTOR_CLOSING_SPEED ? ", of closing speed" : "");
        cp_plot_begin_block(p, k + 1, title);
        for (int km_h = 0; km_h <= RISK_END_KM_H; km_h++, p->drawn++)
            fprintf(p->out, "%d\t%.6g\tNaN\tNaN\n", km_h,
                    cp_risk_probability(&risk->function, cp_m_s_from_km_h(km_h), "front-front"));
    }
    return CP_OK;
}

// ---- convergence -------------------------------------------------------------------------------

cp_status cp_plot_convergence(cp_plot *p, cp_error *error)
{
    cp_convergence convergence;
    const cp_comparison *c = p->comparison;
    cp_status status = cp_convergence_create(p->data, c->baseline, c->slice, &convergence, error);
    double factor = convergence.what == CP_CONVERGING_AVOIDED ? 100.0 : 1.0;
    for (size_t k = 0; k < convergence.count && status == CP_OK; k++) {
        const cp_convergence_series *series = &convergence.series[k];
        char title[CP_PLOT_TITLE_SIZE];
        snprintf(title, sizeof title, "%.400s%s", cp_plot_name(p, series->variant),
                 convergence.what == CP_CONVERGING_RATE ? ", per 10^6 vehicle-km" : "");
        cp_plot_begin_block(p, series->variant, title);
        fputs(CP_PLOT_NOTHING, p->out);
        for (size_t j = 0; j < series->count; j++) {
            const cp_convergence_point *point = &series->point[j];
            if (isnan(point->value))
                continue;
            p->drawn++;
            if (point->interval.status == CP_INTERVAL_VALUE && isfinite(point->interval.high))
                fprintf(p->out, "%zu\t%.6g\t%.6g\t%.6g\n", point->replications,
                        factor * point->value, factor * point->interval.low,
                        factor * point->interval.high);
            else
                fprintf(p->out, "%zu\t%.6g\tNaN\tNaN\n", point->replications,
                        factor * point->value);
        }
    }
    cp_convergence_destroy(&convergence);
    return status;
}
