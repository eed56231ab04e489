/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/calibration.h"

#include "core/units.h"

static bool wanted(const cp_fit *fit, cp_cross_kind kind)
{
    return kind == CP_CROSS_FOLDS        ? fit->folds > 1
           : kind == CP_CROSS_NEIGHBOURS ? fit->neighbour_folds > 1
                                         : fit->leave_out[kind];
}

// What the parts of the fitted vehicle absorb at a full-width wall.
static cp_status measure_energy(cp_calibration *calibration, double time_step_s, cp_error *error)
{
    static const double SPEED_KM_H[] = {25.0, 40.0, 56.0};
    cp_crash_options options = cp_crash_options_default();
    options.time_step_s = time_step_s;
    cp_barrier wall = cp_barrier_default();
    wall.width_m = calibration->model.width_m + 0.5;
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < sizeof SPEED_KM_H / sizeof *SPEED_KM_H; k++) {
        cp_crash_configuration configuration;
        cp_crash_result result;
        status = cp_crash_configuration_from_description(&calibration->model, NULL, &wall,
                                                         cp_m_s_from_km_h(SPEED_KM_H[k]), 0.0, 0.0,
                                                         0.0, &configuration, error);
        if (status == CP_OK)
            status = cp_crash_simulate(&calibration->model, NULL, &configuration, &options, &result,
                                       error);
        if (status != CP_OK)
            return status;
        calibration->energy_speed_km_h[k] = SPEED_KM_H[k];
        calibration->energy[k] = result.whole[0];
        calibration->energy_count++;
        cp_crash_result_destroy(&result);
    }
    return status;
}

cp_status cp_calibration_run(const cp_fit *fit, cp_calibration *calibration, cp_error *error)
{
    *calibration = (cp_calibration){0};
    cp_status status = cp_fit_work_create(fit, &calibration->work, error);
    if (status == CP_OK)
        status = cp_fit_search(fit, NULL, fit->output_path, fit->seed, &calibration->model,
                               &calibration->objective, &calibration->work, error);
    if (status == CP_OK)
        status = cp_validate_olc(fit->reference.cases, calibration->work.olc_g,
                                 fit->reference.count, &calibration->validation, error);
    if (status == CP_OK && fit->plausible.given)
        status = cp_plausibility_marks(&fit->plausible, &calibration->model, fit->local_time_step_s,
                                       calibration->mark, error);
    if (status == CP_OK)
        status = cp_target_values(fit->target, fit->target_count, &calibration->model,
                                  fit->local_time_step_s, fit->threads, calibration->target, error);
    if (status == CP_OK)
        status = measure_energy(calibration, fit->local_time_step_s, error);
    if (status == CP_OK)
        status = cp_ensemble_search(fit, &calibration->model, &calibration->ensemble, error);
    for (int kind = 0; status == CP_OK && kind < CP_CROSS_KINDS; kind++)
        if (wanted(fit, (cp_cross_kind)kind))
            status = cp_cross_validate(fit, (cp_cross_kind)kind,
                                       &calibration->cross[calibration->cross_count++], error);
    if (status != CP_OK)
        cp_calibration_destroy(calibration);
    return status;
}

void cp_calibration_destroy(cp_calibration *calibration)
{
    cp_fit_work_destroy(&calibration->work);
    for (size_t k = 0; k < calibration->cross_count; k++)
        cp_cross_validation_destroy(&calibration->cross[k]);
    *calibration = (cp_calibration){0};
}
