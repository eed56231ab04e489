/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/slice_curves.h"

#include "analysis/any_vehicle.h"
#include "analysis/convergence.h"
#include "analysis/judged.h"
#include "analysis/query_json.h"
#include "analysis/slice_sample.h"
#include "core/units.h"
#include "report/figure_json.h"

#include <math.h>
#include <stdlib.h>

#define ECDF_POINTS 240

// Steps of a distribution function: [[x, …], [share up to x, …]], thinned out to ECDF_POINTS;
// censored vehicles lie below the first x. factor: of the unit that is drawn.
static json_t *ecdf_json(const cp_sample *sample, double factor)
{
    json_t *x = json_array(), *share = json_array();
    size_t censored = cp_sample_censored(sample), values = sample->count - censored;
    size_t steps = values < ECDF_POINTS ? values : ECDF_POINTS;
    for (size_t k = 0; k < steps; k++) {
        size_t place =
            steps == values
                ? k
                : (size_t)llround((double)k * (double)(values - 1) / (double)(steps - 1));
        json_array_append_new(x, cp_drawn_json(factor * sample->value[censored + place]));
        json_array_append_new(
            share, cp_drawn_json((double)(censored + place + 1) / (double)sample->count));
    }
    return json_pack("{s:o, s:o, s:I, s:I}", "x", x, "share", share, "n", (json_int_t)sample->count,
                     "censored", (json_int_t)censored);
}

// What one variant's curves are drawn into, by scope.
typedef struct variant_curves {
    json_t *olc;
    json_t *delta_v;
    json_t *corridor;
} variant_curves;

static cp_status add_distributions(const cp_slice_curves *e, cp_slice slice, size_t variant,
                                   int scope, const variant_curves *to, cp_error *error)
{
    static const cp_slice_quantity QUANTITY[] = {CP_QUANTITY_OLC, CP_QUANTITY_DELTA_V};
    json_t *const into[] = {to->olc, to->delta_v};
    const double factor[] = {1.0, cp_km_h_from_m_s(1.0)};
    cp_replication_set set;
    cp_status status = cp_replication_set_create(e->data, slice, variant, &set, error);
    for (int q = 0; q < 2 && status == CP_OK; q++) {
        cp_sample sample = {0};
        status = cp_slice_sample(e->data, &set, slice, scope, QUANTITY[q], &sample, error);
        if (status == CP_OK)
            json_object_set_new(into[q], CP_SCOPE_TEXT[scope], ecdf_json(&sample, factor[q]));
        cp_sample_destroy(&sample);
    }
    cp_replication_set_destroy(&set);
    return status;
}

static json_t *points_json(const double *g, size_t count)
{
    json_t *points = json_array();
    for (size_t t = 0; t < count; t++)
        json_array_append_new(points, json_real(g[t]));
    return points;
}

// {"n", "p10": […], "p50": […], "p90": […]} of the pulses of a variant's vehicles in a slice, of
// its own crashes and of treated ones, put into the object under the scope's name.
static cp_status add_corridor(const cp_slice_curves *e, cp_slice slice, size_t variant, int scope,
                              json_t *object, cp_error *error)
{
    const cp_study_data *data = e->data;
    for (size_t k = 0; k < cp_any_vehicle_count(data); k++) {
        cp_any_vehicle v = cp_any_vehicle_at(data, k);
        e->chosen[k] = v.vehicle->frontal && v.variant == variant &&
                       (scope == CP_SCOPE_ALL || v.vehicle->validity == 0) &&
                       cp_slice_has_crash(data, slice, v.crash);
    }
    cp_corridor c;
    cp_status status = cp_corridor_of(e->pulses, e->chosen, &c, error);
    if (status == CP_OK)
        json_object_set_new(object, CP_SCOPE_TEXT[scope],
                            json_pack("{s:I, s:o, s:o, s:o}", "n", (json_int_t)c.pulses, "p10",
                                      points_json(c.p10_g, c.points), "p50",
                                      points_json(c.p50_g, c.points), "p90",
                                      points_json(c.p90_g, c.points)));
    return status;
}

static cp_status add_variants(const cp_slice_curves *e, const cp_comparison *comparison,
                              json_t *object, cp_error *error)
{
    json_t *variants = json_object_get(object, "variants");
    for (size_t k = 0; k < comparison->variant_count; k++) {
        variant_curves to = {json_object(), json_object(), json_object()};
        json_t *variant = json_array_get(variants, k);
        size_t own = comparison->variant[k].variant;
        json_object_set_new(variant, "ecdf", to.olc);
        json_object_set_new(variant, "ecdf_delta_v_km_h", to.delta_v);
        json_object_set_new(variant, "corridor", to.corridor);
        for (int scope = 0; scope < CP_SCOPE_COUNT; scope++) {
            cp_status status = add_distributions(e, comparison->slice, own, scope, &to, error);
            if (status == CP_OK)
                status = add_corridor(e, comparison->slice, own, scope, to.corridor, error);
            if (status != CP_OK)
                return status;
        }
    }
    return CP_OK;
}

// ---- the same crashes with every treatment -----------------------------------------------------

static json_t *judged_curve_json(const cp_judged_variant *v, int what)
{
    double factor = what == CP_EXCEEDED_DELTA_V ? cp_km_h_from_m_s(1.0) : 1.0;
    json_t *x = json_array(), *crashes = json_array(), *rate = json_array();
    json_t *low = json_array(), *high = json_array();
    for (size_t k = 0; k < CP_EXCEEDANCE_POINTS; k++) {
        const cp_exceedance *e = &v->curve[what][k];
        json_array_append_new(x, cp_drawn_json(factor * e->x));
        json_array_append_new(crashes, json_integer((json_int_t)e->crashes));
        json_array_append_new(rate, cp_number_json(e->rate));
        json_array_append_new(low, cp_number_json(e->interval.low));
        json_array_append_new(high, cp_number_json(e->interval.high));
    }
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "ecdf",
                     ecdf_json(&v->sample[what], factor), "ecdf_band_half_width_1",
                     cp_number_json(v->band[what].half_width_1), "x", x, "crashes", crashes,
                     "per_million_km", rate, "low", low, "high", high);
}

static json_t *judged_json(const cp_study_data *data, const cp_judged *judged)
{
    json_t *variants = json_array();
    for (size_t k = 0; k < judged->variant_count; k++) {
        const cp_judged_variant *v = &judged->variant[k];
        json_array_append_new(variants, json_pack("{s:s, s:I, s:o, s:o}", "variant",
                                                  data->variant[v->variant].name, "avoided",
                                                  (json_int_t)v->avoided, "olc",
                                                  judged_curve_json(v, CP_EXCEEDED_OLC), "delta_v",
                                                  judged_curve_json(v, CP_EXCEEDED_DELTA_V)));
    }
    return json_pack("{s:I, s:I, s:o}", "crashes", (json_int_t)judged->crashes, "left_out",
                     (json_int_t)judged->left_out, "variants", variants);
}

static cp_status add_judged(const cp_slice_curves *e, const cp_comparison *comparison,
                            json_t *object, cp_error *error)
{
    json_t *scopes = json_object(), *treated = json_array();
    json_object_set_new(object, "judged", scopes);
    json_object_set_new(object, "treated", treated);
    for (int scope = 0; scope < CP_SCOPE_COUNT; scope++) {
        cp_judged judged;
        cp_status status = cp_judged_create(e->data, comparison->baseline, comparison->slice, scope,
                                            e->options, &judged, error);
        if (status == CP_OK)
            json_object_set_new(scopes, CP_SCOPE_TEXT[scope], judged_json(e->data, &judged));
        cp_judged_destroy(&judged);
        if (status != CP_OK)
            return status;
    }
    for (size_t k = 0; k < comparison->counterfactual_count; k++) {
        size_t variant = comparison->counterfactual[k].variant;
        json_t *corridor = json_object();
        json_array_append_new(treated,
                              json_pack("{s:s, s:o}", "variant", e->data->variant[variant].name,
                                        "corridor", corridor));
        for (int scope = 0; scope < CP_SCOPE_COUNT; scope++) {
            cp_status status = add_corridor(e, comparison->slice, variant, scope, corridor, error);
            if (status != CP_OK)
                return status;
        }
    }
    return CP_OK;
}

// ---- over more and more replications -----------------------------------------------------------

static json_t *series_json(const cp_study_data *data, const cp_convergence_series *series)
{
    json_t *replications = json_array(), *value = json_array();
    json_t *low = json_array(), *high = json_array();
    for (size_t k = 0; k < series->count; k++) {
        const cp_convergence_point *p = &series->point[k];
        bool known = p->interval.status == CP_INTERVAL_VALUE && !isnan(p->value);
        json_array_append_new(replications, json_integer((json_int_t)p->replications));
        json_array_append_new(value, cp_number_json(p->value));
        json_array_append_new(low, cp_number_json(known ? p->interval.low : NAN));
        json_array_append_new(high, cp_number_json(known ? p->interval.high : NAN));
    }
    return json_pack("{s:s, s:o, s:o, s:o, s:o}", "variant", data->variant[series->variant].name,
                     "replications", replications, "value", value, "low", low, "high", high);
}

static cp_status add_convergence(const cp_slice_curves *e, const cp_comparison *comparison,
                                 json_t *object, cp_error *error)
{
    cp_convergence convergence;
    cp_status status = cp_convergence_create(e->data, comparison->baseline, comparison->slice,
                                             &convergence, error);
    json_t *series = json_array();
    for (size_t k = 0; k < convergence.count && status == CP_OK; k++)
        json_array_append_new(series, series_json(e->data, &convergence.series[k]));
    json_object_set_new(
        object, "convergence",
        json_pack("{s:s, s:o}", "what", CP_CONVERGING_TEXT[convergence.what], "series", series));
    cp_convergence_destroy(&convergence);
    return status;
}

cp_status cp_slice_curves_add(const cp_slice_curves *curves, const cp_comparison *comparison,
                              json_t *object, cp_error *error)
{
    cp_status status = add_variants(curves, comparison, object, error);
    if (status == CP_OK && comparison->counterfactual_count > 0)
        status = add_judged(curves, comparison, object, error);
    return status == CP_OK ? add_convergence(curves, comparison, object, error) : status;
}
