/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/calibration.h"

static bool wanted(const cp_fit *fit, cp_cross_kind kind)
{
    return kind == CP_CROSS_FOLDS        ? fit->folds > 1
           : kind == CP_CROSS_NEIGHBOURS ? fit->neighbour_folds > 1
                                         : fit->leave_out[kind];
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
