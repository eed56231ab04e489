/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/page_data.h"

#include "analysis/any_vehicle.h"
#include "analysis/caveats.h"
#include "analysis/comparison.h"
#include "analysis/false_activations.h"
#include "analysis/network_background.h"
#include "analysis/query_json.h"
#include "analysis/slice_sample.h"
#include "core/rng.h"
#include "core/units.h"
#include "report/answer.h"
#include "report/assessment_record.h"
#include "report/comparison_json.h"
#include "report/example_query.h"
#include "report/field_page.h"
#include "report/figure_json.h"
#include "report/gallery.h"
#include "report/network.h"
#include "report/paired_points.h"
#include "report/slice_curves.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define RISK_CURVE_END_KM_H 100.0
#define RISK_CURVE_STEP_KM_H 1.0

// Types that have a frontally struck vehicle; they come first in the alphabet.
static size_t frontal_types(const cp_study_data *data)
{
    size_t count = 0;
    while (count < data->crash_type_count && strncmp(data->crash_type[count], "front-", 6) == 0)
        count++;
    return count;
}

static json_t *texts_json(char *const *text, size_t count)
{
    json_t *array = json_array();
    for (size_t k = 0; k < count; k++)
        json_array_append_new(array, json_string(text[k]));
    return array;
}

static json_t *scenarios_json(const cp_study_data *data)
{
    json_t *array = json_array();
    for (size_t k = 0; k < data->scenario_count; k++)
        json_array_append_new(array, json_string(data->scenario[k].name));
    return array;
}

static json_t *variants_json(const cp_study_data *data, size_t baseline)
{
    json_t *array = json_array();
    for (size_t k = 0; k < data->variant_count; k++)
        json_array_append_new(array, json_pack("{s:s, s:b, s:O}", "name", data->variant[k].name,
                                               "is_baseline", k == baseline, "functions",
                                               data->variant[k].functions));
    return array;
}

static json_t *queries_json(void)
{
    json_t *array = json_array();
    for (size_t k = 0; k < CP_EXAMPLE_QUERY_COUNT; k++)
        json_array_append_new(array, json_pack("{s:s, s:s}", "name", CP_EXAMPLE_QUERY[k].name,
                                               "sql", CP_EXAMPLE_QUERY[k].sql));
    return array;
}

// Which frontal crashes are drawn: by the seed and their id only, so that each is with every
// filter. Returns the chance of each and counts them all.
static double choose_drawn(const cp_study_data *data, bool *drawn, size_t *frontal)
{
    *frontal = 0;
    for (size_t k = 0; k < data->crash_count; k++)
        *frontal += data->crash[k].frontal;
    double chance = *frontal > CP_PAGE_CRASHES_MAX ? CP_PAGE_CRASHES_MAX / (double)*frontal : 1.0;
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(data->seed), "report sample");
    for (size_t k = 0; k < data->crash_count; k++)
        drawn[k] =
            data->crash[k].frontal && cp_rng_uniform(key, (uint64_t)data->crash[k].id) < chance;
    return chance;
}

static json_t *vehicles_json(const cp_study_data *data, const bool *drawn)
{
    enum {
        VARIANT,
        SCENARIO,
        TYPE,
        ROLE,
        STATUS,
        OLC,
        CLOSING,
        OFFSET,
        ANGLE,
        VALIDITY,
        X,
        Y,
        COLUMNS
    };
    static const char *const NAME[COLUMNS] = {"variant",
                                              "scenario",
                                              "crash_type",
                                              "role",
                                              "status",
                                              "olc_g",
                                              "closing_speed_km_h",
                                              "lateral_offset_m",
                                              "angle_deg",
                                              "validity",
                                              "x_m",
                                              "y_m"};
    json_t *column[COLUMNS], *object = json_object();
    for (size_t c = 0; c < COLUMNS; c++) {
        column[c] = json_array();
        json_object_set_new(object, NAME[c], column[c]);
    }
    // Those of the replications, then what the treatments made of crashes of the baseline; these
    // stand in the scenario and under the type of the baseline's crash.
    for (size_t k = 0; k < cp_any_vehicle_count(data); k++) {
        cp_any_vehicle any = cp_any_vehicle_at(data, k);
        const cp_study_vehicle *v = any.vehicle;
        if (!v->frontal || !drawn[v->crash])
            continue;
        const size_t index[] = {any.variant, any.replication->scenario, any.crash->crash_type,
                                v->role == 'b', v->olc};
        const double number[] = {v->olc_g, cp_km_h_from_m_s(v->closing_speed_m_s),
                                 v->lateral_offset_m, cp_deg_from_rad(v->angle_rad)};
        for (size_t c = VARIANT; c <= STATUS; c++)
            json_array_append_new(column[c], json_integer((json_int_t)index[c]));
        for (size_t c = OLC; c <= ANGLE; c++)
            json_array_append_new(column[c], cp_drawn_json(number[c - OLC]));
        json_array_append_new(column[VALIDITY], json_integer((json_int_t)v->validity));
        json_array_append_new(column[X], cp_drawn_json(any.x_m));
        json_array_append_new(column[Y], cp_drawn_json(any.y_m));
    }
    return object;
}

// Frontal vehicles by scenario, crash type, variant and validity, for the table of all of them.
static cp_status validity_counts(const cp_study_data *data, json_t **counts, cp_error *error)
{
    size_t cells =
        data->scenario_count * data->crash_type_count * data->variant_count * data->validity_count;
    size_t *count = calloc(cells + 1, sizeof *count);
    *counts = json_array();
    if (!count || !*counts) {
        free(count);
        return cp_fail_memory(error, "a table of a report");
    }
    for (size_t k = 0; k < data->vehicle_count; k++) {
        if (!data->vehicle[k].frontal)
            continue;
        const cp_study_crash *crash = &data->crash[data->vehicle[k].crash];
        const cp_study_replication *r = &data->replication[crash->replication];
        size_t cell = (r->scenario * data->crash_type_count + crash->crash_type);
        cell = (cell * data->variant_count + r->variant) * data->validity_count;
        count[cell + data->vehicle[k].validity]++;
    }
    for (size_t cell = 0; cell < cells; cell++) {
        size_t rest = cell / data->validity_count;
        if (count[cell] > 0)
            json_array_append_new(
                *counts,
                json_pack("{s:I, s:I, s:I, s:I, s:I}", "validity",
                          (json_int_t)(cell % data->validity_count), "variant",
                          (json_int_t)(rest % data->variant_count), "crash_type",
                          (json_int_t)(rest / data->variant_count % data->crash_type_count),
                          "scenario",
                          (json_int_t)(rest / data->variant_count / data->crash_type_count),
                          "vehicles", (json_int_t)count[cell]));
    }
    free(count);
    return CP_OK;
}

static cp_status add_slice(const cp_slice_curves *curves, size_t baseline, cp_slice slice,
                           const cp_comparison_options *options, json_t *slices, char **answer,
                           cp_error *error)
{
    const cp_study_data *data = curves->data;
    cp_comparison comparison;
    json_t *object = NULL;
    *answer = NULL;
    cp_status status = cp_compare(data, baseline, slice, options, &comparison, error);
    if (status == CP_OK)
        status = cp_comparison_answer(data, &comparison, answer, error);
    if (status == CP_OK) {
        object = cp_comparison_json(data, &comparison);
        json_object_set_new(object, "answer", json_string(*answer));
        if (!object || json_array_append_new(slices, object) != 0)
            status = cp_fail_memory(error, "a comparison");
        else
            status = cp_slice_curves_add(curves, &comparison, object, error);
    }
    cp_comparison_destroy(&comparison);
    return status;
}

// A comparison for every choice of the two filters, everything first.
static cp_status add_slices(const cp_slice_curves *curves, size_t baseline,
                            const cp_comparison_options *options, json_t *slices, char **answer_all,
                            cp_error *error)
{
    const cp_study_data *data = curves->data;
    size_t types = frontal_types(data);
    for (size_t s = 0; s <= data->scenario_count; s++) {
        for (size_t t = 0; t <= types; t++) {
            cp_slice slice = {s ? s - 1 : CP_SLICE_ALL, t ? t - 1 : CP_SLICE_ALL, NULL};
            char *answer;
            cp_status status = add_slice(curves, baseline, slice, options, slices, &answer, error);
            if (s == 0 && t == 0)
                *answer_all = answer;
            else
                free(answer);
            if (status != CP_OK)
                return status;
        }
    }
    return CP_OK;
}

// {"x": km/h, "probability", "crash_type": that it is drawn for, null where it does not matter} of
// a function of a speed, to draw; null of another.
static json_t *risk_curve_json(const cp_study_risk *risk)
{
    static const char DRAWN_TYPE[] = "front-front";
    if (!cp_predictor_is_speed(risk->predictor))
        return json_null();
    bool has_type = cp_risk_has_crash_type(&risk->function);
    json_t *x = json_array(), *probability = json_array();
    for (double km_h = 0.0; km_h <= RISK_CURVE_END_KM_H; km_h += RISK_CURVE_STEP_KM_H) {
        json_array_append_new(x, json_real(km_h));
        json_array_append_new(
            probability, cp_drawn_json(cp_risk_probability(&risk->function, cp_m_s_from_km_h(km_h),
                                                           DRAWN_TYPE)));
    }
    return json_pack("{s:o, s:o, s:s?}", "x", x, "probability", probability, "crash_type",
                     has_type ? DRAWN_TYPE : NULL);
}

static json_t *risks_json(const cp_study_data *data)
{
    static const char *const COLUMN[] = {
#define CP_PREDICTOR_COLUMN(name, column) column,
        CP_PREDICTORS(CP_PREDICTOR_COLUMN)
#undef CP_PREDICTOR_COLUMN
    };
    json_t *array = json_array();
    for (size_t k = 0; k < data->risk_count; k++) {
        const cp_study_risk *r = &data->risk[k];
        json_array_append_new(
            array, json_pack("{s:o, s:s, s:s, s:s, s:s, s:[f, f], s:f, s:s, s:s}", "curve",
                             risk_curve_json(r), "name", r->name, "level", r->level, "predictor",
                             COLUMN[r->predictor], "form", cp_risk_form_text(r->function.form),
                             "coefficients", r->function.coefficient[0], r->function.coefficient[1],
                             "unit_per_si", r->function.unit_per_si, "source", r->source, "note",
                             r->note));
    }
    return array;
}

static cp_status networks_json(cp_store *store, const cp_study_data *data, json_t **networks,
                               cp_error *error)
{
    *networks = json_array();
    for (size_t k = 0; k < data->scenario_count; k++) {
        json_t *network = NULL;
        cp_status status = cp_network_json(store, data->scenario[k].name, &network, error);
        if (status != CP_OK)
            return status;
        json_array_append_new(*networks, network);
    }
    return CP_OK;
}

/* Parts of the page made one after the other; what is not made is NULL. */
typedef struct page_parts {
    json_t *slices;
    json_t *counts;
    json_t *networks;
    json_t *gallery;
    json_t *pairs;
    json_t *backgrounds;
    json_t *caveats;
    json_t *assessment;
    json_t *activations;
    cp_corridor_pulses pulses;
    unsigned char *chosen;
    bool *drawn; /* of each crash */
    size_t frontal;
    double chance;
} page_parts;

static cp_status backgrounds_json(cp_store *store, json_t **list, cp_error *error)
{
    cp_network_backgrounds backgrounds;
    cp_status status = cp_network_backgrounds_read(store, NULL, &backgrounds, error);
    if (status == CP_OK) {
        *list = cp_network_backgrounds_json(&backgrounds);
        status = *list ? CP_OK : cp_fail_memory(error, "the data of a report");
    }
    cp_network_backgrounds_destroy(&backgrounds);
    return status;
}

static cp_status caveats_json(cp_store *store, json_t **list, cp_error *error)
{
    cp_caveats caveats;
    cp_status status = cp_caveats_read(store, NULL, &caveats, error);
    if (status == CP_OK) {
        *list = cp_caveats_json(&caveats);
        status = *list ? CP_OK : cp_fail_memory(error, "the data of a report");
    }
    cp_caveats_destroy(&caveats);
    return status;
}

static cp_status make_parts(cp_store *store, const cp_study_data *data, size_t baseline,
                            const cp_comparison_options *options, page_parts *p, char **answer_all,
                            cp_error *error)
{
    p->slices = json_array();
    p->chosen = calloc(cp_any_vehicle_count(data) + 1, sizeof *p->chosen);
    p->drawn = calloc(data->crash_count + 1, sizeof *p->drawn);
    if (!p->slices || !p->chosen || !p->drawn)
        return cp_fail_memory(error, "the data of a report");
    p->chance = choose_drawn(data, p->drawn, &p->frontal);
    cp_status status = cp_corridor_read(store, data, &p->pulses, error);
    cp_slice_curves curves = {data, options, &p->pulses, p->chosen};
    if (status == CP_OK)
        status = add_slices(&curves, baseline, options, p->slices, answer_all, error);
    if (status == CP_OK)
        status = validity_counts(data, &p->counts, error);
    if (status == CP_OK)
        status = networks_json(store, data, &p->networks, error);
    if (status == CP_OK)
        status = cp_gallery_json(store, data, &p->gallery, error);
    if (status == CP_OK)
        status = cp_paired_points_json(data, p->drawn, &p->pairs, error);
    if (status == CP_OK)
        status = backgrounds_json(store, &p->backgrounds, error);
    if (status == CP_OK)
        status = caveats_json(store, &p->caveats, error);
    if (status == CP_OK)
        status = cp_assessment_record_json(data, &p->assessment, error);
    if (status == CP_OK)
        status = cp_false_activations_json(store, &p->activations, error);
    return status;
}

cp_status cp_page_data(cp_store *store, const cp_study_data *data, size_t baseline,
                       const cp_comparison_options *options, json_t **page, char **answer_all,
                       cp_error *error)
{
    *answer_all = NULL;
    *page = NULL;
    page_parts p = {0};
    cp_status status = make_parts(store, data, baseline, options, &p, answer_all, error);
    if (status == CP_OK) {
        *page = json_pack(
            "{s:O, s:O, s:O, s:I, s:o, s:o, s:o, s:o, s:O, s:O, s:o, s:o, s:O, s:O, s:O, s:O, s:O, "
            "s:o, s:o, s:O}",
            "assessment", p.assessment, "study",
            json_array_get(json_object_get(data->about, "study"), 0), "about", data->about,
            "unfinished", (json_int_t)data->unfinished, "scenarios", scenarios_json(data),
            "crash_types", texts_json(data->crash_type, frontal_types(data)), "variants",
            variants_json(data, baseline), "validity",
            texts_json(data->validity, data->validity_count), "validity_counts", p.counts, "slices",
            p.slices, "vehicles", vehicles_json(data, p.drawn), "sample",
            json_pack("{s:f, s:o, s:I, s:I}", "chance", p.chance, "seed",
                      json_sprintf("%llu", (unsigned long long)data->seed), "frontal_crashes",
                      (json_int_t)p.frontal, "pulses", (json_int_t)CP_CORRIDOR_PULSES_MAX),
            "networks", p.networks, "gallery", p.gallery, "pairs", p.pairs, "backgrounds",
            p.backgrounds, "caveats", p.caveats, "risks", risks_json(data), "queries",
            queries_json(), "activations", p.activations);
        if (!*page)
            status = cp_fail_memory(error, "the data of a report");
    }
    if (status == CP_OK)
        status = cp_field_page_add(*page, error);
    json_decref(p.slices);
    json_decref(p.counts);
    json_decref(p.networks);
    json_decref(p.gallery);
    json_decref(p.pairs);
    json_decref(p.backgrounds);
    json_decref(p.caveats);
    json_decref(p.assessment);
    json_decref(p.activations);
    cp_corridor_destroy(&p.pulses);
    free(p.chosen);
    free(p.drawn);
    return status;
}
