/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/paired_points.h"

#include "analysis/query_json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Columns of one kind of entry, by name. */
typedef struct columns {
    json_t *object;
    bool failed;
} columns;

static columns columns_create(const char *const *name, size_t count)
{
    columns c = {json_object(), false};
    for (size_t k = 0; k < count; k++)
        c.failed |= json_object_set_new(c.object, name[k], json_array()) != 0;
    c.failed |= c.object == NULL;
    return c;
}

static void append(columns *c, const char *name, json_t *value)
{
    c->failed |= json_array_append_new(json_object_get(c->object, name), value) != 0;
}

static void append_index(columns *c, const char *name, size_t value)
{
    append(c, name, json_integer((json_int_t)value));
}

// Digits enough to draw.
static void append_value(columns *c, const char *name, double value)
{
    append(c, name, cp_number_json(round(value * 1e4) / 1e4));
}

// ---- crashes under a treatment ---------------------------------------------------------------

static columns crash_points(const cp_study_data *data, const bool *drawn)
{
    static const char *const NAME[] = {"variant",        "scenario",      "crash_type",
                                       "baseline_olc_g", "treated_olc_g", "outcome"};
    columns c = columns_create(NAME, sizeof NAME / sizeof *NAME);
    for (size_t k = 0; k < data->pair_count; k++) {
        const cp_study_pair *pair = &data->pair[k];
        const cp_study_crash *crash = &data->crash[pair->crash];
        if (!crash->frontal || !drawn[pair->crash] || pair->outcome == CP_OUTCOME_INVALID ||
            isnan(pair->olc_g[0]) || isnan(pair->olc_g[1]))
            continue;
        append_index(&c, "variant", pair->variant);
        append_index(&c, "scenario", data->replication[crash->replication].scenario);
        append_index(&c, "crash_type", crash->crash_type);
        append_value(&c, "baseline_olc_g", pair->olc_g[0]);
        append_value(&c, "treated_olc_g", pair->olc_g[1]);
        append(&c, "outcome", json_string(cp_outcome_text(pair->outcome_olc)));
    }
    return c;
}

// ---- replications of one seed ----------------------------------------------------------------

/* OLC of one crash type in one replication; a left-censored one is 0 g, below which none is. */
typedef struct seed_sum {
    size_t vehicles[2]; /* all, inside */
    double olc_g[2];
} seed_sum;

static void append_seed(columns *c, const cp_study_replication *r, size_t crash_type,
                        const seed_sum *sum)
{
    append_index(c, "variant", r->variant);
    append_index(c, "scenario", r->scenario);
    append_index(c, "crash_type", crash_type);
    append_index(c, "number", (size_t)r->number);
    append_index(c, "vehicles", sum->vehicles[0]);
    append_index(c, "vehicles_inside", sum->vehicles[1]);
    append_value(c, "mean_olc_g", sum->olc_g[0] / (double)sum->vehicles[0]);
    append_value(c, "mean_olc_g_inside", sum->olc_g[1] / (double)sum->vehicles[1]);
}

static columns seed_points(const cp_study_data *data, seed_sum *sum)
{
    static const char *const NAME[] = {"variant",         "scenario",         "crash_type",
                                       "number",          "vehicles",         "mean_olc_g",
                                       "vehicles_inside", "mean_olc_g_inside"};
    for (size_t k = 0; k < data->vehicle_count; k++) {
        const cp_study_vehicle *v = &data->vehicle[k];
        const cp_study_crash *crash = &data->crash[v->crash];
        if (!v->frontal || v->olc == CP_OLC_FAILED)
            continue;
        seed_sum *own = &sum[crash->replication * data->crash_type_count + crash->crash_type];
        for (int scope = 0; scope < (v->validity == 0 ? 2 : 1); scope++) {
            own->vehicles[scope]++;
            own->olc_g[scope] += v->olc == CP_OLC_KNOWN ? v->olc_g : 0.0;
        }
    }
    columns c = columns_create(NAME, sizeof NAME / sizeof *NAME);
    for (size_t r = 0; r < data->replication_count; r++)
        for (size_t t = 0; t < data->crash_type_count; t++)
            if (sum[r * data->crash_type_count + t].vehicles[0] > 0)
                append_seed(&c, &data->replication[r], t, &sum[r * data->crash_type_count + t]);
    return c;
}

// Replications of a scenario that ran in every variant; they come by scenario and number.
static json_t *complete_seeds(const cp_study_data *data)
{
    json_t *seeds = json_array();
    size_t r = 0;
    for (size_t s = 0; s < data->scenario_count; s++) {
        json_int_t complete = 0;
        while (r < data->replication_count && data->replication[r].scenario == s) {
            size_t first = r;
            while (r < data->replication_count && data->replication[r].scenario == s &&
                   data->replication[r].number == data->replication[first].number)
                r++;
            complete += r - first == data->variant_count;
        }
        json_array_append_new(seeds, json_integer(complete));
    }
    return seeds;
}

cp_status cp_paired_points_json(const cp_study_data *data, const bool *drawn, json_t **points,
                                cp_error *error)
{
    *points = NULL;
    columns c = {0};
    if (data->counterfactual) {
        c = crash_points(data, drawn);
        *points = json_pack("{s:o}", "crash", c.object);
    } else if (data->paired) {
        size_t cells = data->replication_count * data->crash_type_count;
        seed_sum *sum = calloc(cells + 1, sizeof *sum);
        if (sum == NULL)
            return cp_fail_memory(error, "the pairs of a report");
        c = seed_points(data, sum);
        free(sum);
        *points = json_pack("{s:o, s:o}", "seed", c.object, "seeds", complete_seeds(data));
    } else {
        *points = json_null();
    }
    if (*points == NULL || c.failed) {
        json_decref(*points);
        *points = NULL;
        return cp_fail_memory(error, "the pairs of a report");
    }
    return CP_OK;
}
