/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/objective.h"

#include "core/units.h"

#include <pthread.h>

// OLC is decided by then in every reference configuration; the record ends when it is.
static const double SHORTEST_RECORD_S = 0.08;
static const double LONGEST_RECORD_S = 0.25;

// One thread's share: every stride-th case from first on.
typedef struct share {
    const cp_vehicle_model *model;
    const cp_reference_case *cases;
    size_t count;
    size_t first;
    size_t stride;
    double time_step_s;
    double *olc_g;
} share;

static double olc_of_case(const share *work, const cp_reference_case *row)
{
    cp_crash_options options = cp_crash_options_default();
    options.time_step_s = work->time_step_s;
    options.duration_s = SHORTEST_RECORD_S;
    options.longest_duration_s = LONGEST_RECORD_S;
    cp_error error = {0};
    cp_crash_configuration configuration;
    if (cp_crash_configuration_from_description(
            work->model, NULL, NULL, cp_m_s_from_km_h(row->speed_km_h), 0.0, 1e-3 * row->offset_mm,
            cp_rad_from_deg(row->angle_deg), &configuration, &error) != CP_OK)
        return NAN;
    cp_crash_result result;
    if (cp_crash_simulate(work->model, NULL, &configuration, &options, &result, &error) != CP_OK)
        return NAN;
    const cp_olc *olc = &result.severity[0].olc;
    double olc_g = olc->status == CP_OLC_VALUE ? olc->olc_g : 0.0;
    cp_crash_result_destroy(&result);
    return olc_g;
}

static void *run_share(void *context)
{
    share *work = context;
    for (size_t k = work->first; k < work->count; k += work->stride)
        work->olc_g[k] = olc_of_case(work, &work->cases[k]);
    return NULL;
}

static void *run_share_in_thread(void *context)
{
    cp_error error = {0};
    if (cp_crash_thread_begin(&error) != CP_OK)
        return context;
    run_share(context);
    cp_crash_thread_end();
    return NULL;
}

cp_status cp_objective_olc(const cp_vehicle_model *model, const cp_reference_case *cases,
                           size_t count, double time_step_s, int threads, double *olc_g,
                           cp_error *error)
{
    enum { THREADS_MAX = 64 };
    if (threads < 1 || threads > THREADS_MAX)
        return cp_fail(error, CP_BAD_INPUT, "threads must be between 1 and %d, found %d",
                       THREADS_MAX, threads);
    share shares[THREADS_MAX];
    pthread_t handles[THREADS_MAX];
    for (int t = 0; t < threads; t++)
        shares[t] = (share){model, cases, count, (size_t)t, (size_t)threads, time_step_s, olc_g};

    // This thread takes the first share itself.
    int started = 1, failed = 0;
    while (started < threads && !failed) {
        failed = pthread_create(&handles[started], NULL, run_share_in_thread, &shares[started]);
        started += !failed;
    }
    if (!failed)
        run_share(&shares[0]);
    for (int t = 1; t < started; t++) {
        void *trouble = NULL;
        pthread_join(handles[t], &trouble);
        failed |= trouble != NULL;
    }
    if (failed)
        return cp_fail(error, CP_RUN_FAILED, "could not run %d simulation threads", threads);
    return CP_OK;
}

double cp_objective_mean_error(const cp_reference_case *cases, const double *olc_g, size_t count,
                               const bool *use, double penalty_g)
{
    double sum_g = 0.0;
    size_t used = 0;
    for (size_t k = 0; k < count; k++) {
        if (use != NULL && !use[k])
            continue;
        sum_g += isnan(olc_g[k]) ? penalty_g : fabs(olc_g[k] - cases[k].olc_g);
        used++;
    }
    return used > 0 ? sum_g / (double)used : 0.0;
}
