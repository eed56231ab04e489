/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/field_json.h"

#include "analysis/query_json.h"
#include "report/figure_json.h"

// A figure weighted and not.
static json_t *both_json(const double value[2], const cp_interval interval[2])
{
    return json_pack("{s:o, s:o, s:o, s:o}", "value", cp_number_json(value[1]), "interval",
                     cp_interval_json(interval[1]), "not_weighted", cp_number_json(value[0]),
                     "not_weighted_interval", cp_interval_json(interval[0]));
}

static json_t *classes_json(const cp_field_shape *s, int margin)
{
    json_t *list = json_array();
    for (size_t k = 0; k < CP_FIELD_MARGIN_CLASSES[margin]; k++) {
        const cp_field_class *c = &s->of[margin][k];
        json_array_append_new(
            list, json_pack("{s:s, s:o, s:o, s:o, s:o, s:I}", "class",
                            cp_field_class_text((cp_field_margin)margin, k), "field_1",
                            cp_number_json(c->field_1), "field_se_1", cp_number_json(c->field_se_1),
                            "study_1", cp_number_json(c->study_1), "weighted_1",
                            cp_number_json(c->weighted_1), "vehicles", (json_int_t)c->vehicles));
    }
    return list;
}

static json_t *number_json(const cp_field_number *n)
{
    json_t *distance[2];
    for (int d = 0; d < 2; d++)
        distance[d] = json_pack("{s:o, s:o}", "largest_1", cp_number_json(n->distance[d].largest_1),
                                "mean", cp_number_json(n->distance[d].mean));
    return json_pack("{s:I, s:o, s:o, s:o, s:o, s:o}", "known", (json_int_t)n->known,
                     "field_median", cp_number_json(n->median[0]), "study_median",
                     cp_number_json(n->median[1]), "weighted_median", cp_number_json(n->median[2]),
                     "distance", distance[0], "weighted_distance", distance[1]);
}

static json_t *shape_json(const cp_field_shape *s)
{
    static const char *const NUMBER[CP_FIELD_VALUE_COUNT] = {"delta_v_km_h", "pdof_deg",
                                                             "overlap_1"};
    json_t *classes = json_object(), *numbers = json_object();
    for (int m = 0; m < CP_FIELD_MARGIN_COUNT; m++)
        json_object_set_new(classes, CP_FIELD_MARGIN_TEXT[m], classes_json(s, m));
    for (int v = 0; v < CP_FIELD_VALUE_COUNT; v++)
        json_object_set_new(numbers, NUMBER[v], number_json(&s->number[v]));
    return json_pack("{s:I, s:o, s:f, s:I, s:o, s:o, s:o, s:o, s:[o, o]}", "vehicles",
                     (json_int_t)s->vehicles, "effective", cp_number_json(s->effective),
                     "largest_weight", s->largest_weight, "at_cap", (json_int_t)s->capped,
                     "field_never_made_1", cp_number_json(s->never_made_1), "study_never_seen_1",
                     cp_number_json(s->never_seen_1), "classes", classes, "numbers", numbers,
                     "crash_type_distance_1", cp_number_json(s->type_distance_1[0]),
                     cp_number_json(s->type_distance_1[1]));
}

// Crashes above a severity: x in SI, and the figure of the event.
static void set_above(json_t *object, const double *above, const double *const value[2],
                      const cp_interval *const interval[2])
{
    for (int what = 0; what < CP_EXCEEDED_COUNT; what++) {
        int e = CP_FIELD_ABOVE + what;
        json_t *figure = both_json((double[]){value[0][e], value[1][e]},
                                   (cp_interval[]){interval[0][e], interval[1][e]});
        json_object_set_new(figure, "x", cp_number_json(above[what]));
        json_object_set_new(object, CP_EXCEEDED_TEXT[what], figure);
    }
}

static json_t *injured_json(const cp_study_data *data, const double *const value[2],
                            const cp_interval *const interval[2])
{
    json_t *list = json_array();
    for (size_t k = 0; k < data->risk_count; k++) {
        size_t e = CP_FIELD_INJURED + k;
        json_t *figure = both_json((double[]){value[0][e], value[1][e]},
                                   (cp_interval[]){interval[0][e], interval[1][e]});
        json_object_set_new(figure, "function", json_string(data->risk[k].name));
        json_object_set_new(figure, "level", json_string(data->risk[k].level));
        json_array_append_new(list, figure);
    }
    return list;
}

json_t *cp_field_variant_json(const cp_study_data *data, const cp_field_variant *field)
{
    const cp_raked_arm_figures *f = field->figures;
    const double *rate[2] = {f[0].rate, f[1].rate};
    const cp_interval *interval[2] = {f[0].rate_interval, f[1].rate_interval};
    json_t *above = json_object();
    set_above(above, field->above, rate, interval);
    return json_pack(
        "{s:s, s:b, s:o, s:o, s:o, s:o, s:o, s:o}", "name", field->field, "weighted",
        field->weighted, "shape", shape_json(&field->shape), "largest_gap_of_margins_1",
        cp_number_json(field->gap_1), "olc_median_g",
        both_json((double[]){f[0].quantile[0], f[1].quantile[0]},
                  (cp_interval[]){f[0].quantile_interval[0], f[1].quantile_interval[0]}),
        "olc_p90_g",
        both_json((double[]){f[0].quantile[1], f[1].quantile[1]},
                  (cp_interval[]){f[0].quantile_interval[1], f[1].quantile_interval[1]}),
        "crashes_above_per_million_km", above, "expected_injured_per_million_km",
        injured_json(data, rate, interval));
}

// The same of a contrast, with delta-v too where that is another way.
static json_t *ratio_json(const cp_field_contrast *c, size_t event)
{
    const cp_raked_figures *f = c->figures;
    json_t *figure =
        both_json((double[]){f[0].ratio[event], f[1].ratio[event]},
                  (cp_interval[]){f[0].ratio_interval[event], f[1].ratio_interval[event]});
    if (c->delta_v_too) {
        json_object_set_new(figure, "by_delta_v_too",
                            cp_number_json(f[CP_FIELD_DELTA_V_TOO].ratio[event]));
        json_object_set_new(figure, "by_delta_v_too_interval",
                            cp_interval_json(f[CP_FIELD_DELTA_V_TOO].ratio_interval[event]));
    }
    return figure;
}

json_t *cp_field_contrast_json(const cp_study_data *data, const cp_field_contrast *field)
{
    const cp_raked_figures *f = field->figures;
    json_t *above = json_object(), *injured = json_array();
    for (int what = 0; what < CP_EXCEEDED_COUNT; what++) {
        json_t *figure = ratio_json(field, (size_t)CP_FIELD_ABOVE + (size_t)what);
        json_object_set_new(figure, "x", cp_number_json(field->above[what]));
        json_object_set_new(above, CP_EXCEEDED_TEXT[what], figure);
    }
    for (size_t k = 0; k < data->risk_count; k++) {
        json_t *figure = ratio_json(field, CP_FIELD_INJURED + k);
        json_object_set_new(figure, "function", json_string(data->risk[k].name));
        json_object_set_new(figure, "level", json_string(data->risk[k].level));
        json_array_append_new(injured, figure);
    }
    return json_pack(
        "{s:I, s:o, s:o, s:o, s:o}", "unlike", (json_int_t)field->unlike, "rate_ratio",
        ratio_json(field, CP_FIELD_CRASH), "rate_ratio_above", above, "olc_median_difference_g",
        both_json((double[]){f[0].difference[0], f[1].difference[0]},
                  (cp_interval[]){f[0].difference_interval[0], f[1].difference_interval[0]}),
        "injured_ratio", injured);
}
