/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/crash_run.h"

#include "crash/validity.h"

#include <math.h>

cp_status cp_crash_run_simulate(const cp_crash_request *request, cp_crash_run *run,
                                cp_crash_film *film, cp_error *error)
{
    run->duration_s = request->duration_s;
    cp_status status = cp_crash_configuration_from_description(
        run->model[0], run->model[1], NULL, request->speed_m_s,
        run->model[1] ? request->opponent_speed_m_s : 0.0, request->offset_m, request->angle_rad,
        &run->configuration, error);
    run->missed = status == CP_BAD_INPUT;
    if (status != CP_OK)
        return status;
    cp_vec2 contact = cp_crash_contact_point(run->model[0], run->model[1], &run->configuration);
    run->description =
        cp_crash_describe(run->model[0], run->model[1], &run->configuration, contact);

    cp_crash_options options = cp_crash_options_default();
    options.duration_s = request->duration_s;
    options.longest_duration_s = fmax(options.longest_duration_s, options.duration_s);
    options.film = film;
    status = cp_crash_simulate(run->model[0], run->model[1], &run->configuration, &options,
                               &run->result, error);
    run->missed = status == CP_OK && !run->result.touched;
    if (run->missed)
        return cp_fail(error, CP_BAD_INPUT, CP_NO_CONTACT_TEXT);
    return status;
}
