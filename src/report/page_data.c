/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/page_data.h"

#include "core/units.h"
#include "report/answer.h"
#include "report/comparison_json.h"
#include "report/example_query.h"
#include "report/query_json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

static json_t *vehicles_json(const cp_study_data *data, size_t every)
{
    enum { VARIANT, SCENARIO, TYPE, ROLE, STATUS, OLC, CLOSING, OFFSET, ANGLE, VALIDITY, COLUMNS };
    static const char *const NAME[COLUMNS] = {
        "variant", "scenario",           "crash_type",       "role",      "status",
        "olc_g",   "closing_speed_km_h", "lateral_offset_m", "angle_deg", "validity"};
    json_t *column[COLUMNS], *object = json_object();
    for (size_t c = 0; c < COLUMNS; c++) {
        column[c] = json_array();
        json_object_set_new(object, NAME[c], column[c]);
    }
    size_t place = 0;
    for (size_t k = 0; k < data->vehicle_count; k++) {
        const cp_study_vehicle *v = &data->vehicle[k];
        if (!v->frontal || place++ % every != 0)
            continue;
        const cp_study_crash *crash = &data->crash[v->crash];
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

static cp_status add_slice(const cp_study_data *data, size_t baseline, cp_slice slice,
                           const cp_comparison_options *options, json_t *slices, char **answer,
                           cp_error *error)
{
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
    }
    cp_comparison_destroy(&comparison);
    return status;
}

// A comparison for every choice of the two filters, everything first.
static cp_status add_slices(const cp_study_data *data, size_t baseline,
                            const cp_comparison_options *options, json_t *slices, char **answer_all,
                            cp_error *error)
{
    size_t types = frontal_types(data);
    for (size_t s = 0; s <= data->scenario_count; s++) {
        for (size_t t = 0; t <= types; t++) {
            cp_slice slice = {s ? s - 1 : CP_SLICE_ALL, t ? t - 1 : CP_SLICE_ALL, NULL};
            char *answer;
            cp_status status = add_slice(data, baseline, slice, options, slices, &answer, error);
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

cp_status cp_page_data(const cp_study_data *data, size_t baseline,
                       const cp_comparison_options *options, json_t **page, char **answer_all,
                       cp_error *error)
{
    *answer_all = NULL;
    *page = NULL;
    json_t *slices = json_array(), *counts = NULL;
    cp_status status = add_slices(data, baseline, options, slices, answer_all, error);
    if (status == CP_OK)
        status = validity_counts(data, &counts, error);
    if (status != CP_OK) {
        json_decref(slices);
        json_decref(counts);
        return status;
    }
    size_t every = 1 + data->frontal_vehicle_count / (CP_PAGE_VEHICLES_MAX + 1);
    *page = json_pack(
        "{s:O, s:O, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:I, s:o}", "study",
        json_array_get(json_object_get(data->about, "study"), 0), "about", data->about,
        "unfinished", (json_int_t)data->unfinished, "scenarios", scenarios_json(data),
        "crash_types", texts_json(data->crash_type, frontal_types(data)), "variants",
        variants_json(data, baseline), "validity", texts_json(data->validity, data->validity_count),
        "validity_counts", counts, "slices", slices, "vehicles", vehicles_json(data, every),
        "drawn_every", (json_int_t)every, "queries", queries_json());
    return *page ? CP_OK : cp_fail_memory(error, "the data of a report");
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
