/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/objective.h"

#include "calibrate/parallel.h"
#include "core/units.h"

// OLC is decided by then in every reference configuration; the record ends when it is.
static const double SHORTEST_RECORD_S = 0.08;
static const double LONGEST_RECORD_S = 0.25;

// The work of one evaluation.
typedef struct evaluation {
    const cp_vehicle_model *model;
    const cp_reference_case *cases;
    const bool *use;
    double time_step_s;
    double *olc_g;
} evaluation;

// NAN where it cannot be simulated.
static cp_status olc_of_case(const evaluation *work, const cp_reference_case *row, double *olc_g)
{
    *olc_g = NAN;
    cp_crash_options options = cp_crash_options_default();
    options.time_step_s = work->time_step_s;
    options.duration_s = SHORTEST_RECORD_S;
    options.longest_duration_s = LONGEST_RECORD_S;
    options.until_olc = true;
    cp_error error = {0};
    cp_crash_configuration configuration;
    if (cp_crash_configuration_from_description(
            work->model, NULL, NULL, cp_m_s_from_km_h(row->speed_km_h), 0.0, 1e-3 * row->offset_mm,
            cp_rad_from_deg(row->angle_deg), &configuration, &error) != CP_OK)
        return CP_OK;
    cp_crash_result result;
    cp_status status =
        cp_crash_simulate(work->model, NULL, &configuration, &options, &result, &error);
    if (status != CP_OK)
        return status == CP_NO_MEMORY ? status : CP_OK;
    const cp_olc *olc = &result.severity[0].olc;
    *olc_g = olc->status == CP_OLC_VALUE ? olc->olc_g : 0.0;
    cp_crash_result_destroy(&result);
    return CP_OK;
}

static cp_status evaluate_case(void *context, size_t k)
{
    const evaluation *work = context;
    bool wanted = work->use == NULL || work->use[k];
    return wanted ? olc_of_case(work, &work->cases[k], &work->olc_g[k]) : CP_OK;
}

cp_status cp_objective_olc(const cp_vehicle_model *model, const cp_reference_case *cases,
                           size_t count, const bool *use, double time_step_s, int threads,
                           double *olc_g, cp_error *error)
{
    evaluation work = {model, cases, use, time_step_s, olc_g};
    return cp_parallel_simulate(count, threads, evaluate_case, &work, error);
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
