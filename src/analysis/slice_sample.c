/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/slice_sample.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool cp_study_crash_front_front(const cp_study_data *data, const cp_study_crash *crash)
{
    return strcmp(data->crash_type[crash->crash_type], "front-front") == 0;
}

// Whether the slice's conditions on the crash itself hold.
static bool fits(const cp_study_data *data, cp_slice slice, const cp_study_crash *crash)
{
    size_t scenario = data->replication[crash->replication].scenario;
    return (slice.scenario == CP_SLICE_ALL || slice.scenario == scenario) &&
           (slice.crash_type == CP_SLICE_ALL || slice.crash_type == crash->crash_type);
}

static bool chosen(cp_slice slice, size_t vehicle)
{
    return !slice.chosen || slice.chosen[vehicle];
}

bool cp_slice_has_crash(const cp_study_data *data, cp_slice slice, const cp_study_crash *crash)
{
    size_t a = 2 * (size_t)(crash - data->crash);
    return fits(data, slice, crash) && (chosen(slice, a) || chosen(slice, a + 1));
}

bool cp_slice_has_frontal_crash(const cp_study_data *data, cp_slice slice,
                                const cp_study_crash *crash)
{
    size_t a = 2 * (size_t)(crash - data->crash);
    if (!crash->frontal || !fits(data, slice, crash))
        return false;
    return !slice.chosen || (chosen(slice, a) && data->vehicle[a].frontal) ||
           (chosen(slice, a + 1) && data->vehicle[a + 1].frontal);
}

size_t cp_replication_set_cluster(const cp_replication_set *set, size_t replication)
{
    // The set is ascending.
    size_t low = 0, high = set->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (set->replication[middle] < replication)
            low = middle + 1;
        else
            high = middle;
    }
    return low < set->count && set->replication[low] == replication ? low : SIZE_MAX;
}

cp_status cp_replication_set_create(const cp_study_data *data, cp_slice slice, size_t variant,
                                    cp_replication_set *set, cp_error *error)
{
    *set = (cp_replication_set){0};
    set->replication = calloc(data->replication_count + 1, sizeof *set->replication);
    set->stratum = calloc(data->replication_count + 1, sizeof *set->stratum);
    set->frontal_crashes = calloc(data->replication_count + 1, sizeof *set->frontal_crashes);
    set->vehicle_km = calloc(data->replication_count + 1, sizeof *set->vehicle_km);
    if (!set->replication || !set->stratum || !set->frontal_crashes || !set->vehicle_km) {
        cp_replication_set_destroy(set);
        return cp_fail_memory(error, "the replications of a variant");
    }

    // Replications without a crash are clusters too: their exposure counts.
    for (size_t k = 0; k < data->replication_count; k++) {
        const cp_study_replication *replication = &data->replication[k];
        if (replication->variant != variant ||
            (slice.scenario != CP_SLICE_ALL && slice.scenario != replication->scenario))
            continue;
        set->replication[set->count] = k;
        set->stratum[set->count] = replication->scenario;
        set->vehicle_km[set->count++] = replication->vehicle_km;
    }
    for (size_t k = 0; k < data->crash_count; k++) {
        const cp_study_crash *crash = &data->crash[k];
        size_t cluster = cp_replication_set_cluster(set, crash->replication);
        if (cluster != SIZE_MAX && cp_slice_has_frontal_crash(data, slice, crash))
            set->frontal_crashes[cluster]++;
    }
    return CP_OK;
}

void cp_replication_set_destroy(cp_replication_set *set)
{
    free(set->replication);
    free(set->stratum);
    free(set->frontal_crashes);
    free(set->vehicle_km);
    *set = (cp_replication_set){0};
}

static void keep(cp_replication_set *set, size_t to, size_t from)
{
    set->replication[to] = set->replication[from];
    set->stratum[to] = set->stratum[from];
    set->frontal_crashes[to] = set->frontal_crashes[from];
    set->vehicle_km[to] = set->vehicle_km[from];
}

// Order of two replications by what pairs them.
static int pair_order(const cp_study_replication *a, const cp_study_replication *b)
{
    if (a->scenario != b->scenario)
        return a->scenario < b->scenario ? -1 : 1;
    if (a->number != b->number)
        return a->number < b->number ? -1 : 1;
    return (a->seed > b->seed) - (a->seed < b->seed);
}

void cp_replication_set_match(const cp_study_data *data, cp_replication_set *a,
                              cp_replication_set *b)
{
    // Both are in order of scenario and number: one walk over the two.
    size_t i = 0, j = 0, kept = 0;
    while (i < a->count && j < b->count) {
        int order = pair_order(&data->replication[a->replication[i]],
                               &data->replication[b->replication[j]]);
        if (order == 0) {
            keep(a, kept, i);
            keep(b, kept, j);
            kept++;
        }
        i += order <= 0;
        j += order >= 0;
    }
    a->count = b->count = kept;
}

cp_exposure cp_replication_set_exposure(const cp_replication_set *set)
{
    return (cp_exposure){set->count, set->frontal_crashes, set->vehicle_km};
}

// NAN: no observation; -INFINITY: below every value.
static double observation(const cp_study_vehicle *vehicle, cp_slice_quantity quantity)
{
    if (quantity == CP_QUANTITY_CLOSING_SPEED)
        return vehicle->closing_speed_m_s;
    if (quantity == CP_QUANTITY_LATERAL_OFFSET)
        return vehicle->lateral_offset_m;
    if (quantity == CP_QUANTITY_ANGLE)
        return vehicle->angle_rad;
    if (vehicle->olc == CP_OLC_FAILED)
        return NAN;
    if (quantity == CP_QUANTITY_DELTA_V)
        return vehicle->delta_v_m_s;
    return vehicle->olc == CP_OLC_KNOWN ? vehicle->olc_g : -INFINITY;
}

/* What a vehicle gives to a sample; NAN: nothing. */
typedef double (*observe)(const cp_study_vehicle *vehicle, const void *context);

// Whether a vehicle is of what a sample is about.
static bool belongs(const cp_study_data *data, cp_slice slice, size_t vehicle)
{
    return data->vehicle[vehicle].frontal && chosen(slice, vehicle);
}

// per_crash: what both vehicles of a crash have in common counts once, for role a where it belongs.
static cp_status collect(const cp_study_data *data, const cp_replication_set *set, cp_slice slice,
                         bool per_crash, observe of, const void *context, cp_sample *sample,
                         cp_error *error)
{
    double *value = calloc(data->vehicle_count + 1, sizeof *value);
    size_t *cluster = calloc(data->vehicle_count + 1, sizeof *cluster);
    cp_status status = CP_NO_MEMORY;
    size_t count = 0;
    if (!value || !cluster) {
        status = cp_fail_memory(error, "a sample");
        goto done;
    }
    for (size_t k = 0; k < data->vehicle_count; k++) {
        const cp_study_vehicle *vehicle = &data->vehicle[k];
        const cp_study_crash *crash = &data->crash[vehicle->crash];
        double seen = of(vehicle, context);
        size_t own = cp_replication_set_cluster(set, crash->replication);
        if (own == SIZE_MAX || isnan(seen) || !belongs(data, slice, k) || !fits(data, slice, crash))
            continue;
        if (per_crash && k % 2 == 1 && belongs(data, slice, k - 1) &&
            !isnan(of(&data->vehicle[k - 1], context)))
            continue;
        value[count] = seen;
        cluster[count++] = own;
    }
    status = cp_sample_create(value, cluster, count, set->count, sample, error);

done:
    free(value);
    free(cluster);
    return status;
}

/* A quantity within a scope. */
typedef struct quantity_in_scope {
    cp_slice_quantity quantity;
    int scope;
} quantity_in_scope;

static double observe_quantity(const cp_study_vehicle *vehicle, const void *context)
{
    const quantity_in_scope *q = context;
    return q->scope == CP_SCOPE_INSIDE && vehicle->validity != 0
               ? NAN
               : observation(vehicle, q->quantity);
}

cp_status cp_slice_sample(const cp_study_data *data, const cp_replication_set *set, cp_slice slice,
                          int scope, cp_slice_quantity quantity, cp_sample *sample, cp_error *error)
{
    const quantity_in_scope q = {quantity, scope};
    bool of_crash = quantity != CP_QUANTITY_OLC && quantity != CP_QUANTITY_DELTA_V;
    return collect(data, set, slice, of_crash, observe_quantity, &q, sample, error);
}

static double observe_bound(const cp_study_vehicle *vehicle, const void *context)
{
    const bool *highest = context;
    if (vehicle->validity != 0 || vehicle->olc == CP_OLC_FAILED)
        return *highest ? DBL_MAX : -INFINITY;
    return observation(vehicle, CP_QUANTITY_OLC);
}

cp_status cp_slice_bound(const cp_study_data *data, const cp_replication_set *set, cp_slice slice,
                         bool highest, cp_sample *sample, cp_error *error)
{
    return collect(data, set, slice, false, observe_bound, &highest, sample, error);
}

void cp_slice_injuries(const cp_study_data *data, const cp_replication_set *set, cp_slice slice,
                       int scope, const cp_study_risk *risk, double *expected, cp_injury_sum *sum)
{
    *sum = (cp_injury_sum){0};
    for (size_t k = 0; k < set->count; k++)
        expected[k] = 0.0;
    for (size_t k = 0; k < data->vehicle_count; k++) {
        const cp_study_vehicle *vehicle = &data->vehicle[k];
        const cp_study_crash *crash = &data->crash[vehicle->crash];
        size_t own = cp_replication_set_cluster(set, crash->replication);
        if (own == SIZE_MAX || !crash->frontal || !chosen(slice, k) || !fits(data, slice, crash) ||
            (risk->frontal_only && !vehicle->frontal) ||
            (scope == CP_SCOPE_INSIDE && vehicle->validity != 0))
            continue;
        double p = cp_risk_add(&risk->function, vehicle->predictor[risk->predictor],
                               data->crash_type[crash->crash_type], 1.0, sum->gradient);
        if (isnan(p)) {
            sum->unknown++;
            continue;
        }
        sum->drivers++;
        sum->expected += p;
        expected[own] += p;
    }
}

double cp_injury_ratio_se(const cp_risk_function *function, const cp_injury_sum *a,
                          const cp_injury_sum *b)
{
    // The gradient of the logarithm: what both have in common cancels.
    double gradient[CP_RISK_PARAMETERS_MAX];
    for (size_t k = 0; k < cp_risk_parameters(function); k++)
        gradient[k] = b->gradient[k] / b->expected - a->gradient[k] / a->expected;
    return sqrt(cp_risk_variance(function, gradient));
}
