/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/quantity.h"

#include "analysis/field_quantity.h"
#include "core/units.h"

#include <math.h>
#include <stdio.h>

static cp_estimate counted(size_t value)
{
    return cp_estimate_of((double)value);
}

/* Where rows go, and what they have in common. */
typedef struct writer {
    cp_quantities *list;
    const char *section;
    int scope;
    double factor;
} writer;

static cp_quantity *add(const writer *w, const char *name, const char *label, int digits,
                        cp_estimate estimate)
{
    cp_quantity *q = cp_quantities_append(w->list);
    *q = (cp_quantity){.section = w->section,
                       .scope = w->scope,
                       .digits = digits,
                       .factor = w->factor,
                       .estimate = estimate};
    snprintf(q->name, sizeof q->name, "%s", name);
    snprintf(q->label, sizeof q->label, "%s", label ? label : "");
    return q;
}

// The row so many from the end.
static cp_quantity *last(cp_quantities *list, size_t back)
{
    return list->failed ? &list->spare : &list->row[list->count - back];
}

static void add_interval(const writer *w, const char *name, const char *label, int digits,
                         cp_estimate estimate, const char *kind, cp_interval interval)
{
    cp_quantity *q = add(w, name, label, digits, estimate);
    q->kind = kind;
    q->interval = interval;
}

/* How the quantities are called, in the order of cp_slice_quantity. */
static const struct {
    const char *name;
    const char *unit;
    const char *section;
    double factor; /* of the table */
    int digits;
    bool whole; /* all figures in the table, not only mean, median, p90 */
} QUANTITY[CP_QUANTITY_COUNT] = {
    {"olc", "g", "OLC, g", 1.0, 1, true},
    {"delta_v", "m_s", "delta-v, km/h", 3.6, 1, false},
    {"closing_speed", "m_s", "closing speed, km/h", 3.6, 1, false},
    {"lateral_offset", "m", "lateral offset, mm", 1000.0, 0, false},
    {"angle", "rad", "angle, degrees", 180.0 / CP_PI, 0, false},
};

// ---- figures of a variant --------------------------------------------------------------------

static void add_description(const writer *w, int q, const cp_description *d,
                            const cp_interval *mean_interval)
{
    char name[CP_QUANTITY_TEXT_SIZE];
    const char *of = QUANTITY[q].name, *unit = QUANTITY[q].unit;
    // Side by side, those inside validity would be compared: the table has none of them.
    bool whole = QUANTITY[q].whole, labelled = w->scope != CP_SCOPE_INSIDE;
    int digits = QUANTITY[q].digits;
    const writer count = {w->list, w->section, w->scope, 1.0};
    const struct {
        const char *part;
        const char *label;
        bool always;
        cp_estimate estimate;
    } rows[] = {
        {"mean", "  mean", true, d->mean_of_all}, {"sd", "  sd", false, cp_estimate_of(d->sd)},
        {"min", "  min", false, d->minimum},      {"q25", "  25 %", false, d->q25},
        {"median", "  median", true, d->median},  {"q75", "  75 %", false, d->q75},
        {"p90", "  90 %", true, d->p90},          {"p95", "  95 %", false, d->p95},
        {"max", "  max", false, d->maximum},
    };
    add(&count, cp_quantity_text(name, "%s_n", of), whole && labelled ? "  n" : NULL, 0,
        counted(d->count));
    add(&count, cp_quantity_text(name, "%s_censored", of),
        whole && labelled ? "  left-censored" : NULL, 0, counted(d->censored));
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        add(w, cp_quantity_text(name, "%s_%s_%s", of, rows[k].part, unit),
            labelled && (whole || rows[k].always) ? rows[k].label : NULL, digits, rows[k].estimate);
    if (mean_interval) {
        cp_quantity *mean = last(w->list, sizeof rows / sizeof *rows);
        mean->kind = "bootstrap";
        mean->interval = *mean_interval;
    }
}

// Counts taken for Poisson's, and whether their interval is widened by what they scatter more.
static const char *widened_kind(const cp_widening *widening)
{
    return isnan(widening->dispersion_1) ? "poisson" : "poisson widened";
}

static void add_rates(const writer *w, const cp_variant_figures *v)
{
    double share = v->frontal_vehicles ? (double)v->inside / (double)v->frontal_vehicles : NAN;
    add(w, "replications", "replications", 0, counted(v->replications));
    add(w, "vehicle_km", "vehicle-km", 1, cp_estimate_of(v->vehicle_km));
    add(w, "vehicle_h", "vehicle-h", 1, cp_estimate_of(v->vehicle_h));
    add(w, "crashes", "crashes", 0, counted(v->crashes));
    add(w, "frontal_crashes", "frontal crashes", 0, counted(v->frontal_crashes));
    add(w, "front_front_inside", "  front-front inside validity", 0,
        counted(v->front_front_inside));
    add_interval(w, "frontal_crashes_per_million_km", "frontal crashes per 10^6 veh-km", 0,
                 cp_estimate_of(v->rate), "bootstrap", v->rate_bootstrap);
    add_interval(w, "frontal_crashes_per_million_km_widened", NULL, 0, cp_estimate_of(v->rate),
                 widened_kind(&v->rate_widening), v->rate_widened);
    last(w->list, 1)->second = true;
    add(w, "dispersion", "  dispersion over replications", 2,
        cp_estimate_of(v->rate_widening.dispersion_1));
    add(w, "frontal_crashes_per_million_km_half_width_1", "  half-width, share of the rate", 2,
        cp_estimate_of(v->rate_precision.relative_1));
    add(w, "replications_for_rate_within_10_percent", "  replications in all for +-10 %", 0,
        cp_estimate_of(v->rate_precision.replications_needed));
    add(w, "frontal_vehicles", "vehicles struck on the front", 0, counted(v->frontal_vehicles));
    add(w, "simulation_failed", "  crash simulation failed", 0, counted(v->simulation_failed));
    add(w, "share_inside_validity", "  share inside validity", 2, cp_estimate_of(share));
}

/* How severities that are exceeded are called. */
static const struct {
    const char *unit; /* of the table */
    double factor;    /* of the table over SI */
    const char *label;
} EXCEEDED[CP_EXCEEDED_COUNT] = {{"g", 1.0, "OLC"}, {"km_h", 3.6, "delta-v"}};

// "olc_above_15_g".
static const char *exceeded_name(int what, double x, char text[CP_QUANTITY_TEXT_SIZE])
{
    return cp_quantity_text(text, "%s_above_%g_%s", CP_EXCEEDED_TEXT[what],
                            cp_quantity_rounded(x * EXCEEDED[what].factor), EXCEEDED[what].unit);
}

static const char *exceeded_label(int what, double x, char text[CP_QUANTITY_TEXT_SIZE])
{
    return cp_quantity_text(text, "frontal crashes above %s %g %s", EXCEEDED[what].label,
                            cp_quantity_rounded(x * EXCEEDED[what].factor),
                            what == CP_EXCEEDED_DELTA_V ? "km/h" : "g");
}

static void add_exceedance(const writer *w, int what, const cp_exceedance *e)
{
    char of[CP_QUANTITY_TEXT_SIZE], name[CP_QUANTITY_TEXT_SIZE], label[CP_QUANTITY_TEXT_SIZE];
    exceeded_name(what, e->x, of);
    add(w, cp_quantity_text(name, "crashes_%.60s", of), exceeded_label(what, e->x, label), 0,
        counted(e->crashes));
    add_interval(w, cp_quantity_text(name, "crashes_%.60s_per_million_km", of), "  per 10^6 veh-km",
                 0, cp_estimate_of(e->rate), "poisson widened", e->interval);
    add(w, cp_quantity_text(name, "crashes_%.60s_at_least", of),
        "  at least, outside range unknown", 0, counted(e->least));
    add(w, cp_quantity_text(name, "crashes_%.60s_at_most", of), "  at most", 0, counted(e->most));
}

static void add_injuries(const cp_study_data *data, writer w, const cp_injury_figures *injury)
{
    char name[CP_QUANTITY_TEXT_SIZE], label[CP_QUANTITY_TEXT_SIZE];
    w.section = "injured drivers expected per 10^6 veh-km";
    for (size_t k = 0; k < data->risk_count; k++) {
        const cp_study_risk *risk = &data->risk[k];
        add(&w, cp_quantity_text(name, "expected_injured_%.30s_%.20s", risk->name, risk->level),
            NULL, 2, cp_estimate_of(injury[k].expected));
        add_interval(&w,
                     cp_quantity_text(name, "expected_injured_per_million_km_%.30s_%.20s",
                                      risk->name, risk->level),
                     w.scope == CP_SCOPE_INSIDE
                         ? NULL
                         : cp_quantity_text(label, "  %.30s (%.30s)", risk->level, risk->name),
                     1, cp_estimate_of(injury[k].rate), cp_injury_kind(risk),
                     injury[k].rate_interval);
        add(&w,
            cp_quantity_text(name, "expected_injured_risk_se_1_%.30s_%.20s", risk->name,
                             risk->level),
            NULL, 3, cp_estimate_of(injury[k].parameters_se_1));
    }
}

/* How the model's part of a figure is called: "olc_median" + "_with_model" + "_g". */
typedef struct model_names {
    const char *of;
    const char *unit; /* with its underscore */
    const char *label;
    const char *kind; /* of the interval from replications */
    int digits;
} model_names;

// The estimate with both intervals, then what the sets say.
static void add_model_part(const writer *w, const model_names *n, const cp_model_part *part)
{
    char name[CP_QUANTITY_TEXT_SIZE];
    if (part->sets == 0)
        return;
    const char *missing =
        part->status == CP_INTERVAL_VALUE ? NULL : cp_interval_status_text(part->status);
    add_interval(w, cp_quantity_text(name, "%s_with_model%s", n->of, n->unit), n->label, n->digits,
                 part->estimate, "replications and model", part->combined);
    add_interval(w, cp_quantity_text(name, "%s_by_replications%s", n->of, n->unit), NULL, n->digits,
                 part->estimate, n->kind, part->replications);
    last(w->list, 1)->second = true;
    add(w, cp_quantity_text(name, "%s_model_half_width%s", n->of, n->unit),
        "    95 % half-width, model", n->digits, cp_estimate_of(part->half_width));
    last(w->list, 1)->missing = missing;
    add(w, cp_quantity_text(name, "%s_model_sd%s", n->of, n->unit), "    sd over parameter sets",
        n->digits + 1, cp_estimate_of(part->sd));
    last(w->list, 1)->missing = missing;
    add(w, cp_quantity_text(name, "%s_model_mean%s", n->of, n->unit),
        "    mean over parameter sets", n->digits, cp_estimate_of(part->mean));
    last(w->list, 1)->missing = missing;
}

static const char MODEL_SECTION[] = "OLC with the uncertainty of its model, g";

static void add_model_of_variant(cp_quantities *list, const cp_variant_figures *figures)
{
    static const model_names MEDIAN = {"olc_median", "_g", "  median", "bootstrap", 1};
    const writer w = {list, MODEL_SECTION, CP_SCOPE_ALL, 1.0};
    if (figures->olc_median_model.sets == 0)
        return;
    add(&w, "olc_model_sets", "  parameter sets", 0, counted(figures->olc_median_model.sets));
    add(&w, "olc_model_without_sets", "  vehicles without, certain here", 0,
        counted(figures->without_sets));
    add_model_part(&w, &MEDIAN, &figures->olc_median_model);
}

void cp_quantities_of_variant(const cp_study_data *data, const cp_variant_figures *figures,
                              cp_quantities *list)
{
    writer w = {list, NULL, -1, 1.0};
    add_rates(&w, figures);
    for (int what = 0; what < CP_EXCEEDED_COUNT; what++)
        add_exceedance(&w, what, &figures->above[what]);
    for (w.scope = 0; w.scope < CP_SCOPE_COUNT; w.scope++) {
        for (int q = 0; q < CP_QUANTITY_COUNT; q++) {
            w.section = QUANTITY[q].section;
            w.factor = QUANTITY[q].factor;
            add_description(&w, q, &figures->description[q][w.scope],
                            q == CP_QUANTITY_OLC ? &figures->olc_mean_interval[w.scope] : NULL);
            if (q != CP_QUANTITY_OLC)
                continue;
            add(&w, "olc_ecdf_band_half_width_1", NULL, 3,
                cp_estimate_of(figures->olc_band[w.scope].half_width_1));
            add(&w, "replications_for_olc_mean_within_10_percent",
                w.scope == CP_SCOPE_INSIDE ? NULL : "  replications in all for mean +-10 %", 0,
                cp_estimate_of(figures->olc_mean_precision[w.scope].replications_needed));
        }
        w.factor = 1.0;
        add_injuries(data, w, figures->injury[w.scope]);
    }
    add_model_of_variant(list, figures);
    cp_field_quantities_of_variant(data, figures->field, list);
}

// A p-value, or why there is none.
static void add_test(const writer *w, const char *name, const char *label, double p,
                     cp_interval_status why)
{
    cp_quantity *q = add(w, name, label, 4, cp_estimate_of(p));
    q->missing = isnan(p) && why != CP_INTERVAL_VALUE ? cp_interval_status_text(why) : NULL;
}

// ---- figures of a contrast -------------------------------------------------------------------

static void add_contrast(const writer *w, int q, const cp_contrast_figures *figures)
{
    char name[CP_QUANTITY_TEXT_SIZE];
    const cp_contrast *c = &figures->severity[q];
    const char *of = QUANTITY[q].name, *unit = QUANTITY[q].unit;
    int digits = QUANTITY[q].digits;
    const writer pure = {w->list, w->section, w->scope, 1.0};
    bool whole = QUANTITY[q].whole;
    static const char *const SIDE[] = {"baseline", "treatment"};
    for (int g = 0; g < 2; g++) {
        char label[CP_QUANTITY_TEXT_SIZE];
        add(&pure, cp_quantity_text(name, "%s_n_compared_%s", of, SIDE[g]), NULL, 0,
            counted(c->compared[g]));
        add(w, cp_quantity_text(name, "%s_median_%s_%s", of, SIDE[g], unit),
            cp_quantity_text(label, "  median, %s, same mix of scenarios", SIDE[g]), digits,
            c->median[g]);
    }
    add_interval(w, cp_quantity_text(name, "%s_median_difference_%s", of, unit),
                 "  difference of medians", digits, c->median_difference, "bootstrap",
                 c->median_interval);
    add_interval(w, cp_quantity_text(name, "%s_mean_difference_%s", of, unit),
                 "  difference of means", digits, c->mean_difference, "bootstrap",
                 c->mean_interval);
    add_interval(w, cp_quantity_text(name, "%s_p90_difference_%s", of, unit),
                 whole ? "  difference of 90 % quantiles" : NULL, digits, c->p90_difference,
                 "bootstrap", c->p90_interval);
    const cp_superiority *s = &c->superiority;
    add_interval(&pure, cp_quantity_text(name, "%s_cliffs_delta", of), "  Cliff's delta", 2,
                 cp_estimate_of(s->cliffs_delta), "jackknife", s->interval);
    if (q == CP_QUANTITY_OLC) {
        const cp_superiority *bound = figures->olc_bound;
        add_interval(&pure, "olc_cliffs_delta_at_least", "    at least, outside range unknown", 2,
                     cp_estimate_of(bound[0].cliffs_delta), "jackknife", bound[0].interval);
        add_interval(&pure, "olc_cliffs_delta_at_most", "    at most", 2,
                     cp_estimate_of(bound[1].cliffs_delta), "jackknife", bound[1].interval);
    }
    add_test(&pure, cp_quantity_text(name, "%s_mann_whitney_p", of),
             "  p (Mann-Whitney, studentised)", s->p, s->status);
    add(&pure, cp_quantity_text(name, "%s_mann_whitney_p_holm", of), "  p, Holm", 4,
        cp_estimate_of(figures->severity_p_holm[q]));
    add(&pure, cp_quantity_text(name, "%s_kolmogorov_smirnov_d", of),
        whole ? "  largest distance of ECDFs" : NULL, 2, cp_estimate_of(c->distance));
    add_test(&pure, cp_quantity_text(name, "%s_kolmogorov_smirnov_p", of),
             whole ? "  p (Kolmogorov-Smirnov, bootstrap)" : NULL, c->distance_p,
             s->status == CP_INTERVAL_VALUE ? CP_INTERVAL_TOO_FEW_REPLICATIONS : s->status);
    add(&pure, cp_quantity_text(name, "%s_kolmogorov_smirnov_p_holm", of),
        whole ? "  p, Holm" : NULL, 4, cp_estimate_of(figures->distance_p_holm[q]));
}

static cp_estimate bounded(double bound)
{
    return cp_estimate_of(isfinite(bound) ? bound : NAN);
}

static void add_benefits(const cp_study_data *data, const writer *w,
                         const cp_benefit_figures *benefit)
{
    char name[CP_QUANTITY_TEXT_SIZE], label[CP_QUANTITY_TEXT_SIZE];
    const writer percent = {w->list, "benefit, % fewer injured drivers expected", w->scope, 100.0};
    for (size_t k = 0; k < data->risk_count; k++) {
        const cp_study_risk *risk = &data->risk[k];
        add_interval(
            &percent, cp_quantity_text(name, "benefit_1_%.30s_%.30s", risk->name, risk->level),
            cp_quantity_text(label, "  %.30s (%.30s)", risk->level, risk->name), 1,
            cp_estimate_of(benefit[k].benefit_1), cp_injury_kind(risk), benefit[k].interval);
        add(&percent,
            cp_quantity_text(name, "benefit_at_least_1_%.30s_%.30s", risk->name, risk->level),
            "    at least, outside range unknown", 1, bounded(benefit[k].bound[0]));
        add(&percent,
            cp_quantity_text(name, "benefit_at_most_1_%.30s_%.30s", risk->name, risk->level),
            "    at most", 1, bounded(benefit[k].bound[1]));
    }
}

static void add_model_of_contrast(cp_quantities *list, const cp_contrast_figures *figures)
{
    static const model_names MEDIAN = {"olc_median_difference", "_g", "  difference of medians",
                                       "bootstrap", 1};
    static const model_names DELTA = {"olc_cliffs_delta", "", "  Cliff's delta", "jackknife", 2};
    const writer w = {list, MODEL_SECTION, CP_SCOPE_ALL, 1.0};
    add_model_part(&w, &MEDIAN, &figures->median_model);
    add_model_part(&w, &DELTA, &figures->delta_model);
    if (figures->class_vehicles[0] == 0 || isnan(figures->class_error_g))
        return;
    add(&w, "olc_class_error_g", "  standard error of a difference of means, by classes of tests",
        2, cp_estimate_of(figures->class_error_g));
    add(&w, "olc_class_unknown", "    vehicles without a class, their error unknown", 0,
        counted(figures->class_without[0] + figures->class_without[1]));
}

void cp_quantities_of_contrast(const cp_study_data *data, const cp_contrast_figures *figures,
                               cp_quantities *list)
{
    writer w = {list, NULL, -1, 1.0};
    add(&w, "baseline_replications_compared", "replications compared, baseline", 0,
        counted(figures->replications[0]));
    add(&w, "replications_compared", "replications compared", 0, counted(figures->replications[1]));
    add(&w, "replications_without_partner", "  finished without a partner, left out", 0,
        counted(figures->partnerless[0] + figures->partnerless[1]));
    add_interval(&w, "rate_ratio", "rate ratio of frontal crashes", 2,
                 cp_estimate_of(figures->rate_ratio), "bootstrap", figures->rate_ratio_bootstrap);
    add_interval(&w, "rate_ratio_widened", NULL, 2, cp_estimate_of(figures->rate_ratio),
                 widened_kind(&figures->rate_ratio_widening), figures->rate_ratio_widened);
    last(w.list, 1)->second = true;
    add(&w, "rate_ratio_dispersion", "  dispersion of the ratio", 2,
        cp_estimate_of(figures->rate_ratio_widening.dispersion_1));
    add(&w, "rate_p", "  p", 4, cp_estimate_of(figures->rate_p));
    add(&w, "rate_p_holm", "  p, Holm", 4, cp_estimate_of(figures->rate_p_holm));
    add(&w, "replications_for_rate_ratio_within_10_percent", "  replications in all for +-10 %", 0,
        cp_estimate_of(figures->rate_ratio_precision.replications_needed));
    for (int what = 0; what < CP_EXCEEDED_COUNT; what++) {
        char of[CP_QUANTITY_TEXT_SIZE], name[CP_QUANTITY_TEXT_SIZE], label[CP_QUANTITY_TEXT_SIZE];
        char text[CP_QUANTITY_TEXT_SIZE];
        const cp_exceedance_ratio *r = &figures->above[what];
        exceeded_name(what, r->x, of);
        add_interval(
            &w, cp_quantity_text(name, "rate_ratio_%.60s", of),
            cp_quantity_text(label, "rate ratio of %.60s", exceeded_label(what, r->x, text)), 2,
            cp_estimate_of(r->ratio), "poisson widened", r->interval);
        add_interval(&w, cp_quantity_text(name, "rate_ratio_%.60s_at_least", of),
                     "    at least, outside range unknown", 2, bounded(r->bound[0]),
                     "poisson widened", r->bound_interval[0]);
        add_interval(&w, cp_quantity_text(name, "rate_ratio_%.60s_at_most", of), "    at most", 2,
                     bounded(r->bound[1]), "poisson widened", r->bound_interval[1]);
    }
    w.scope = CP_SCOPE_ALL;
    for (int q = 0; q < CP_QUANTITIES_COMPARED; q++) {
        w.section = QUANTITY[q].section;
        w.factor = QUANTITY[q].factor;
        add_contrast(&w, q, figures);
    }
    add_model_of_contrast(list, figures);
    w.factor = 1.0;
    add_benefits(data, &w, figures->benefit);
    cp_field_quantities_of_contrast(data, figures->field, list);
}

// ---- figures of counterfactual pairs -----------------------------------------------------------

static void add_paired(const writer *w, const char *of, const char *unit, const char *which,
                       const cp_paired *paired, double p_holm)
{
    char name[CP_QUANTITY_TEXT_SIZE];
    const writer pure = {w->list, w->section, -1, 1.0};
    add(&pure, cp_quantity_text(name, "paired_%s_%s_n", of, which), "  pairs", 0,
        counted(paired->count));
    add_interval(w, cp_quantity_text(name, "paired_%s_%s_hodges_lehmann_%s", of, which, unit),
                 "  change, Hodges-Lehmann", 1, cp_estimate_of(paired->hodges_lehmann), "bootstrap",
                 paired->hodges_lehmann_interval);
    add_interval(w, cp_quantity_text(name, "paired_%s_%s_mean_%s", of, which, unit),
                 "  mean change", 1, cp_estimate_of(paired->mean), "bootstrap",
                 paired->mean_interval);
    add(&pure, cp_quantity_text(name, "paired_%s_%s_lower", of, which), "  pairs with less", 0,
        counted(paired->lower));
    add(&pure, cp_quantity_text(name, "paired_%s_%s_higher", of, which), "  pairs with more", 0,
        counted(paired->higher));
    add(&pure, cp_quantity_text(name, "paired_%s_%s_signed_rank_v", of, which), NULL, 1,
        cp_estimate_of(paired->signed_rank.statistic));
    add(&pure, cp_quantity_text(name, "paired_%s_%s_signed_rank_p", of, which),
        "  p (signed rank, by replication)", 4, cp_estimate_of(paired->signed_rank.p));
    add(&pure, cp_quantity_text(name, "paired_%s_%s_signed_rank_p_holm", of, which), "  p, Holm", 4,
        cp_estimate_of(p_holm));
}

// Of the crashes that were inside validity with the baseline, before any treatment.
static void add_pairs_inside(const writer *w, const cp_counterfactual_figures *figures)
{
    char name[CP_QUANTITY_TEXT_SIZE], label[CP_QUANTITY_TEXT_SIZE];
    writer in = *w;
    in.section = "baseline crash inside validity";
    add(&in, "inside_pairs", "  crashes", 0, counted(figures->inside_crashes));
    add(&in, "inside_valid_pairs", "  valid pairs", 0, counted(figures->inside_valid));
    add(&in, "inside_treated_outside", "  of these outside with the treatment", 0,
        counted(figures->inside_treated_outside));
    for (int o = CP_OUTCOME_CHANGED_OPPONENT; o < CP_OUTCOME_NO_OLC; o++) {
        double valid = figures->inside_valid ? (double)figures->inside_valid : NAN;
        add_interval(&in,
                     cp_quantity_text(name, "inside_share_%s_1", cp_outcome_text((cp_outcome)o)),
                     cp_quantity_text(label, "  share %s", cp_outcome_text((cp_outcome)o)), 2,
                     cp_estimate_of((double)figures->inside_outcome[o] / valid), "binomial widened",
                     figures->inside_share[o]);
    }
    const cp_paired *olc = &figures->inside_olc_g;
    add_interval(&in, "inside_paired_olc_hodges_lehmann_g", "  change of OLC, g, avoided = 0 g", 1,
                 cp_estimate_of(olc->hodges_lehmann), "bootstrap", olc->hodges_lehmann_interval);
}

void cp_quantities_of_pairs(const cp_study_data *data, const cp_counterfactual_figures *figures,
                            cp_quantities *list)
{
    char name[CP_QUANTITY_TEXT_SIZE], label[CP_QUANTITY_TEXT_SIZE];
    writer w = {list, NULL, -1, 1.0};
    add(&w, "pairs", "frontal crashes of the baseline", 0, counted(figures->crashes));
    add(&w, "valid_pairs", "  valid pairs", 0, counted(figures->valid));
    for (int o = 0; o < CP_OUTCOME_NO_OLC; o++)
        add(&w, cp_quantity_text(name, "outcome_%s", cp_outcome_text((cp_outcome)o)),
            cp_quantity_text(label, "  %s", cp_outcome_text((cp_outcome)o)), 0,
            counted(figures->outcome[o]));
    for (int o = 0; o <= CP_OUTCOME_NO_OLC; o++)
        add(&w, cp_quantity_text(name, "outcome_by_olc_%s", cp_outcome_text((cp_outcome)o)),
            o == CP_OUTCOME_AGGRAVATED ? "  aggravated by OLC" : NULL, 0,
            counted(figures->outcome_olc[o]));
    for (int o = CP_OUTCOME_CHANGED_OPPONENT; o < CP_OUTCOME_NO_OLC; o++) {
        double share = figures->valid ? (double)figures->outcome[o] / (double)figures->valid : NAN;
        add_interval(&w, cp_quantity_text(name, "share_%s_1", cp_outcome_text((cp_outcome)o)),
                     cp_quantity_text(label, "  share %s", cp_outcome_text((cp_outcome)o)), 2,
                     cp_estimate_of(share), "binomial widened", figures->share[o]);
    }
    add_pairs_inside(&w, figures);
    for (int r = CP_NULL_REPRODUCED + 1; r <= CP_NULL_NOT_REPRODUCED; r++)
        add(&w, cp_quantity_text(name, "invalid_%s", cp_null_status_text((cp_null_status)r)), NULL,
            0, counted(figures->reason[r]));
    add(&w, "new_crashes", "new crashes between others", 0, cp_estimate_of(figures->new_crashes));
    add(&w, "vanished_crashes", "crashes between others that vanish", 0,
        cp_estimate_of(figures->vanished_crashes));
    // Of a crash the larger OLC of its frontally struck vehicles.
    static const char *const OLC[] = {"larger OLC of a crash, g, all valid pairs (avoided = 0 g)",
                                      "larger OLC of a crash, g, conditional on crashing"};
    static const char *const SPEED[] = {"closing speed, km/h, all valid pairs (avoided = 0)",
                                        "closing speed, km/h, conditional on crashing"};
    for (int which = 0; which < CP_PAIRED_COUNT; which++) {
        w.section = OLC[which];
        add_paired(&w, "olc", "g", CP_PAIRED_TEXT[which], &figures->olc_g[which],
                   figures->p_holm[which]);
        cp_quantity_text(name, "paired_olc_%s_hodges_lehmann", CP_PAIRED_TEXT[which]);
        add_model_part(&w, &(model_names){name, "_g", "  change, Hodges-Lehmann", "bootstrap", 1},
                       &figures->olc_model[which]);
    }
    for (int which = 0; which < CP_PAIRED_COUNT; which++) {
        writer speed = {list, SPEED[which], -1, 3.6};
        add_paired(&speed, "closing_speed", "m_s", CP_PAIRED_TEXT[which],
                   &figures->closing_speed_m_s[which], figures->speed_p_holm[which]);
    }
    w.section = NULL;
    add_benefits(data, &w, figures->benefit);
    cp_field_quantities_of_contrast(data, figures->field, list);
}
