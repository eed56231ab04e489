/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/field_units.h"

#include "analysis/pair_risk.h"

#include <gsl/gsl_sort.h>

#include <math.h>
#include <stdlib.h>

static const bool ORDERED[CP_FIELD_MARGIN_COUNT] = {
#define MARGIN_ORDERED(name, text, classes, ordered) ordered,
    CP_FIELD_MARGINS(MARGIN_ORDERED)
#undef MARGIN_ORDERED
};

cp_status cp_field_margins_of(const cp_field_request *request, cp_field_margin without,
                              cp_field_margins *margins, cp_error *error)
{
    *margins = (cp_field_margins){.raking = {.cap = request->cap}};
    for (int m = 0; m < CP_FIELD_MARGIN_COUNT; m++) {
        cp_status status =
            cp_field_table_shares(request->table, (cp_field_margin)m, margins->share[m], error);
        if (status != CP_OK)
            return status;
        double sum = 0.0;
        for (size_t k = 0; k < CP_FIELD_MARGIN_CLASSES[m]; k++)
            sum += margins->share[m][k].share_1;
        if (!request->margin[m] || m == (int)without || !(sum > 0.0))
            continue;
        cp_raking_margin *to = &margins->raking.margin[margins->raking.count];
        *to = (cp_raking_margin){.count = CP_FIELD_MARGIN_CLASSES[m], .ordered = ORDERED[m]};
        for (size_t k = 0; k < to->count; k++)
            to->target[k] = margins->share[m][k].share_1;
        margins->of[margins->raking.count++] = (cp_field_margin)m;
    }
    return CP_OK;
}

unsigned char cp_field_study_class(const cp_study_data *data, const cp_field_study *study,
                                   size_t vehicle, cp_field_margin margin)
{
    const cp_study_crash *crash = &data->crash[data->vehicle[vehicle].crash];
    if (margin == CP_FIELD_TYPE)
        return cp_field_type_class(data->crash_type[crash->crash_type]);
    return margin == CP_FIELD_DELTA_V
               ? cp_field_delta_v_class(study->value[CP_FIELD_VALUE_DELTA_V][vehicle])
               : cp_field_overlap_class(study->value[CP_FIELD_VALUE_OVERLAP][vehicle]);
}

size_t cp_field_events(const cp_study_data *data)
{
    return CP_FIELD_INJURED + data->risk_count;
}

// ---- events of the set's own crashes ---------------------------------------------------------

// Whether a vehicle is a unit.
static bool belongs(const cp_field_source *s, size_t vehicle)
{
    const cp_study_crash *crash = &s->data->crash[s->data->vehicle[vehicle].crash];
    return s->data->vehicle[vehicle].frontal && (!s->slice.chosen || s->slice.chosen[vehicle]) &&
           cp_slice_has_frontal_crash(s->data, s->slice, crash);
}

static double risk_of(const cp_field_source *s, size_t vehicle, size_t risk, double times,
                      double *gradient)
{
    const cp_study_vehicle *v = &s->data->vehicle[vehicle];
    const cp_study_crash *crash = &s->data->crash[v->crash];
    const cp_study_risk *r = &s->data->risk[risk];
    double p = cp_risk_add(&r->function, v->predictor[r->predictor],
                           s->data->crash_type[crash->crash_type], times, gradient);
    return isnan(p) ? 0.0 : p;
}

// Injured drivers a unit stands for: its own, and its part of the other one's, who is no unit,
// where the function is of both.
static double injured_of(const cp_field_source *s, const cp_field_units *u, size_t k, size_t risk,
                         double times, double *gradient)
{
    size_t vehicle = u->vehicle[k], other = vehicle ^ 1;
    double sum = risk_of(s, vehicle, risk, times, gradient), part = 1.0 / (double)u->fronts[k];
    if (!s->data->risk[risk].frontal_only && !belongs(s, other))
        sum += part * risk_of(s, other, risk, times * part, gradient);
    return sum;
}

// Whether the larger severity of a crash's units lies above x.
static bool is_above(const cp_field_source *s, size_t vehicle, cp_exceeded what)
{
    double largest = -INFINITY;
    for (size_t k = vehicle & ~(size_t)1; k < (vehicle | 1) + 1; k++) {
        const cp_study_vehicle *v = &s->data->vehicle[k];
        if (!belongs(s, k) || v->olc == CP_OLC_FAILED)
            continue;
        double value = what == CP_EXCEEDED_DELTA_V ? v->predictor[CP_PREDICTOR_DELTA_V_COMMON]
                       : v->olc == CP_OLC_KNOWN    ? v->olc_g
                                                   : -INFINITY;
        largest = fmax(largest, value);
    }
    return largest > s->above[what];
}

static void take_events(const cp_field_source *s, cp_field_units *u, size_t k)
{
    double *event = u->event + k * cp_field_events(s->data);
    event[CP_FIELD_CRASH] = 1.0 / (double)u->fronts[k];
    for (int what = 0; what < CP_EXCEEDED_COUNT; what++)
        event[CP_FIELD_ABOVE + what] =
            is_above(s, u->vehicle[k], (cp_exceeded)what) / (double)u->fronts[k];
    for (size_t r = 0; r < s->data->risk_count; r++)
        event[CP_FIELD_INJURED + r] = injured_of(s, u, k, r, 1.0, NULL);
}

// ---- events of pairs -------------------------------------------------------------------------

// Injured drivers of a pair's crash, before or after.
static double pair_injured(const cp_field_source *s, const cp_study_pair *pair, size_t risk,
                           bool treated, double times, double *gradient)
{
    double sum = 0.0;
    for (size_t role = 0; role < 2; role++) {
        double p =
            cp_pair_risk(s->data, pair, &s->data->risk[risk], role, treated, times, gradient);
        sum += isnan(p) ? 0.0 : p;
    }
    return sum;
}

static void take_pair_events(const cp_field_source *s, cp_field_units *u, size_t k)
{
    const cp_study_pair *pair = &s->data->pair[u->pair[k]];
    size_t events = cp_field_events(s->data);
    double part = 1.0 / (double)u->fronts[k], delta_v = -INFINITY;
    double *before = u->event + k * events, *after = u->treated + k * events;
    bool crashes = pair->outcome != CP_OUTCOME_AVOIDED;
    for (size_t role = 0; role < 2; role++)
        if (pair->treated_frontal[role])
            delta_v = fmax(delta_v, pair->predictor[role][CP_PREDICTOR_DELTA_V_COMMON]);
    after[CP_FIELD_CRASH] = crashes * part;
    after[CP_FIELD_ABOVE + CP_EXCEEDED_OLC] =
        (crashes && pair->olc_g[1] > s->above[CP_EXCEEDED_OLC]) * part;
    after[CP_FIELD_ABOVE + CP_EXCEEDED_DELTA_V] =
        (crashes && delta_v > s->above[CP_EXCEEDED_DELTA_V]) * part;
    for (size_t r = 0; r < s->data->risk_count; r++) {
        before[CP_FIELD_INJURED + r] = part * pair_injured(s, pair, r, false, 1.0, NULL);
        after[CP_FIELD_INJURED + r] = part * pair_injured(s, pair, r, true, 1.0, NULL);
    }
}

// ---- units -----------------------------------------------------------------------------------

// The valid pair of a crash with a treatment; SIZE_MAX: none. Pairs are in the order of crashes.
static size_t pair_of(const cp_study_data *data, size_t crash, size_t variant, size_t *from)
{
    while (*from < data->pair_count && data->pair[*from].crash < crash)
        (*from)++;
    for (size_t k = *from; k < data->pair_count && data->pair[k].crash == crash; k++)
        if (data->pair[k].variant == variant && data->pair[k].outcome != CP_OUTCOME_INVALID)
            return k;
    return SIZE_MAX;
}

// Vehicles that are units, in the order of the study.
static void find(const cp_field_source *s, size_t variant, cp_field_units *u)
{
    size_t from = 0;
    for (size_t k = 0; k < s->data->vehicle_count; k++) {
        size_t crash = s->data->vehicle[k].crash, pair = SIZE_MAX;
        size_t own = cp_replication_set_cluster(s->set, s->data->crash[crash].replication);
        if (own == SIZE_MAX || !belongs(s, k))
            continue;
        if (variant != SIZE_MAX)
            pair = pair_of(s->data, crash, variant, &from);
        if (variant != SIZE_MAX && pair == SIZE_MAX)
            continue;
        u->vehicle[u->count] = k;
        u->pair[u->count] = pair;
        u->cluster[u->count++] = own;
    }
}

// Failed simulations last, left-censored ones first.
static double sort_key(const cp_study_vehicle *v)
{
    return v->olc == CP_OLC_FAILED ? INFINITY : v->olc == CP_OLC_KNOWN ? v->olc_g : -INFINITY;
}

static cp_status sort(const cp_field_source *s, cp_field_units *u, cp_error *error)
{
    double *key = calloc(u->count + 1, sizeof *key);
    size_t *order = calloc(u->count + 1, sizeof *order), *old = calloc(u->count + 1, sizeof *old);
    size_t *of[] = {u->vehicle, u->pair, u->cluster};
    cp_status status = key && order && old ? CP_OK : cp_fail_memory(error, "units to be weighted");
    for (size_t k = 0; status == CP_OK && k < u->count; k++)
        key[k] = sort_key(&s->data->vehicle[u->vehicle[k]]);
    if (status == CP_OK)
        gsl_sort_index(order, key, 1, u->count);
    for (size_t a = 0; status == CP_OK && a < sizeof of / sizeof *of; a++) {
        for (size_t k = 0; k < u->count; k++)
            old[k] = of[a][k];
        for (size_t k = 0; k < u->count; k++)
            of[a][k] = old[order[k]];
    }
    for (size_t k = 0; status == CP_OK && k < u->count; k++) {
        u->severity[k] = key[order[k]];
        u->severities += !(isinf(u->severity[k]) && u->severity[k] > 0.0);
    }
    free(key);
    free(order);
    free(old);
    return status;
}

cp_status cp_field_units_create(const cp_field_source *source, size_t variant,
                                cp_field_units *units, cp_error *error)
{
    size_t most = source->data->vehicle_count + 1, events = cp_field_events(source->data);
    *units = (cp_field_units){.vehicle = calloc(most, sizeof *units->vehicle),
                              .pair = calloc(most, sizeof *units->pair),
                              .fronts = calloc(most, sizeof *units->fronts),
                              .cluster = calloc(most, sizeof *units->cluster),
                              .classes = calloc(most, sizeof *units->classes),
                              .event = calloc(most * events, sizeof *units->event),
                              .treated = calloc(most * events, sizeof *units->treated),
                              .severity = calloc(most, sizeof *units->severity)};
    if (!units->vehicle || !units->pair || !units->fronts || !units->cluster || !units->classes ||
        !units->event || !units->treated || !units->severity)
        return cp_fail_memory(error, "units to be weighted");
    find(source, variant, units);
    cp_status status = sort(source, units, error);
    for (size_t k = 0; status == CP_OK && k < units->count; k++) {
        size_t vehicle = units->vehicle[k];
        units->fronts[k] = 1 + (size_t)belongs(source, vehicle ^ 1);
        for (size_t m = 0; m < source->margins->raking.count; m++)
            units->classes[k].of[m] = cp_field_study_class(source->data, source->request->study,
                                                           vehicle, source->margins->of[m]);
        take_events(source, units, k);
        if (variant != SIZE_MAX)
            take_pair_events(source, units, k);
    }
    return status;
}

void cp_field_units_destroy(cp_field_units *units)
{
    free(units->vehicle);
    free(units->pair);
    free(units->fronts);
    free(units->cluster);
    free(units->classes);
    free(units->event);
    free(units->treated);
    free(units->severity);
    *units = (cp_field_units){0};
}

cp_raked_arm cp_field_units_arm(const cp_field_source *source, const cp_field_units *units,
                                bool treated)
{
    return (cp_raked_arm){
        .count = units->count,
        .cluster = units->cluster,
        .classes = units->classes,
        .event = treated ? units->treated : units->event,
        .severity = units->severity,
        .severities = treated ? 0 : units->severities,
        .cluster_count = source->set->count,
        .exposure = source->set->vehicle_km,
        .stratum = source->set->stratum,
    };
}

cp_injury_sum cp_field_units_injured(const cp_field_source *source, const cp_field_units *units,
                                     const double *weight, size_t risk, bool treated)
{
    cp_injury_sum sum = {0};
    for (size_t k = 0; k < units->count; k++) {
        double times = weight ? weight[k] : 1.0, part = times / (double)units->fronts[k];
        if (units->pair[k] == SIZE_MAX)
            sum.expected += times * injured_of(source, units, k, risk, times, sum.gradient);
        else
            sum.expected += part * pair_injured(source, &source->data->pair[units->pair[k]], risk,
                                                treated, part, sum.gradient);
    }
    return sum;
}
