/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/page_data.h"

#include "core/rng.h"
#include "core/units.h"
#include "report/answer.h"
#include "report/comparison_json.h"
#include "report/example_query.h"
#include "report/field_page.h"
#include "report/gallery.h"
#include "report/network.h"
#include "report/network_background.h"
#include "report/paired_points.h"
#include "report/query_json.h"
#include "report/slice_sample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ECDF_POINTS 240

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

// Digits enough to draw: coordinates to a ten-thousandth.
static json_t *drawn_json(double value)
{
    return cp_number_json(round(value * 1e4) / 1e4);
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
    for (size_t k = 0; k < data->vehicle_count; k++) {
        const cp_study_vehicle *v = &data->vehicle[k];
        const cp_study_crash *crash = &data->crash[v->crash];
        if (!v->frontal || !drawn[v->crash])
            continue;
        const cp_study_replication *r = &data->replication[crash->replication];
        json_array_append_new(column[VARIANT], json_integer((json_int_t)r->variant));
        json_array_append_new(column[SCENARIO], json_integer((json_int_t)r->scenario));
        json_array_append_new(column[TYPE], json_integer((json_int_t)crash->crash_type));
        json_array_append_new(column[ROLE], json_integer(v->role == 'b'));
        json_array_append_new(column[STATUS], json_integer(v->olc));
        json_array_append_new(column[OLC], drawn_json(v->olc_g));
        json_array_append_new(column[CLOSING], drawn_json(cp_km_h_from_m_s(v->closing_speed_m_s)));
        json_array_append_new(column[OFFSET], drawn_json(v->lateral_offset_m));
        json_array_append_new(column[ANGLE], drawn_json(cp_deg_from_rad(v->angle_rad)));
        json_array_append_new(column[VALIDITY], json_integer((json_int_t)v->validity));
        json_array_append_new(column[X], drawn_json(crash->x_m));
        json_array_append_new(column[Y], drawn_json(crash->y_m));
    }
    return object;
}

/* What of a slice needs more than its comparison. */
typedef struct slice_extras {
    const cp_study_data *data;
    const cp_corridor_pulses *pulses;
    unsigned char *chosen; /* room for one mark a vehicle */
} slice_extras;

// Steps of a distribution function: [[x, …], [share up to x, …]], thinned out to ECDF_POINTS;
// censored vehicles lie below the first x.
static json_t *ecdf_json(const cp_sample *sample)
{
    json_t *x = json_array(), *share = json_array();
    size_t censored = cp_sample_censored(sample), values = sample->count - censored;
    size_t steps = values < ECDF_POINTS ? values : ECDF_POINTS;
    for (size_t k = 0; k < steps; k++) {
        size_t place =
            steps == values
                ? k
                : (size_t)llround((double)k * (double)(values - 1) / (double)(steps - 1));
        json_array_append_new(x, drawn_json(sample->value[censored + place]));
        json_array_append_new(share,
                              drawn_json((double)(censored + place + 1) / (double)sample->count));
    }
    return json_pack("{s:o, s:o, s:I, s:I}", "x", x, "share", share, "n", (json_int_t)sample->count,
                     "censored", (json_int_t)censored);
}

// Distribution and pulse corridor of one variant, one scope of a slice.
static cp_status add_curves(const slice_extras *e, cp_slice slice, size_t variant, int scope,
                            json_t *ecdf, json_t *corridor, cp_error *error)
{
    cp_replication_set set;
    cp_sample sample = {0};
    cp_status status = cp_replication_set_create(e->data, slice, variant, &set, error);
    if (status != CP_OK)
        return status;
    status = cp_slice_sample(e->data, &set, slice, scope, CP_QUANTITY_OLC, &sample, error);
    if (status == CP_OK) {
        json_object_set_new(ecdf, CP_SCOPE_TEXT[scope], ecdf_json(&sample));
        for (size_t k = 0; k < e->data->vehicle_count; k++) {
            const cp_study_vehicle *v = &e->data->vehicle[k];
            const cp_study_crash *crash = &e->data->crash[v->crash];
            e->chosen[k] = v->frontal &&
                           e->data->replication[crash->replication].variant == variant &&
                           (scope == CP_SCOPE_ALL || v->validity == 0) &&
                           cp_slice_has_crash(e->data, slice, crash);
        }
        json_object_set_new(corridor, CP_SCOPE_TEXT[scope], cp_corridor_json(e->pulses, e->chosen));
    }
    cp_sample_destroy(&sample);
    cp_replication_set_destroy(&set);
    return status;
}

static cp_status add_extras(const slice_extras *e, const cp_comparison *comparison, json_t *object,
                            cp_error *error)
{
    json_t *variants = json_object_get(object, "variants");
    for (size_t k = 0; k < comparison->variant_count; k++) {
        json_t *ecdf = json_object(), *corridor = json_object();
        json_t *variant = json_array_get(variants, k);
        json_object_set_new(variant, "ecdf", ecdf);
        json_object_set_new(variant, "corridor", corridor);
        for (int scope = 0; scope < CP_SCOPE_COUNT; scope++) {
            cp_status status = add_curves(e, comparison->slice, comparison->variant[k].variant,
                                          scope, ecdf, corridor, error);
            if (status != CP_OK)
                return status;
        }
    }
    return CP_OK;
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

static cp_status add_slice(const slice_extras *extras, size_t baseline, cp_slice slice,
                           const cp_comparison_options *options, json_t *slices, char **answer,
                           cp_error *error)
{
    const cp_study_data *data = extras->data;
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
            status = add_extras(extras, &comparison, object, error);
    }
    cp_comparison_destroy(&comparison);
    return status;
}

// A comparison for every choice of the two filters, everything first.
static cp_status add_slices(const slice_extras *extras, size_t baseline,
                            const cp_comparison_options *options, json_t *slices, char **answer_all,
                            cp_error *error)
{
    const cp_study_data *data = extras->data;
    size_t types = frontal_types(data);
    for (size_t s = 0; s <= data->scenario_count; s++) {
        for (size_t t = 0; t <= types; t++) {
            cp_slice slice = {s ? s - 1 : CP_SLICE_ALL, t ? t - 1 : CP_SLICE_ALL, NULL};
            char *answer;
            cp_status status = add_slice(extras, baseline, slice, options, slices, &answer, error);
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
            array, json_pack("{s:s, s:s, s:s, s:s, s:[f, f], s:f, s:s, s:s}", "name", r->name,
                             "level", r->level, "predictor", COLUMN[r->predictor], "form",
                             cp_risk_form_text(r->function.form), "coefficients",
                             r->function.coefficient[0], r->function.coefficient[1], "unit_per_si",
                             r->function.unit_per_si, "source", r->source, "note", r->note));
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

static cp_status make_parts(cp_store *store, const cp_study_data *data, size_t baseline,
                            const cp_comparison_options *options, page_parts *p, char **answer_all,
                            cp_error *error)
{
    p->slices = json_array();
    p->chosen = calloc(data->vehicle_count + 1, sizeof *p->chosen);
    p->drawn = calloc(data->crash_count + 1, sizeof *p->drawn);
    if (!p->slices || !p->chosen || !p->drawn)
        return cp_fail_memory(error, "the data of a report");
    p->chance = choose_drawn(data, p->drawn, &p->frontal);
    cp_status status = cp_corridor_read(store, data, &p->pulses, error);
    slice_extras extras = {data, &p->pulses, p->chosen};
    if (status == CP_OK)
        status = add_slices(&extras, baseline, options, p->slices, answer_all, error);
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
            "{s:O, s:O, s:I, s:o, s:o, s:o, s:o, s:O, s:O, s:o, s:o, s:O, s:O, s:O, s:O, s:o, s:o}",
            "study", json_array_get(json_object_get(data->about, "study"), 0), "about", data->about,
            "unfinished", (json_int_t)data->unfinished, "scenarios", scenarios_json(data),
            "crash_types", texts_json(data->crash_type, frontal_types(data)), "variants",
            variants_json(data, baseline), "validity",
            texts_json(data->validity, data->validity_count), "validity_counts", p.counts, "slices",
            p.slices, "vehicles", vehicles_json(data, p.drawn), "sample",
            json_pack("{s:f, s:o, s:I, s:I}", "chance", p.chance, "seed",
                      json_sprintf("%llu", (unsigned long long)data->seed), "frontal_crashes",
                      (json_int_t)p.frontal, "pulses", (json_int_t)CP_CORRIDOR_PULSES_MAX),
            "networks", p.networks, "gallery", p.gallery, "pairs", p.pairs, "backgrounds",
            p.backgrounds, "risks", risks_json(data), "queries", queries_json());
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
    cp_corridor_destroy(&p.pulses);
    free(p.chosen);
    free(p.drawn);
    return status;
}

char *cp_page_data_text(const json_t *page)
{
    char *json = json_dumps(page, JSON_COMPACT | JSON_ENSURE_ASCII | JSON_REAL_PRECISION(10));
    if (!json)
        return NULL;
    // In JSON these three occur inside strings only, where \u003c means the same.
    size_t size = 1;
    for (const char *c = json; *c; c++)
        size += strchr("<>&", *c) ? 6 : 1;
    char *safe = malloc(size), *end = safe;
    for (const char *c = json; safe && *c; c++) {
        if (strchr("<>&", *c))
            end += sprintf(end, "\\u%04x", (unsigned)*c);
        else
            *end++ = *c;
    }
    if (safe)
        *end = '\0';
    free(json);
    return safe;
}
