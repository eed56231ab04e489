/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/model_ensemble.h"

#include "analysis/study_places.h"
#include "store/query.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Sets are numbered from 0; one that lacks a number before its last has none that can be used. */
static const char SETS[] =
    "SELECT coalesce(min(CASE WHEN sets = highest + 1 THEN sets ELSE 0 END), 0) FROM"
    " (SELECT count(*) AS sets, max(member) AS highest FROM crash_vehicle_member"
    " GROUP BY crash_id, role UNION ALL SELECT count(*), max(member)"
    " FROM counterfactual_vehicle_member GROUP BY crash_id, variant_id, role)";

static const char VEHICLES[] =
    CP_STUDY_PLACES "SELECT c.place, m.role, m.member, m.olc_status = 'simulation_failed', m.olc_g"
                    " FROM crash_vehicle_member AS m JOIN c ON c.id = m.crash_id"
                    " WHERE m.member < ?1";

// Like the treated OLC of the view counterfactual_pair, by each set that a vehicle of it has.
static const char PAIRS[] = CP_STUDY_PLACES
    ", n AS (SELECT DISTINCT crash_id, variant_id, member FROM counterfactual_vehicle_member"
    " WHERE member < ?1),"
    " x AS (SELECT n.*, w.frontal, coalesce(m.olc_status, w.olc_status) AS status,"
    " CASE WHEN m.member IS NULL THEN w.olc_g ELSE m.olc_g END AS olc_g FROM n"
    " JOIN counterfactual_vehicle AS w ON w.crash_id = n.crash_id AND w.variant_id = n.variant_id"
    " LEFT JOIN counterfactual_vehicle_member AS m ON m.crash_id = w.crash_id"
    " AND m.variant_id = w.variant_id AND m.role = w.role AND m.member = n.member)"
    " SELECT c.place, v.place, x.member, sum(x.status = 'simulation_failed') > 0,"
    " max(coalesce(x.olc_g, 0.0)) FROM x JOIN c ON c.id = x.crash_id"
    " JOIN v ON v.id = x.variant_id AND v.sweep = '' WHERE x.frontal = 1"
    " GROUP BY x.crash_id, x.variant_id, x.member";

typedef struct reader {
    const cp_study_data *data;
    cp_model_ensemble *ensemble;
} reader;

static cp_status changed(cp_error *error)
{
    return cp_fail(error, CP_STORE_FAILED, "the database changed while it was read");
}

static cp_status read_vehicle(void *context, const cp_row *row, cp_error *error)
{
    const reader *r = context;
    size_t crash = (size_t)row->cell[0].integer, set = (size_t)row->cell[2].integer;
    size_t vehicle = 2 * crash + (row->cell[1].text[0] == 'b');
    if (vehicle >= r->data->vehicle_count || set >= r->ensemble->count)
        return changed(error);
    double olc_g = row->cell[4].real;
    if (row->cell[3].integer)
        olc_g = INFINITY;
    r->ensemble->olc_g[set * r->data->vehicle_count + vehicle] = isnan(olc_g) ? -INFINITY : olc_g;
    return CP_OK;
}

// Pairs stand by crash and variant.
static size_t find_pair(const cp_study_data *data, size_t crash, size_t variant)
{
    size_t low = 0, high = data->pair_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const cp_study_pair *pair = &data->pair[middle];
        if (pair->crash < crash || (pair->crash == crash && pair->variant < variant))
            low = middle + 1;
        else
            high = middle;
    }
    bool found = low < data->pair_count && data->pair[low].crash == crash &&
                 data->pair[low].variant == variant;
    return found ? low : SIZE_MAX;
}

static cp_status read_pair(void *context, const cp_row *row, cp_error *error)
{
    const reader *r = context;
    size_t set = (size_t)row->cell[2].integer;
    size_t pair = find_pair(r->data, (size_t)row->cell[0].integer, (size_t)row->cell[1].integer);
    if (pair == SIZE_MAX || set >= r->ensemble->count)
        return changed(error);
    r->ensemble->treated_g[set * r->data->pair_count + pair] =
        row->cell[3].integer ? INFINITY : row->cell[4].real;
    return CP_OK;
}

static cp_status make_room(const cp_study_data *data, cp_model_ensemble *ensemble, cp_error *error)
{
    size_t vehicles = ensemble->count * data->vehicle_count;
    size_t pairs = ensemble->count * data->pair_count;
    ensemble->vehicle_count = data->vehicle_count;
    ensemble->pair_count = data->pair_count;
    ensemble->olc_g = calloc(vehicles + 1, sizeof *ensemble->olc_g);
    ensemble->treated_g = calloc(pairs + 1, sizeof *ensemble->treated_g);
    ensemble->vehicle = calloc(data->vehicle_count + 1, sizeof *ensemble->vehicle);
    ensemble->pair = calloc(data->pair_count + 1, sizeof *ensemble->pair);
    if (!ensemble->olc_g || !ensemble->treated_g || !ensemble->vehicle || !ensemble->pair)
        return cp_fail_memory(error, "the ensemble of a study");
    for (size_t k = 0; k < vehicles; k++)
        ensemble->olc_g[k] = NAN;
    for (size_t k = 0; k < pairs; k++)
        ensemble->treated_g[k] = NAN;
    return CP_OK;
}

cp_status cp_model_ensemble_read(cp_store *store, const cp_study_data *data,
                                 cp_model_ensemble *ensemble, cp_error *error)
{
    *ensemble = (cp_model_ensemble){0};
    double count = 0.0;
    cp_status status = cp_query_number(store, SETS, &count, error);
    ensemble->count = (size_t)count;
    if (status == CP_OK)
        status = make_room(data, ensemble, error);
    reader r = {data, ensemble};
    const cp_query_handler vehicles = {.row = read_vehicle, .context = &r};
    const cp_query_handler pairs = {.row = read_pair, .context = &r};
    const cp_cell sets = cp_cell_integer((int64_t)count);
    if (status == CP_OK && ensemble->count > 0)
        status = cp_query(store, VEHICLES, &sets, 1, &vehicles, error);
    if (status == CP_OK && ensemble->count > 0 && data->counterfactual)
        status = cp_query(store, PAIRS, &sets, 1, &pairs, error);
    return status == CP_OK ? CP_OK : cp_error_prefix(error, "%s: ", cp_store_path(store));
}

void cp_model_ensemble_destroy(cp_model_ensemble *ensemble)
{
    free(ensemble->olc_g);
    free(ensemble->treated_g);
    free(ensemble->vehicle);
    free(ensemble->pair);
    *ensemble = (cp_model_ensemble){0};
}

// The baseline's side of a pair: the larger of the frontally struck vehicles, left-censored as 0.
static double larger_g(const cp_study_vehicle *of_crash)
{
    double larger = NAN;
    for (size_t role = 0; role < 2; role++) {
        const cp_study_vehicle *v = &of_crash[role];
        if (!v->frontal)
            continue;
        if (v->olc == CP_OLC_FAILED)
            return NAN;
        larger = fmax(larger, v->olc == CP_OLC_KNOWN ? v->olc_g : 0.0);
    }
    return larger;
}

cp_study_data cp_model_ensemble_study(const cp_model_ensemble *ensemble, const cp_study_data *data,
                                      size_t set)
{
    const double *olc_g = ensemble->olc_g + set * ensemble->vehicle_count;
    const double *treated_g = ensemble->treated_g + set * ensemble->pair_count;
    for (size_t k = 0; k < ensemble->vehicle_count; k++) {
        cp_study_vehicle *v = &ensemble->vehicle[k];
        *v = data->vehicle[k];
        if (isnan(olc_g[k]))
            continue;
        v->olc = CP_OLC_KNOWN;
        if (isinf(olc_g[k]))
            v->olc = olc_g[k] < 0.0 ? CP_OLC_CENSORED : CP_OLC_FAILED;
        v->olc_g = v->olc == CP_OLC_KNOWN ? olc_g[k] : NAN;
    }
    for (size_t k = 0; k < ensemble->pair_count; k++) {
        cp_study_pair *pair = &ensemble->pair[k];
        *pair = data->pair[k];
        pair->olc_g[0] = larger_g(&ensemble->vehicle[2 * pair->crash]);
        if (pair->outcome != CP_OUTCOME_AVOIDED && !isnan(treated_g[k]))
            pair->olc_g[1] = isinf(treated_g[k]) ? NAN : treated_g[k];
    }
    cp_study_data by_set = *data;
    by_set.vehicle = ensemble->vehicle;
    by_set.pair = ensemble->pair;
    return by_set;
}
