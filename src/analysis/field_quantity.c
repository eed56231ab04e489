/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/field_quantity.h"

#include <math.h>
#include <stdio.h>

static const char SECTION[] = "weighted as the field";

/* How severities that are exceeded are called. */
static const struct {
    const char *name;
    const char *label;
    const char *unit;
    double factor; /* over SI */
} ABOVE[CP_EXCEEDED_COUNT] = {{"olc", "OLC", "g", 1.0},
                              {"delta_v_without_rebound", "delta-v without rebound", "km/h", 3.6}};

static void set_interval(cp_quantity *q, cp_interval interval, const char *kind)
{
    q->interval = interval;
    q->kind = kind;
}

/* A figure in up to three ways; labels of the rows below the first. */
typedef struct ways {
    const char *suffix[CP_FIELD_WAYS]; /* NULL: not there */
    double value[CP_FIELD_WAYS];
    cp_interval interval[CP_FIELD_WAYS];
    const char *missing; /* of the weighted one, where it is not given */
} ways;

// Weighted first, then with delta-v too, then without weights.
static void add_ways(cp_quantities *list, const char *name, const char *label, int digits,
                     double factor, const ways *w, const char *kind)
{
    static const int ORDER[CP_FIELD_WAYS] = {CP_FIELD_WEIGHTED, CP_FIELD_DELTA_V_TOO,
                                             CP_FIELD_PLAIN};
    static const char *const LABEL[CP_FIELD_WAYS] = {
        [CP_FIELD_PLAIN] = "    not weighted", [CP_FIELD_DELTA_V_TOO] = "    by delta-v too"};
    char own[CP_QUANTITY_TEXT_SIZE];
    for (int k = 0; k < CP_FIELD_WAYS; k++) {
        int way = ORDER[k];
        if (!w->suffix[way])
            continue;
        double value = w->value[way];
        cp_quantity *q = cp_quantities_add(
            list, SECTION, cp_quantity_text(own, "%.66s_%s", name, w->suffix[way]),
            LABEL[way] ? LABEL[way] : label, digits, factor, isfinite(value) ? value : NAN);
        if (isinf(value) && value < 0.0)
            q->missing = cp_interval_status_text(CP_INTERVAL_CENSORED);
        if (way == CP_FIELD_WEIGHTED && w->missing) {
            q->estimate = cp_estimate_of(NAN);
            q->missing = w->missing;
        }
        set_interval(q,
                     q->missing ? (cp_interval){CP_INTERVAL_UNDEFINED, NAN, NAN} : w->interval[way],
                     kind);
    }
}

// Of a variant: weighted (the baseline) and not.
static void add_both(cp_quantities *list, const cp_field_variant *v, const char *name,
                     const char *label, int digits, const double value[2],
                     const cp_interval interval[2], const char *kind)
{
    const ways w = {{"not_weighted", "as_field", NULL},
                    {value[0], value[1], NAN},
                    {interval[0], interval[1], {CP_INTERVAL_UNDEFINED, NAN, NAN}},
                    v->weighted ? NULL : "of the baseline only"};
    add_ways(list, name, label, digits, 1.0, &w, kind);
}

// ---- a variant's vehicles beside the field's: CSV and database only -----------------------------

static void add_shape(cp_quantities *list, const cp_field_shape *s)
{
    static const char *const NUMBER[CP_FIELD_VALUE_COUNT] = {"delta_v_km_h", "pdof_deg",
                                                             "overlap_1"};
    static const char *const OF[] = {"field", "study", "as_field"};
    char name[CP_QUANTITY_TEXT_SIZE];
    for (int m = 0; m < CP_FIELD_MARGIN_COUNT; m++)
        for (size_t k = 0; k < CP_FIELD_MARGIN_CLASSES[m]; k++) {
            const cp_field_class *c = &s->of[m][k];
            const double share[] = {c->field_1, c->study_1, c->weighted_1};
            for (int of = 0; of < 3; of++)
                cp_quantities_add(list, SECTION,
                                  cp_quantity_text(name, "share_%s_1_%s %s", OF[of],
                                                   CP_FIELD_MARGIN_TEXT[m],
                                                   cp_field_class_text((cp_field_margin)m, k)),
                                  "", 3, 1.0, share[of]);
        }
    for (int d = 0; d < 2; d++)
        cp_quantities_add(
            list, SECTION,
            cp_quantity_text(name, "crash_type_distance_1_%s", d ? "as_field" : "study"), "", 3,
            1.0, s->type_distance_1[d]);
    for (int v = 0; v < CP_FIELD_VALUE_COUNT; v++) {
        const cp_field_number *n = &s->number[v];
        for (int of = 0; of < 3; of++)
            cp_quantities_add(list, SECTION,
                              cp_quantity_text(name, "median_%s_%s", NUMBER[v], OF[of]), "", 1, 1.0,
                              n->median[of]);
        for (int d = 0; d < 2; d++) {
            cp_quantities_add(
                list, SECTION,
                cp_quantity_text(name, "largest_distance_1_%s_%s", NUMBER[v], OF[d + 1]), "", 3,
                1.0, n->distance[d].largest_1);
            cp_quantities_add(list, SECTION,
                              cp_quantity_text(name, "mean_distance_%s_%s", NUMBER[v], OF[d + 1]),
                              "", 2, 1.0, n->distance[d].mean);
        }
    }
    cp_quantities_add(list, SECTION, "field_never_made_1", "", 3, 1.0, s->never_made_1);
    cp_quantities_add(list, SECTION, "study_never_seen_1", "", 3, 1.0, s->never_seen_1);
    cp_quantities_add(list, SECTION, "largest_weight", "", 2, 1.0, s->largest_weight);
    cp_quantities_add(list, SECTION, "weights_at_cap", "", 0, 1.0, (double)s->capped);
}

void cp_field_quantities_of_variant(const cp_study_data *data, const cp_field_variant *field,
                                    cp_quantities *list)
{
    char name[CP_QUANTITY_TEXT_SIZE], label[CP_QUANTITY_TEXT_SIZE];
    if (!field)
        return;
    const cp_raked_arm_figures *f = field->figures;
    cp_quantities_add(list, SECTION, "vehicles_compared_with_field",
                      "  vehicles struck on the front", 0, 1.0, (double)field->shape.vehicles);
    cp_quantities_add(list, SECTION, "effective_vehicles_as_field", "    effective number", 0, 1.0,
                      field->shape.effective);
    add_shape(list, &field->shape);
    cp_quantities_add(list, SECTION, "largest_gap_of_margins_1", "", 4, 1.0, field->gap_1);
    static const char *const QUANTILE[CP_RAKED_QUANTILES] = {"olc_median_g", "olc_p90_g"};
    static const char *const LABEL[CP_RAKED_QUANTILES] = {"  OLC, g, median", "  OLC, g, 90 %"};
    for (int q = 0; q < CP_RAKED_QUANTILES; q++)
        add_both(
            list, field, QUANTILE[q], LABEL[q], 1, (double[]){f[0].quantile[q], f[1].quantile[q]},
            (cp_interval[]){f[0].quantile_interval[q], f[1].quantile_interval[q]}, "bootstrap");
    for (int what = 0; what < CP_EXCEEDED_COUNT; what++) {
        int e = CP_FIELD_ABOVE + what;
        double x = cp_quantity_rounded(field->above[what] * ABOVE[what].factor);
        add_both(list, field,
                 cp_quantity_text(name, "crashes_%s_above_%g_per_million_km", ABOVE[what].name, x),
                 cp_quantity_text(label, "  crashes above %s %g %s per 10^6 veh-km",
                                  ABOVE[what].label, x, ABOVE[what].unit),
                 0, (double[]){f[0].rate[e], f[1].rate[e]},
                 (cp_interval[]){f[0].rate_interval[e], f[1].rate_interval[e]}, "bootstrap");
    }
    for (size_t k = 0; k < data->risk_count; k++) {
        const cp_study_risk *risk = &data->risk[k];
        size_t e = CP_FIELD_INJURED + k;
        add_both(list, field,
                 cp_quantity_text(name, "expected_injured_per_million_km_%.24s_%.12s", risk->name,
                                  risk->level),
                 cp_quantity_text(label, "  %.20s (%.30s) expected per 10^6 veh-km", risk->level,
                                  risk->name),
                 1, (double[]){f[0].rate[e], f[1].rate[e]},
                 (cp_interval[]){f[0].rate_interval[e], f[1].rate_interval[e]},
                 cp_injury_kind(risk));
    }
}

// ---- a treatment against the baseline ----------------------------------------------------------

static ways ways_of(const cp_field_contrast *c)
{
    return (ways){.suffix = {"not_weighted", "as_field", c->delta_v_too ? "by_delta_v_too" : NULL}};
}

static void add_ratio(cp_quantities *list, const cp_field_contrast *c, size_t event,
                      const char *name, const char *label)
{
    ways w = ways_of(c);
    for (int way = 0; way < CP_FIELD_WAYS; way++) {
        w.value[way] = c->figures[way].ratio[event];
        w.interval[way] = c->figures[way].ratio_interval[event];
    }
    add_ways(list, name, label, 2, 1.0, &w, "bootstrap");
}

static void add_benefit(cp_quantities *list, const cp_field_contrast *c, size_t event,
                        const char *name, const char *label, const char *kind)
{
    ways w = ways_of(c);
    for (int way = 0; way < CP_FIELD_WAYS; way++) {
        cp_interval i = c->figures[way].ratio_interval[event];
        w.value[way] = 1.0 - c->figures[way].ratio[event];
        w.interval[way] = (cp_interval){i.status, 1.0 - i.high, 1.0 - i.low};
    }
    add_ways(list, name, label, 1, 100.0, &w, kind);
}

static void add_difference(cp_quantities *list, const cp_field_contrast *c, int quantile,
                           const char *name, const char *label)
{
    ways w = ways_of(c);
    for (int way = 0; way < CP_FIELD_WAYS; way++) {
        w.value[way] = c->figures[way].difference[quantile];
        w.interval[way] = c->figures[way].difference_interval[quantile];
    }
    add_ways(list, name, label, 1, 1.0, &w, "bootstrap");
}

void cp_field_quantities_of_contrast(const cp_study_data *data, const cp_field_contrast *field,
                                     cp_quantities *list)
{
    char name[CP_QUANTITY_TEXT_SIZE], label[CP_QUANTITY_TEXT_SIZE];
    if (!field)
        return;
    cp_quantities_add(list, SECTION, "vehicles_unlike_any_of_baseline",
                      "  vehicles of classes the baseline has none of", 0, 1.0,
                      (double)field->unlike);
    add_ratio(list, field, CP_FIELD_CRASH, "rate_ratio", "  rate ratio of frontal crashes");
    for (int what = 0; what < CP_EXCEEDED_COUNT; what++) {
        double x = cp_quantity_rounded(field->above[what] * ABOVE[what].factor);
        add_ratio(list, field, (size_t)CP_FIELD_ABOVE + (size_t)what,
                  cp_quantity_text(name, "rate_ratio_%s_above_%g", ABOVE[what].name, x),
                  cp_quantity_text(label, "  rate ratio above %s %g %s", ABOVE[what].label, x,
                                   ABOVE[what].unit));
    }
    add_difference(list, field, CP_RAKED_MEDIAN, "olc_median_difference_g",
                   "  OLC, g, difference of medians");
    for (size_t k = 0; k < data->risk_count; k++) {
        const cp_study_risk *risk = &data->risk[k];
        add_benefit(
            list, field, CP_FIELD_INJURED + k,
            cp_quantity_text(name, "benefit_1_%.24s_%.12s", risk->name, risk->level),
            cp_quantity_text(label, "  benefit, %%, %.20s (%.30s)", risk->level, risk->name),
            cp_injury_kind(risk));
    }
}
