/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/plausibility.h"

#include "core/units.h"
#include "crash/crash_simulation.h"

#include <math.h>

const cp_mark_kind CP_MARK_KIND[CP_MARK_COUNT] = {
    [CP_MARK_T_V0] = {"t_v0_ms", "ms", 1e-3},
    [CP_MARK_CRUSH] = {"crush_mm", "mm", 1e-3},
    [CP_MARK_PEAK] = {"peak_g", "g", 1.0},
    [CP_MARK_REBOUND] = {"rebound_m_s", "m/s", 1.0},
};

cp_status cp_plausibility_marks(const cp_plausibility *guard, const cp_vehicle_model *model,
                                double time_step_s, double mark[CP_MARK_COUNT], cp_error *error)
{
    cp_crash_options options = cp_crash_options_default();
    options.time_step_s = time_step_s;
    cp_crash_configuration configuration;
    cp_crash_result result;
    cp_status status = cp_crash_configuration_from_description(
        model, NULL, NULL, cp_m_s_from_km_h(guard->speed_km_h), 0.0, 1e-3 * guard->offset_mm,
        cp_rad_from_deg(guard->angle_deg), &configuration, error);
    if (status == CP_OK)
        status = cp_crash_simulate(model, NULL, &configuration, &options, &result, error);
    if (status != CP_OK)
        return status;
    mark[CP_MARK_T_V0] = result.severity[0].t_v0_s;
    mark[CP_MARK_PEAK] = result.severity[0].peak_g;
    mark[CP_MARK_CRUSH] = 0.0;
    mark[CP_MARK_REBOUND] = 0.0;
    const cp_pulse *pulse = &result.pulse[0];
    for (size_t k = 0; k < pulse->sample_count; k++) {
        mark[CP_MARK_CRUSH] = fmax(mark[CP_MARK_CRUSH], pulse->channel[CP_CHANNEL_X][k]);
        mark[CP_MARK_REBOUND] = fmax(mark[CP_MARK_REBOUND], -pulse->channel[CP_CHANNEL_VX][k]);
    }
    cp_crash_result_destroy(&result);
    return CP_OK;
}

void cp_plausibility_excess(const cp_plausibility *guard, const double mark[CP_MARK_COUNT],
                            double excess_1[CP_MARK_COUNT])
{
    const double no_mark_1 = 5.0;
    for (int k = 0; k < CP_MARK_COUNT; k++) {
        double width = guard->max[k] - guard->min[k];
        excess_1[k] = 0.0;
        if (!guard->bounded[k])
            continue;
        if (isnan(mark[k]))
            excess_1[k] = no_mark_1;
        else if (mark[k] < guard->min[k])
            excess_1[k] = (mark[k] - guard->min[k]) / width;
        else if (mark[k] > guard->max[k])
            excess_1[k] = (mark[k] - guard->max[k]) / width;
    }
}
