/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/exceedance_figures.h"

#include <math.h>
#include <stdlib.h>

static const double STEP[CP_EXCEEDED_COUNT] = {
#define CP_EXCEEDED_STEP_OF(name, text, unit, largest, step, headline) step,
    CP_EXCEEDED(CP_EXCEEDED_STEP_OF)
#undef CP_EXCEEDED_STEP_OF
};

/* What is known of one frontal crash: the largest severity of its frontally struck vehicles; of
 * those inside validity, -INFINITY without any; and whether one of them is not known for certain.
 */
typedef struct crash_severity {
    size_t cluster;
    double largest;
    double inside;
    bool open;
} crash_severity;

typedef struct severities {
    size_t count;
    crash_severity *crash;
} severities;

static crash_severity severity_of(const cp_study_data *data, cp_slice slice, size_t crash,
                                  cp_exceeded what)
{
    crash_severity s = {SIZE_MAX, -INFINITY, -INFINITY, false};
    for (size_t k = 2 * crash; k < 2 * crash + 2; k++) {
        const cp_study_vehicle *v = &data->vehicle[k];
        if (!v->frontal || (slice.chosen && !slice.chosen[k]))
            continue;
        double value = what == CP_EXCEEDED_DELTA_V ? v->delta_v_m_s : v->olc_g;
        bool failed = v->olc == CP_OLC_FAILED || (what == CP_EXCEEDED_DELTA_V && isnan(value));
        bool inside = v->validity == 0 && !failed;
        s.open |= !inside;
        if (failed || (what == CP_EXCEEDED_OLC && v->olc == CP_OLC_CENSORED))
            continue;
        s.largest = fmax(s.largest, value);
        if (inside)
            s.inside = fmax(s.inside, value);
    }
    return s;
}

// The frontal crashes of a set's replications in a slice; list has room for all of the study.
static void gather(const cp_study_data *data, const cp_replication_set *set, cp_slice slice,
                   cp_exceeded what, severities *list)
{
    list->count = 0;
    for (size_t k = 0; k < data->crash_count; k++) {
        size_t cluster = cp_replication_set_cluster(set, data->crash[k].replication);
        if (cluster == SIZE_MAX || !cp_slice_has_frontal_crash(data, slice, &data->crash[k]))
            continue;
        list->crash[list->count] = severity_of(data, slice, k, what);
        list->crash[list->count++].cluster = cluster;
    }
}

/* Which count of a crash is asked for. */
typedef enum counting { COUNT_ABOVE, COUNT_LEAST, COUNT_MOST } counting;

// Crashes above x of each replication; returns all of them.
static double count(const severities *list, double x, counting how, double *events, size_t clusters)
{
    double all = 0.0;
    for (size_t c = 0; c < clusters; c++)
        events[c] = 0.0;
    for (size_t k = 0; k < list->count; k++) {
        const crash_severity *s = &list->crash[k];
        bool counts = how == COUNT_ABOVE   ? s->largest > x
                      : how == COUNT_LEAST ? s->inside > x
                                           : s->inside > x || s->open;
        events[s->cluster] += counts;
        all += counts;
    }
    return all;
}

static void figure_interval(const cp_replication_set *set, const double *events, cp_exceedance *e)
{
    cp_exposure exposure = {set->count, events, set->vehicle_km};
    cp_widening widening;
    e->rate = cp_rate(&exposure) * CP_RATE_PER_KM;
    e->interval = cp_rate_widened(&exposure, set->stratum, 0.95, &widening);
    e->interval.low *= CP_RATE_PER_KM;
    e->interval.high *= CP_RATE_PER_KM;
}

static cp_exceedance exceedance_at(const severities *list, const cp_replication_set *set, double x,
                                   double *events)
{
    cp_exceedance e = {.x = x};
    e.least = (size_t)count(list, x, COUNT_LEAST, events, set->count);
    e.most = (size_t)count(list, x, COUNT_MOST, events, set->count);
    e.crashes = (size_t)count(list, x, COUNT_ABOVE, events, set->count);
    figure_interval(set, events, &e);
    return e;
}

cp_status cp_exceedance_figure(const cp_study_data *data, const cp_replication_set *set,
                               cp_slice slice, const cp_comparison_options *options,
                               cp_variant_figures *figures, cp_error *error)
{
    double *events = calloc(set->count + 1, sizeof *events);
    severities list = {0, calloc(data->crash_count + 1, sizeof *list.crash)};
    cp_status status = CP_OK;
    if (!events || !list.crash)
        status = cp_fail_memory(error, "crashes above a severity");
    for (int what = 0; what < CP_EXCEEDED_COUNT && status == CP_OK; what++) {
        gather(data, set, slice, what, &list);
        figures->above[what] = exceedance_at(&list, set, options->above[what], events);
        for (size_t k = 0; k < CP_EXCEEDANCE_POINTS; k++)
            figures->curve[what][k] = exceedance_at(&list, set, (double)k * STEP[what], events);
    }
    free(events);
    free(list.crash);
    return status;
}

void cp_exceedance_curve(const cp_sample *sample, const cp_replication_set *set, int what,
                         double *events, cp_exceedance curve[CP_EXCEEDANCE_POINTS])
{
    for (size_t k = 0; k < CP_EXCEEDANCE_POINTS; k++) {
        cp_exceedance *e = &curve[k];
        *e = (cp_exceedance){.x = (double)k * STEP[what]};
        for (size_t c = 0; c < set->count; c++)
            events[c] = 0.0;
        for (size_t j = 0; j < sample->count; j++)
            if (sample->value[j] > e->x) {
                events[sample->cluster[j]] += 1.0;
                e->crashes++;
            }
        e->least = e->most = e->crashes;
        figure_interval(set, events, e);
    }
}

/* The two arms of a contrast. */
typedef struct arms {
    const cp_replication_set *set;
    severities list[2];
    double *events[2];
    cp_exposure exposure[2];
} arms;

static double ratio_of(const arms *a)
{
    return cp_rate_ratio(&a->exposure[0], &a->exposure[1], a->set[0].stratum, a->set[1].stratum);
}

static void figure_ratio(const arms *a, const cp_resampling *resampling, cp_exceedance_ratio *r)
{
    cp_widening widening;
    // The ratio is least when the treatment has the fewest and the baseline the most.
    for (int end = 0; end < 2; end++) {
        double all[2];
        for (int g = 0; g < 2; g++)
            all[g] = count(&a->list[g], r->x, g == end ? COUNT_MOST : COUNT_LEAST, a->events[g],
                           a->set[g].count);
        r->bound[end] = all[0] > 0.0 ? ratio_of(a) : all[1] > 0.0 ? INFINITY : NAN;
        r->bound_interval[end] =
            cp_rate_ratio_widened(&a->exposure[0], &a->exposure[1], resampling, &widening);
    }
    for (int g = 0; g < 2; g++)
        r->crashes[g] =
            (size_t)count(&a->list[g], r->x, COUNT_ABOVE, a->events[g], a->set[g].count);
    r->ratio = ratio_of(a);
    r->interval = cp_rate_ratio_widened(&a->exposure[0], &a->exposure[1], resampling, &widening);
}

cp_status cp_exceedance_contrast(const cp_study_data *data, const cp_replication_set set[2],
                                 cp_slice slice, const cp_resampling *resampling,
                                 const cp_comparison_options *options, cp_contrast_figures *figures,
                                 cp_error *error)
{
    arms a = {.set = set};
    cp_status status = CP_OK;
    for (size_t g = 0; g < 2; g++) {
        a.events[g] = calloc(set[g].count + 1, sizeof *a.events[g]);
        a.list[g].crash = calloc(data->crash_count + 1, sizeof *a.list[g].crash);
        a.exposure[g] = (cp_exposure){set[g].count, a.events[g], set[g].vehicle_km};
        if (!a.events[g] || !a.list[g].crash)
            status = cp_fail_memory(error, "crashes above a severity");
    }
    for (int what = 0; what < CP_EXCEEDED_COUNT && status == CP_OK; what++) {
        for (size_t g = 0; g < 2; g++)
            gather(data, &set[g], slice, what, &a.list[g]);
        figures->above[what].x = options->above[what];
        figure_ratio(&a, resampling, &figures->above[what]);
    }
    for (size_t g = 0; g < 2; g++) {
        free(a.events[g]);
        free(a.list[g].crash);
    }
    return status;
}
