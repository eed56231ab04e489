/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/corridor.h"

#include "analysis/any_vehicle.h"
#include "core/rng.h"
#include "core/units.h"
#include "store/stored_pulse.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>

#include <math.h>
#include <stdlib.h>

static bool may_have_pulse(const cp_any_vehicle *owner)
{
    return owner->vehicle->frontal && owner->vehicle->olc != CP_OLC_FAILED;
}

static cp_status read_pulse(cp_store *store, const cp_study_data *data, const cp_any_vehicle *owner,
                            float g[CP_CORRIDOR_POINTS], bool *there, cp_error *error)
{
    cp_pulse stored = {0}, filtered = {0};
    const char role[2] = {owner->vehicle->role, '\0'};
    const char *variant = owner->treated ? data->variant[owner->variant].name : NULL;
    cp_status status =
        cp_stored_pulse_read(store, owner->crash->id, variant, role, &stored, there, error);
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
    for (size_t k = 0; chance && k < cp_any_vehicle_count(data); k++) {
        cp_any_vehicle owner = cp_any_vehicle_at(data, k);
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
    size_t count = cp_any_vehicle_count(data);
    pulses->vehicle = calloc(room, sizeof *pulses->vehicle);
    pulses->g = calloc(room, sizeof *pulses->g);
    cp_status status = CP_OK;
    if (!chance || !pulses->vehicle || !pulses->g)
        status = cp_fail_memory(error, "pulses of a report");
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(data->seed), "report pulses");
    for (size_t k = 0; k < count && pulses->count < room && status == CP_OK; k++) {
        cp_any_vehicle owner = cp_any_vehicle_at(data, k);
        const cp_study_vehicle *v = owner.vehicle;
        uint64_t own = (uint64_t)owner.crash->id * 2 + (v->role == 'b');
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

#define PULSES_MIN 3 /* of which a corridor is drawn */

// The part of sorted values in hundredths of a g.
static double part_of(const double *sorted, size_t count, double part)
{
    return round(100.0 * gsl_stats_quantile_from_sorted_data(sorted, 1, count, part)) / 100.0;
}

cp_status cp_corridor_of(const cp_corridor_pulses *pulses, const unsigned char *chosen,
                         cp_corridor *corridor, cp_error *error)
{
    *corridor = (cp_corridor){0};
    double *value = calloc(pulses->count + 1, sizeof *value);
    if (!value)
        return cp_fail_memory(error, "pulses of a report");
    for (size_t k = 0; k < pulses->count; k++)
        corridor->pulses += chosen[pulses->vehicle[k]];
    for (size_t t = 0; corridor->pulses >= PULSES_MIN && t < CP_CORRIDOR_POINTS; t++) {
        size_t count = 0;
        for (size_t k = 0; k < pulses->count; k++)
            if (chosen[pulses->vehicle[k]] && !isnan(pulses->g[k][t]))
                value[count++] = (double)pulses->g[k][t];
        if (count < PULSES_MIN)
            break;
        gsl_sort(value, 1, count);
        corridor->p10_g[t] = part_of(value, count, 0.1);
        corridor->p50_g[t] = part_of(value, count, 0.5);
        corridor->p90_g[t] = part_of(value, count, 0.9);
        corridor->points++;
    }
    free(value);
    return CP_OK;
}
