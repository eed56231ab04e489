/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/comparison_json.h"

#include "report/query_json.h"

#include <math.h>

static json_t *estimate_json(cp_estimate estimate)
{
    static const char *const RELATION[] = {
        [CP_NO_VALUE] = "", [CP_EXACTLY] = "=", [CP_LESS_THAN] = "<", [CP_MORE_THAN] = ">"};
    if (estimate.relation == CP_NO_VALUE)
        return json_null();
    return json_pack("{s:s, s:o}", "relation", RELATION[estimate.relation], "value",
                     cp_number_json(estimate.value));
}

static json_t *interval_json(cp_interval interval)
{
    return json_pack("{s:s, s:o, s:o}", "status", cp_interval_status_text(interval.status), "low",
                     cp_number_json(interval.low), "high", cp_number_json(interval.high));
}

static json_t *description_json(const cp_description *d)
{
    return json_pack(
        "{s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "n", (json_int_t)d->count,
        "censored", (json_int_t)d->censored, "mean", cp_number_json(d->mean), "sd",
        cp_number_json(d->sd), "min", estimate_json(d->minimum), "q25", estimate_json(d->q25),
        "median", estimate_json(d->median), "q75", estimate_json(d->q75), "p90",
        estimate_json(d->p90), "p95", estimate_json(d->p95), "max", estimate_json(d->maximum));
}

static json_t *scopes_json(const cp_description d[CP_SCOPE_COUNT])
{
    return json_pack("{s:o, s:o}", CP_SCOPE_TEXT[CP_SCOPE_ALL], description_json(&d[CP_SCOPE_ALL]),
                     CP_SCOPE_TEXT[CP_SCOPE_INSIDE], description_json(&d[CP_SCOPE_INSIDE]));
}

static json_t *variant_json(const cp_study_data *data, const cp_comparison *comparison,
                            const cp_variant_figures *v)
{
    json_t *rate =
        json_pack("{s:o, s:o, s:o, s:o}", "value", cp_number_json(v->rate), "garwood",
                  interval_json(v->rate_garwood), "bootstrap", interval_json(v->rate_bootstrap),
                  "dispersion", cp_number_json(v->dispersion_1));
    double share = v->frontal_vehicles ? (double)v->inside / (double)v->frontal_vehicles : NAN;
    return json_pack(
        "{s:s, s:b, s:I, s:f, s:f, s:I, s:I, s:I, s:o, s:I, s:I, s:I, s:o, s:o, s:o, s:o}",
        "variant", data->variant[v->variant].name, "is_baseline",
        v->variant == comparison->baseline, "replications", (json_int_t)v->replications,
        "vehicle_km", v->vehicle_km, "vehicle_h", v->vehicle_h, "crashes", (json_int_t)v->crashes,
        "frontal_crashes", (json_int_t)v->frontal_crashes, "front_front_inside",
        (json_int_t)v->front_front_inside, "frontal_crashes_per_million_km", rate,
        "frontal_vehicles", (json_int_t)v->frontal_vehicles, "simulation_failed",
        (json_int_t)v->simulation_failed, "inside_validity", (json_int_t)v->inside,
        "share_inside_validity", cp_number_json(share), "olc_g", scopes_json(v->olc_g),
        "delta_v_m_s", scopes_json(v->delta_v_m_s), "closing_speed_m_s",
        scopes_json(v->closing_speed_m_s));
}

static json_t *severity_json(const cp_contrast *c, double p_holm)
{
    return json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "mean_difference",
        estimate_json(c->mean_difference), "mean_interval", interval_json(c->mean_interval),
        "median_difference", estimate_json(c->median_difference), "median_interval",
        interval_json(c->median_interval), "p90_difference", estimate_json(c->p90_difference),
        "p90_interval", interval_json(c->p90_interval), "cliffs_delta",
        cp_number_json(c->cliffs_delta), "cliffs_delta_interval",
        interval_json(c->cliffs_delta_interval), "mann_whitney_u",
        cp_number_json(c->mann_whitney.statistic), "mann_whitney_p",
        cp_number_json(c->mann_whitney.p), "mann_whitney_p_holm", cp_number_json(p_holm),
        "kolmogorov_smirnov_d", cp_number_json(c->kolmogorov_smirnov.statistic),
        "kolmogorov_smirnov_p", cp_number_json(c->kolmogorov_smirnov.p));
}

static json_t *contrast_json(const cp_study_data *data, const cp_contrast_figures *c)
{
    json_t *olc =
        json_pack("{s:o, s:o}", CP_SCOPE_TEXT[CP_SCOPE_ALL],
                  severity_json(&c->olc_g[CP_SCOPE_ALL], c->olc_p_holm[CP_SCOPE_ALL]),
                  CP_SCOPE_TEXT[CP_SCOPE_INSIDE],
                  severity_json(&c->olc_g[CP_SCOPE_INSIDE], c->olc_p_holm[CP_SCOPE_INSIDE]));
    return json_pack("{s:s, s:b, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o}", "variant",
                     data->variant[c->variant].name, "paired", data->paired,
                     "baseline_replications", (json_int_t)c->replications[0],
                     "treatment_replications", (json_int_t)c->replications[1], "rate_ratio",
                     cp_number_json(c->rate_ratio), "rate_ratio_poisson",
                     interval_json(c->rate_ratio_poisson), "rate_ratio_bootstrap",
                     interval_json(c->rate_ratio_bootstrap), "rate_p", cp_number_json(c->rate_p),
                     "rate_p_holm", cp_number_json(c->rate_p_holm), "olc_g", olc);
}

json_t *cp_comparison_json(const cp_study_data *data, const cp_comparison *comparison)
{
    json_t *variants = json_array(), *contrasts = json_array();
    for (size_t k = 0; k < comparison->variant_count; k++)
        json_array_append_new(variants, variant_json(data, comparison, &comparison->variant[k]));
    for (size_t k = 0; k < comparison->contrast_count; k++)
        json_array_append_new(contrasts, contrast_json(data, &comparison->contrast[k]));

    // An array that is short of a row would be a wrong result: then none at all.
    if (json_array_size(variants) != comparison->variant_count ||
        json_array_size(contrasts) != comparison->contrast_count) {
        json_decref(variants);
        json_decref(contrasts);
        return NULL;
    }
    cp_slice slice = comparison->slice;
    return json_pack(
        "{s:s?, s:s?, s:s, s:o, s:o}", "scenario",
        slice.scenario == CP_SLICE_ALL ? NULL : data->scenario[slice.scenario].name, "crash_type",
        slice.crash_type == CP_SLICE_ALL ? NULL : data->crash_type[slice.crash_type], "baseline",
        data->variant[comparison->baseline].name, "variants", variants, "contrasts", contrasts);
}
