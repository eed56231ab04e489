/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/gallery.h"

#include "core/log.h"
#include "core/rng.h"
#include "core/units.h"
#include "report/animation.h"
#include "report/query_json.h"
#include "store/query.h"
#include "store/result_rows.h"
#include "store/stored_crash.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>

#include <math.h>
#include <stdlib.h>

#define FRAME_INTERVAL_S 0.004

// ---- single crashes --------------------------------------------------------------------------

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

// ---- corridors ---------------------------------------------------------------------------------

/* A vehicle that has a pulse: of a crash as it happened, or of a treated one. */
typedef struct pulse_owner {
    const cp_study_vehicle *vehicle;
    size_t variant;
    bool treated;
} pulse_owner;

// The study's vehicles first, then the treated ones.
static pulse_owner owner_of(const cp_study_data *data, size_t k)
{
    if (k >= data->vehicle_count) {
        const cp_study_treated *t = &data->treated[k - data->vehicle_count];
        return (pulse_owner){&t->vehicle, t->variant, true};
    }
    const cp_study_vehicle *v = &data->vehicle[k];
    return (pulse_owner){v, data->replication[data->crash[v->crash].replication].variant, false};
}

static bool may_have_pulse(const pulse_owner *owner)
{
    return owner->vehicle->frontal && owner->vehicle->olc != CP_OLC_FAILED;
}

static cp_status has_pulse(void *context, const cp_row *row, cp_error *error)
{
    (void)error;
    *(bool *)context = row->cell[0].integer != 0;
    return CP_OK;
}

static cp_status read_stored(cp_store *store, const cp_study_data *data, const pulse_owner *owner,
                             cp_pulse *stored, bool *there, cp_error *error)
{
    int64_t crash_id = data->crash[owner->vehicle->crash].id;
    const char role[2] = {owner->vehicle->role, '\0'};
    if (owner->treated)
        return cp_counterfactual_pulse_read(store, crash_id, data->variant[owner->variant].name,
                                            role, stored, there, error);
    cp_query_handler handler = {.row = has_pulse, .context = there};
    cp_cell cell[2] = {cp_cell_integer(crash_id), cp_cell_text(role)};
    cp_status status =
        cp_query(store, "SELECT EXISTS (SELECT 1 FROM pulse WHERE crash_id = ?1 AND role = ?2)",
                 cell, 2, &handler, error);
    return status == CP_OK && *there ? cp_result_pulse_read(store, crash_id, role, stored, error)
                                     : status;
}

static cp_status read_pulse(cp_store *store, const cp_study_data *data, const pulse_owner *owner,
                            float g[CP_CORRIDOR_POINTS], bool *there, cp_error *error)
{
    cp_pulse stored = {0}, filtered = {0};
    cp_status status = read_stored(store, data, owner, &stored, there, error);
    if (status == CP_OK && *there)
        status = cp_pulse_filtered(&stored, 60.0, &filtered, error);
    for (size_t k = 0; k < CP_CORRIDOR_POINTS && status == CP_OK && *there; k++) {
        size_t sample =
            (size_t)((double)k * CP_CORRIDOR_INTERVAL_S / filtered.sample_interval_s + 0.5);
        g[k] = sample < filtered.sample_count
                   ? (float)(-filtered.channel[CP_CHANNEL_AX][sample] / CP_G0_M_S2)
                   : NAN;
    }
    cp_pulse_destroy(&stored);
    cp_pulse_destroy(&filtered);
    return status;
}

// Chance of a vehicle to be drawn, so that about the wanted number of its variant is.
static double *chances(const cp_study_data *data)
{
    double *chance = calloc(data->variant_count + 1, sizeof *chance);
    for (size_t k = 0; chance && k < data->vehicle_count + data->treated_count; k++) {
        pulse_owner owner = owner_of(data, k);
        chance[owner.variant] += may_have_pulse(&owner);
    }
    for (size_t v = 0; chance && v < data->variant_count; v++)
        chance[v] = chance[v] > 0.0 ? CP_CORRIDOR_PULSES_MAX / chance[v] : 0.0;
    return chance;
}

cp_status cp_corridor_read(cp_store *store, const cp_study_data *data, cp_corridor_pulses *pulses,
                           cp_error *error)
{
    *pulses = (cp_corridor_pulses){0};
    double *chance = chances(data);
    size_t room = (size_t)2 * CP_CORRIDOR_PULSES_MAX * (data->variant_count + 1);
    size_t count = data->vehicle_count + data->treated_count;
    pulses->vehicle = calloc(room, sizeof *pulses->vehicle);
    pulses->g = calloc(room, sizeof *pulses->g);
    cp_status status = CP_OK;
    if (!chance || !pulses->vehicle || !pulses->g)
        status = cp_fail_memory(error, "pulses of a report");
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(data->seed), "report pulses");
    for (size_t k = 0; k < count && pulses->count < room && status == CP_OK; k++) {
        pulse_owner owner = owner_of(data, k);
        const cp_study_vehicle *v = owner.vehicle;
        uint64_t own = (uint64_t)data->crash[v->crash].id * 2 + (v->role == 'b');
        if (!may_have_pulse(&owner) || cp_rng_uniform(key, own) >= chance[owner.variant])
            continue;
        bool there = false;
        status = read_pulse(store, data, &owner, pulses->g[pulses->count], &there, error);
        if (status == CP_OK && there)
            pulses->vehicle[pulses->count++] = k;
    }
    free(chance);
    if (status != CP_OK)
        cp_corridor_destroy(pulses);
    return status;
}

void cp_corridor_destroy(cp_corridor_pulses *pulses)
{
    free(pulses->vehicle);
    free(pulses->g);
    *pulses = (cp_corridor_pulses){0};
}

json_t *cp_corridor_json(const cp_corridor_pulses *pulses, const unsigned char *chosen)
{
    static const char *const NAME[] = {"p10", "p50", "p90"};
    static const double PART[] = {0.1, 0.5, 0.9};
    size_t n = 0;
    for (size_t k = 0; k < pulses->count; k++)
        n += chosen[pulses->vehicle[k]];
    json_t *object = json_pack("{s:I}", "n", (json_int_t)n);
    double *value = calloc(n + 1, sizeof *value);
    json_t *curve[3] = {json_array(), json_array(), json_array()};
    for (size_t t = 0; value && n >= 3 && t < CP_CORRIDOR_POINTS; t++) {
        size_t count = 0;
        for (size_t k = 0; k < pulses->count; k++)
            if (chosen[pulses->vehicle[k]] && !isnan(pulses->g[k][t]))
                value[count++] = (double)pulses->g[k][t];
        if (count < 3)
            break;
        gsl_sort(value, 1, count);
        for (int c = 0; c < 3; c++)
            json_array_append_new(curve[c],
                                  json_real(round(100.0 * gsl_stats_quantile_from_sorted_data(
                                                              value, 1, count, PART[c])) /
                                            100.0));
    }
    for (int c = 0; c < 3; c++)
        json_object_set_new(object, NAME[c], curve[c]);
    free(value);
    return object;
}
