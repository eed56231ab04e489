/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/gallery.h"

#include "analysis/query_json.h"
#include "core/log.h"
#include "report/animation.h"
#include "store/stored_crash.h"

#include <gsl/gsl_sort.h>

#include <math.h>
#include <stdlib.h>

#define FRAME_INTERVAL_S 0.004

static const char *const MATCH_TEXT[] = {
    [CP_STORED_SAME_BYTES] = "the stored pulses, byte for byte",
    [CP_STORED_SAME_SAMPLES] = "the stored pulses, sample for sample",
    [CP_STORED_NOTHING] = "no pulse is stored to compare with",
    [CP_STORED_DIFFERENT] = "NOT the stored pulses"};

static cp_status film_crash(cp_store *store, const cp_study_data *data, size_t vehicle,
                            const char *why, json_t *gallery, cp_error *error)
{
    const cp_study_crash *crash = &data->crash[data->vehicle[vehicle].crash];
    const cp_study_replication *r = &data->replication[crash->replication];
    cp_stored_crash stored = {0};
    cp_crash_result result = {0};
    cp_crash_film film = cp_crash_film_default();
    cp_stored_match match = CP_STORED_NOTHING;
    json_t *run = NULL;
    cp_error failure = {0};
    film.interval_s = FRAME_INTERVAL_S;
    cp_status status = cp_stored_crash_read(store, crash->id, NULL, &stored, &failure);
    if (status == CP_OK) {
        cp_crash_options options = stored.options;
        options.film = &film;
        status = cp_crash_simulate(&stored.model[0], &stored.model[1], &stored.configuration,
                                   &options, &result, &failure);
    }
    if (status == CP_OK)
        status = cp_stored_crash_compare(store, &stored, &result, &match, &failure);
    if (status == CP_OK) {
        const cp_animated_run animated = {.model = {&stored.model[0], &stored.model[1]},
                                          .configuration = &stored.configuration,
                                          .description = &stored.description,
                                          .result = &result,
                                          .film = &film};
        status = cp_animation_run_json(&animated, &run, &failure);
    }
    if (status == CP_OK && match == CP_STORED_DIFFERENT)
        cp_log_warning("crash %lld simulated again gives other pulses than stored",
                       (long long)crash->id);
    json_t *entry =
        json_pack("{s:s, s:s, s:s, s:o, s:s, s:f}", "variant", data->variant[r->variant].name,
                  "scenario", data->scenario[r->scenario].name, "crash_type",
                  data->crash_type[crash->crash_type], "crash_id",
                  json_sprintf("%lld", (long long)crash->id), "why", why, "time_s", crash->time_s);
    json_object_set_new(entry, "olc_g", cp_number_json(data->vehicle[vehicle].olc_g));
    json_object_set_new(entry, "inside", json_boolean(data->vehicle[vehicle].validity == 0));
    if (status == CP_OK) {
        json_object_set_new(entry, "match", json_string(MATCH_TEXT[match]));
        json_object_set_new(entry, "run", run);
    } else {
        json_object_set_new(entry, "failed", json_string(failure.text));
        json_decref(run);
    }
    json_array_append_new(gallery, entry);
    cp_crash_result_destroy(&result);
    cp_crash_film_destroy(&film);
    if (status == CP_NO_MEMORY || !entry)
        return cp_fail_memory(error, "the gallery of a report");
    return CP_OK;
}

// Vehicles of a variant by OLC, left-censored ones below every value; those inside validity only,
// if one of them has a value, as of_inside tells.
static size_t rank_vehicles(const cp_study_data *data, size_t variant, size_t *vehicle,
                            double *olc_g, size_t *order, bool *of_inside)
{
    for (int inside = 1; inside >= 0; inside--) {
        *of_inside = inside;
        size_t count = 0, known = 0;
        for (size_t k = 0; k < data->vehicle_count; k++) {
            const cp_study_vehicle *v = &data->vehicle[k];
            size_t own = data->replication[data->crash[v->crash].replication].variant;
            if (own != variant || !v->frontal || v->olc == CP_OLC_FAILED ||
                (inside && v->validity != 0))
                continue;
            known += v->olc == CP_OLC_KNOWN;
            olc_g[count] = v->olc == CP_OLC_KNOWN ? v->olc_g : -INFINITY;
            vehicle[count++] = k;
        }
        if (known > 0) {
            gsl_sort_index(order, olc_g, 1, count);
            return count;
        }
    }
    return 0;
}

cp_status cp_gallery_json(cp_store *store, const cp_study_data *data, json_t **gallery,
                          cp_error *error)
{
    *gallery = json_array();
    size_t *vehicle = calloc(data->vehicle_count + 1, sizeof *vehicle);
    size_t *order = calloc(data->vehicle_count + 1, sizeof *order);
    double *olc_g = calloc(data->vehicle_count + 1, sizeof *olc_g);
    cp_status status = CP_OK;
    if (!*gallery || !vehicle || !order || !olc_g)
        status = cp_fail_memory(error, "the gallery of a report");
    for (size_t v = 0; v < data->variant_count && status == CP_OK; v++) {
        bool inside;
        size_t count = rank_vehicles(data, v, vehicle, olc_g, order, &inside);
        if (count == 0 || json_array_size(*gallery) + 2 > CP_GALLERY_MAX)
            continue;
        size_t middle = order[(count - 1) / 2], highest = order[count - 1];
        // A median that is left-censored has no crash to show.
        if (isfinite(olc_g[middle]))
            status = film_crash(store, data, vehicle[middle],
                                inside ? "the median OLC of its vehicles inside the validated range"
                                       : "the median OLC of its vehicles, all outside the range",
                                *gallery, error);
        if (status == CP_OK && middle != highest)
            status =
                film_crash(store, data, vehicle[highest],
                           inside ? "the highest OLC of its vehicles inside the validated range"
                                  : "the highest OLC of its vehicles, all outside the range",
                           *gallery, error);
    }
    free(vehicle);
    free(order);
    free(olc_g);
    if (status != CP_OK) {
        json_decref(*gallery);
        *gallery = NULL;
    }
    return status;
}
