/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/comparison_json.h"

#include "analysis/query_json.h"
#include "report/field_json.h"
#include "report/figure_json.h"

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

static json_t *description_json(const cp_description *d)
{
    return json_pack(
        "{s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "n", (json_int_t)d->count,
        "censored", (json_int_t)d->censored, "mean", estimate_json(d->mean_of_all), "sd",
        cp_number_json(d->sd), "min", estimate_json(d->minimum), "q25", estimate_json(d->q25),
        "median", estimate_json(d->median), "q75", estimate_json(d->q75), "p90",
        estimate_json(d->p90), "p95", estimate_json(d->p95), "max", estimate_json(d->maximum));
}

static json_t *model_part_json(const cp_model_part *p)
{
    return json_pack("{s:I, s:o, s:o, s:s, s:o, s:o, s:o, s:o}", "sets", (json_int_t)p->sets,
                     "estimate", estimate_json(p->estimate), "replications",
                     cp_interval_json(p->replications), "status",
                     cp_interval_status_text(p->status), "sd", cp_number_json(p->sd), "mean",
                     cp_number_json(p->mean), "model_half_width", cp_number_json(p->half_width),
                     "combined", cp_interval_json(p->combined));
}

/* How the quantities are called, in the order of cp_slice_quantity. */
static const char *const QUANTITY[CP_QUANTITY_COUNT] = {"olc_g", "delta_v_m_s", "closing_speed_m_s",
                                                        "lateral_offset_m", "angle_rad"};

static json_t *precision_json(cp_precision precision)
{
    return json_pack("{s:o, s:o, s:o}", "half_width", cp_number_json(precision.half_width),
                     "relative_1", cp_number_json(precision.relative_1),
                     "replications_for_10_percent", cp_number_json(precision.replications_needed));
}

// {"all": …, "inside": …} of a quantity; OLC has its mean's interval and its curve's band too.
static json_t *scopes_json(const cp_variant_figures *v, int quantity)
{
    json_t *scopes = json_object();
    for (int scope = 0; scope < CP_SCOPE_COUNT; scope++) {
        json_t *d = description_json(&v->description[quantity][scope]);
        if (quantity == CP_QUANTITY_OLC) {
            json_object_set_new(d, "mean_interval", cp_interval_json(v->olc_mean_interval[scope]));
            json_object_set_new(d, "mean_precision", precision_json(v->olc_mean_precision[scope]));
            json_object_set_new(d, "ecdf_band_half_width_1",
                                cp_number_json(v->olc_band[scope].half_width_1));
        }
        json_object_set_new(scopes, CP_SCOPE_TEXT[scope], d);
    }
    return scopes;
}

static json_t *injuries_json(const cp_study_data *data, const cp_variant_figures *v)
{
    json_t *scopes = json_object();
    for (int scope = 0; scope < CP_SCOPE_COUNT; scope++) {
        json_t *list = json_array();
        for (size_t k = 0; k < data->risk_count; k++) {
            const cp_injury_figures *i = &v->injury[scope][k];
            json_array_append_new(
                list, json_pack("{s:s, s:s, s:I, s:I, s:f, s:o, s:o, s:o}", "function",
                                data->risk[k].name, "level", data->risk[k].level, "drivers",
                                (json_int_t)i->drivers, "unknown", (json_int_t)i->unknown,
                                "expected", i->expected, "per_million_km", cp_number_json(i->rate),
                                "interval", cp_interval_json(i->rate_interval), "risk_se_1",
                                cp_number_json(i->parameters_se_1)));
        }
        json_object_set_new(scopes, CP_SCOPE_TEXT[scope], list);
    }
    return scopes;
}

static json_t *benefits_json(const cp_study_data *data, const cp_benefit_figures *benefit)
{
    json_t *list = json_array();
    for (size_t k = 0; k < data->risk_count; k++)
        json_array_append_new(list, json_pack("{s:s, s:s, s:f, s:f, s:o, s:o, s:[o, o], s:o}",
                                              "function", data->risk[k].name, "level",
                                              data->risk[k].level, "baseline", benefit[k].baseline,
                                              "treatment", benefit[k].treatment, "benefit_1",
                                              cp_number_json(benefit[k].benefit_1), "interval",
                                              cp_interval_json(benefit[k].interval), "bounds_1",
                                              cp_number_json(benefit[k].bound[0]),
                                              cp_number_json(benefit[k].bound[1]), "risk_se_1",
                                              cp_number_json(benefit[k].parameters_se_1)));
    return list;
}

static json_t *widening_json(const cp_widening *w)
{
    return json_pack("{s:o, s:f, s:f}", "dispersion", cp_number_json(w->dispersion_1), "freedom",
                     w->freedom, "variance_factor", w->factor_1);
}

// Crashes above a severity: at the x of the options, and the curve as columns.
static json_t *exceedance_json(const cp_variant_figures *v)
{
    json_t *object = json_object();
    for (int what = 0; what < CP_EXCEEDED_COUNT; what++) {
        const cp_exceedance *e = &v->above[what];
        json_t *x = json_array(), *crashes = json_array(), *rate = json_array();
        json_t *low = json_array(), *high = json_array(), *least = json_array();
        json_t *most = json_array();
        for (size_t k = 0; k < CP_EXCEEDANCE_POINTS; k++) {
            const cp_exceedance *p = &v->curve[what][k];
            json_array_append_new(x, cp_number_json(p->x));
            json_array_append_new(crashes, json_integer((json_int_t)p->crashes));
            json_array_append_new(rate, cp_number_json(p->rate));
            json_array_append_new(low, cp_number_json(p->interval.low));
            json_array_append_new(high, cp_number_json(p->interval.high));
            json_array_append_new(least, json_integer((json_int_t)p->least));
            json_array_append_new(most, json_integer((json_int_t)p->most));
        }
        json_t *curve = json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "x", x, "crashes", crashes,
                                  "per_million_km", rate, "low", low, "high", high, "at_least",
                                  least, "at_most", most);
        json_object_set_new(object, CP_EXCEEDED_TEXT[what],
                            json_pack("{s:f, s:I, s:I, s:I, s:o, s:o, s:o}", "x", e->x, "crashes",
                                      (json_int_t)e->crashes, "at_least", (json_int_t)e->least,
                                      "at_most", (json_int_t)e->most, "per_million_km",
                                      cp_number_json(e->rate), "interval",
                                      cp_interval_json(e->interval), "curve", curve));
    }
    return object;
}

static json_t *exceedance_ratios_json(const cp_contrast_figures *c)
{
    json_t *object = json_object();
    for (int what = 0; what < CP_EXCEEDED_COUNT; what++) {
        const cp_exceedance_ratio *r = &c->above[what];
        json_object_set_new(object, CP_EXCEEDED_TEXT[what],
                            json_pack("{s:f, s:[I, I], s:o, s:o, s:[o, o], s:[o, o]}", "x", r->x,
                                      "crashes", (json_int_t)r->crashes[0],
                                      (json_int_t)r->crashes[1], "ratio", cp_number_json(r->ratio),
                                      "interval", cp_interval_json(r->interval), "bounds",
                                      cp_number_json(r->bound[0]), cp_number_json(r->bound[1]),
                                      "bound_intervals", cp_interval_json(r->bound_interval[0]),
                                      cp_interval_json(r->bound_interval[1])));
    }
    return object;
}

static json_t *variant_json(const cp_study_data *data, const cp_comparison *comparison,
                            const cp_variant_figures *v)
{
    json_t *rate = json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:o}", "value", cp_number_json(v->rate), "interval",
        cp_interval_json(cp_rate_interval(v)), "widened", cp_interval_json(v->rate_widened),
        "bootstrap", cp_interval_json(v->rate_bootstrap), "widening",
        widening_json(&v->rate_widening), "precision", precision_json(v->rate_precision));
    double share = v->frontal_vehicles ? (double)v->inside / (double)v->frontal_vehicles : NAN;
    json_t *object = json_pack(
        "{s:s, s:b, s:I, s:f, s:f, s:I, s:I, s:I, s:o, s:I, s:I, s:I, s:o}", "variant",
        data->variant[v->variant].name, "is_baseline", v->variant == comparison->baseline,
        "replications", (json_int_t)v->replications, "vehicle_km", v->vehicle_km, "vehicle_h",
        v->vehicle_h, "crashes", (json_int_t)v->crashes, "frontal_crashes",
        (json_int_t)v->frontal_crashes, "front_front_inside", (json_int_t)v->front_front_inside,
        "frontal_crashes_per_million_km", rate, "frontal_vehicles", (json_int_t)v->frontal_vehicles,
        "simulation_failed", (json_int_t)v->simulation_failed, "inside_validity",
        (json_int_t)v->inside, "share_inside_validity", cp_number_json(share));
    for (int q = 0; q < CP_QUANTITY_COUNT; q++)
        json_object_set_new(object, QUANTITY[q], scopes_json(v, q));
    json_object_set_new(object, "expected_injured_drivers", injuries_json(data, v));
    json_object_set_new(object, "crashes_above", exceedance_json(v));
    if (v->olc_median_model.sets > 0)
        json_object_set_new(object, "model_uncertainty",
                            json_pack("{s:I, s:o}", "without_sets", (json_int_t)v->without_sets,
                                      "olc_median_g", model_part_json(&v->olc_median_model)));
    if (v->field)
        json_object_set_new(object, "field", cp_field_variant_json(data, v->field));
    return object;
}

static json_t *superiority_json(const cp_superiority *s)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:s}", "cliffs_delta",
                     cp_number_json(s->cliffs_delta), "interval", cp_interval_json(s->interval),
                     "standard_error", cp_number_json(s->standard_error), "freedom",
                     cp_number_json(s->freedom), "p", cp_number_json(s->p), "status",
                     cp_interval_status_text(s->status));
}

static json_t *severity_json(const cp_contrast *c, double p_holm, double distance_p_holm)
{
    return json_pack(
        "{s:[I, I], s:[o, o], s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "compared",
        (json_int_t)c->compared[0], (json_int_t)c->compared[1], "medians",
        estimate_json(c->median[0]), estimate_json(c->median[1]), "mean_difference",
        estimate_json(c->mean_difference), "mean_interval", cp_interval_json(c->mean_interval),
        "median_difference", estimate_json(c->median_difference), "median_interval",
        cp_interval_json(c->median_interval), "p90_difference", estimate_json(c->p90_difference),
        "p90_interval", cp_interval_json(c->p90_interval), "superiority",
        superiority_json(&c->superiority), "p_holm", cp_number_json(p_holm), "distance",
        cp_number_json(c->distance), "distance_p", cp_number_json(c->distance_p), "distance_p_holm",
        cp_number_json(distance_p_holm));
}

static json_t *contrast_json(const cp_study_data *data, const cp_contrast_figures *c)
{
    json_t *object = json_pack(
        "{s:s, s:b, s:I, s:I, s:[I, I], s:[I, I], s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}",
        "variant", data->variant[c->variant].name, "paired", data->paired, "baseline_replications",
        (json_int_t)c->replications[0], "treatment_replications", (json_int_t)c->replications[1],
        "without_partner", (json_int_t)c->partnerless[0], (json_int_t)c->partnerless[1],
        "frontal_crashes", (json_int_t)c->frontal_crashes[0], (json_int_t)c->frontal_crashes[1],
        "rate_ratio", cp_number_json(c->rate_ratio), "rate_ratio_interval",
        cp_interval_json(cp_rate_ratio_interval(c)), "rate_ratio_widened",
        cp_interval_json(c->rate_ratio_widened), "rate_ratio_widening",
        widening_json(&c->rate_ratio_widening), "rate_ratio_bootstrap",
        cp_interval_json(c->rate_ratio_bootstrap), "rate_ratio_precision",
        precision_json(c->rate_ratio_precision), "rate_p", cp_number_json(c->rate_p), "rate_p_holm",
        cp_number_json(c->rate_p_holm));
    for (int q = 0; q < CP_QUANTITIES_COMPARED; q++)
        json_object_set_new(
            object, QUANTITY[q],
            severity_json(&c->severity[q], c->severity_p_holm[q], c->distance_p_holm[q]));
    json_object_set_new(object, "olc_bounds",
                        json_pack("[o, o]", superiority_json(&c->olc_bound[0]),
                                  superiority_json(&c->olc_bound[1])));
    json_object_set_new(object, "crashes_above", exceedance_ratios_json(c));
    json_object_set_new(object, "injury_benefit", benefits_json(data, c->benefit));
    if (c->median_model.sets > 0)
        json_object_set_new(object, "model_uncertainty",
                            json_pack("{s:o, s:o}", "olc_median_difference_g",
                                      model_part_json(&c->median_model), "olc_cliffs_delta",
                                      model_part_json(&c->delta_model)));
    if (c->class_vehicles[0] > 0)
        json_object_set_new(
            object, "class_error",
            json_pack("{s:o, s:[I, I], s:[I, I]}", "olc_mean_difference_se_g",
                      cp_number_json(c->class_error_g), "vehicles",
                      (json_int_t)c->class_vehicles[0], (json_int_t)c->class_vehicles[1], "without",
                      (json_int_t)c->class_without[0], (json_int_t)c->class_without[1]));
    if (c->field)
        json_object_set_new(object, "field", cp_field_contrast_json(data, c->field));
    return object;
}

static json_t *paired_json(const cp_paired *p, double p_holm)
{
    return json_pack(
        "{s:I, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "pairs", (json_int_t)p->count,
        "lower", (json_int_t)p->lower, "higher", (json_int_t)p->higher, "mean",
        cp_number_json(p->mean), "mean_interval", cp_interval_json(p->mean_interval),
        "hodges_lehmann", cp_number_json(p->hodges_lehmann), "hodges_lehmann_interval",
        cp_interval_json(p->hodges_lehmann_interval), "signed_rank_v",
        cp_number_json(p->signed_rank.statistic), "signed_rank_p", cp_number_json(p->signed_rank.p),
        "signed_rank_p_holm", cp_number_json(p_holm));
}

static json_t *counterfactual_json(const cp_study_data *data, const cp_counterfactual_figures *c)
{
    json_t *outcomes = json_object(), *by_olc = json_object(), *reasons = json_object();
    json_t *shares = json_object(), *olc = json_object(), *speed = json_object();
    for (int o = 0; o <= CP_OUTCOME_NO_OLC; o++) {
        const char *name = cp_outcome_text((cp_outcome)o);
        json_object_set_new(by_olc, name, json_integer((json_int_t)c->outcome_olc[o]));
        if (o < CP_OUTCOME_NO_OLC)
            json_object_set_new(outcomes, name, json_integer((json_int_t)c->outcome[o]));
        if (o != CP_OUTCOME_INVALID && o < CP_OUTCOME_NO_OLC)
            json_object_set_new(shares, name, cp_interval_json(c->share[o]));
    }
    for (int r = CP_NULL_REPRODUCED + 1; r <= CP_NULL_NOT_REPRODUCED; r++)
        json_object_set_new(reasons, cp_null_status_text((cp_null_status)r),
                            json_integer((json_int_t)c->reason[r]));
    for (int which = 0; which < CP_PAIRED_COUNT; which++) {
        json_object_set_new(olc, CP_PAIRED_TEXT[which],
                            paired_json(&c->olc_g[which], c->p_holm[which]));
        json_object_set_new(speed, CP_PAIRED_TEXT[which],
                            paired_json(&c->closing_speed_m_s[which], c->speed_p_holm[which]));
    }
    json_t *model = json_object();
    for (int which = 0; which < CP_PAIRED_COUNT && c->olc_model[which].sets > 0; which++)
        json_object_set_new(model, CP_PAIRED_TEXT[which], model_part_json(&c->olc_model[which]));
    json_t *inside = json_object(), *inside_shares = json_object();
    for (int o = 0; o < CP_OUTCOME_NO_OLC; o++) {
        const char *name = cp_outcome_text((cp_outcome)o);
        json_object_set_new(inside, name, json_integer((json_int_t)c->inside_outcome[o]));
        if (o != CP_OUTCOME_INVALID)
            json_object_set_new(inside_shares, name, cp_interval_json(c->inside_share[o]));
    }
    json_t *of_inside =
        json_pack("{s:I, s:I, s:I, s:o, s:o, s:o}", "crashes", (json_int_t)c->inside_crashes,
                  "valid", (json_int_t)c->inside_valid, "treated_outside",
                  (json_int_t)c->inside_treated_outside, "outcomes", inside, "shares",
                  inside_shares, "olc_change_g", paired_json(&c->inside_olc_g, NAN));
    json_t *object =
        json_pack("{s:s, s:I, s:I, s:o, s:o, s:o, s:o, s:f, s:o, s:o, s:o, s:o}", "variant",
                  data->variant[c->variant].name, "crashes", (json_int_t)c->crashes, "valid",
                  (json_int_t)c->valid, "outcomes", outcomes, "shares", shares, "outcomes_by_olc",
                  by_olc, "invalid_reasons", reasons, "new_crashes", c->new_crashes, "olc_change_g",
                  olc, "closing_speed_change_m_s", speed, "baseline_inside", of_inside,
                  "injury_benefit", benefits_json(data, c->benefit));
    json_object_set_new(object, "vanished_crashes", cp_number_json(c->vanished_crashes));
    if (json_object_size(model) > 0)
        json_object_set_new(object, "model_uncertainty", json_pack("{s:O}", "olc_change_g", model));
    json_decref(model);
    if (c->field)
        json_object_set_new(object, "field", cp_field_contrast_json(data, c->field));
    return object;
}

json_t *cp_comparison_json(const cp_study_data *data, const cp_comparison *comparison)
{
    json_t *variants = json_array(), *contrasts = json_array(), *pairs = json_array();
    for (size_t k = 0; k < comparison->variant_count; k++)
        json_array_append_new(variants, variant_json(data, comparison, &comparison->variant[k]));
    for (size_t k = 0; k < comparison->contrast_count; k++)
        json_array_append_new(contrasts, contrast_json(data, &comparison->contrast[k]));
    for (size_t k = 0; k < comparison->counterfactual_count; k++)
        json_array_append_new(pairs, counterfactual_json(data, &comparison->counterfactual[k]));

    // An array that is short of a row would be a wrong result: then none at all.
    if (json_array_size(variants) != comparison->variant_count ||
        json_array_size(contrasts) != comparison->contrast_count ||
        json_array_size(pairs) != comparison->counterfactual_count) {
        json_decref(variants);
        json_decref(contrasts);
        json_decref(pairs);
        return NULL;
    }
    cp_slice slice = comparison->slice;
    return json_pack("{s:s?, s:s?, s:s, s:o, s:o, s:o}", "scenario",
                     slice.scenario == CP_SLICE_ALL ? NULL : data->scenario[slice.scenario].name,
                     "crash_type",
                     slice.crash_type == CP_SLICE_ALL ? NULL : data->crash_type[slice.crash_type],
                     "baseline", data->variant[comparison->baseline].name, "variants", variants,
                     "contrasts", contrasts, "counterfactual", pairs);
}
