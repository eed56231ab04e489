/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/target.h"

#include "calibrate/parallel.h"
#include "core/units.h"
#include "crash/crash_simulation.h"

#include <math.h>

const cp_target_kind CP_TARGET_KIND[CP_TARGET_QUANTITIES] = {
    [CP_TARGET_OLC] = {"olc_g", "g", 1.0, false},
    [CP_TARGET_PEAK] = {"peak_g", "g", 1.0, false},
    [CP_TARGET_CRUSH] = {"crush_mm", "mm", 1e-3, false},
    [CP_TARGET_T_V0] = {"t_v0_ms", "ms", 1e-3, false},
    [CP_TARGET_REBOUND] = {"rebound_m_s", "m/s", 1.0, false},
    [CP_TARGET_LOSS_X] = {"loss_x_m_s", "m/s", 1.0, true},
    [CP_TARGET_GAIN_AWAY] = {"gain_away_m_s", "m/s", 1.0, true},
    [CP_TARGET_YAW_RATE] = {"yaw_rate_deg_s", "deg/s", CP_PI / 180.0, true},
    [CP_TARGET_RESTITUTION] = {"restitution_1", "1", 1.0, false},
};

static double extreme(const cp_pulse *pulse, cp_pulse_channel channel, double sign)
{
    double largest = 0.0;
    for (size_t k = 0; k < pulse->sample_count; k++)
        largest = fmax(largest, sign * pulse->channel[channel][k]);
    return largest;
}

static double at_instant(const cp_pulse *pulse, cp_pulse_channel channel, double at_s)
{
    size_t k = (size_t)llround(at_s / pulse->sample_interval_s);
    return pulse->channel[channel][k < pulse->sample_count ? k : pulse->sample_count - 1];
}

// Speed at which whole cars part over the speed they met with, along a's x axis.
static double restitution(const cp_target *target, const cp_crash_result *result)
{
    double closing_m_s = result->vehicle_count * cp_m_s_from_km_h(target->speed_km_h);
    double lost_m_s = 0.0;
    for (int c = 0; c < result->vehicle_count; c++)
        lost_m_s -= result->whole[c].delta_v_m_s.x;
    return (lost_m_s - closing_m_s) / closing_m_s;
}

static double quantity_of(const cp_target *target, const cp_target_bounds *bounds,
                          const cp_crash_result *result)
{
    const cp_pulse *pulse = &result->pulse[0];
    double side = target->offset_mm >= 0.0 ? 1.0 : -1.0;
    switch (bounds->quantity) {
    case CP_TARGET_OLC:
        return result->severity[0].olc.status == CP_OLC_VALUE ? result->severity[0].olc.olc_g : 0.0;
    case CP_TARGET_PEAK:
        return result->severity[0].peak_g;
    case CP_TARGET_CRUSH:
        return extreme(pulse, CP_CHANNEL_X, 1.0);
    case CP_TARGET_T_V0:
        return result->severity[0].t_v0_s;
    case CP_TARGET_REBOUND:
        return extreme(pulse, CP_CHANNEL_VX, -1.0);
    case CP_TARGET_LOSS_X:
        return pulse->channel[CP_CHANNEL_VX][0] - at_instant(pulse, CP_CHANNEL_VX, bounds->at_s);
    case CP_TARGET_GAIN_AWAY:
        return side *
               (pulse->channel[CP_CHANNEL_VY][0] - at_instant(pulse, CP_CHANNEL_VY, bounds->at_s));
    case CP_TARGET_YAW_RATE:
        return side * at_instant(pulse, CP_CHANNEL_YAW_RATE, bounds->at_s);
    case CP_TARGET_RESTITUTION:
        return restitution(target, result);
    case CP_TARGET_QUANTITIES:
        break;
    }
    return NAN;
}

typedef struct target_work {
    const cp_target *targets;
    const cp_vehicle_model *model;
    double time_step_s;
    double *value;
} target_work;

static cp_status judge_target(void *context, size_t index)
{
    target_work *work = context;
    const cp_target *target = &work->targets[index];
    double *value = work->value + index * CP_TARGET_BOUNDS_MAX;
    for (size_t b = 0; b < target->bound_count; b++)
        value[b] = NAN;

    cp_error refused = {0};
    cp_crash_options options = cp_crash_options_default();
    options.time_step_s = work->time_step_s;
    const cp_vehicle_model *opponent = target->against_itself ? work->model : NULL;
    double speed_m_s = cp_m_s_from_km_h(target->speed_km_h);
    cp_crash_configuration configuration;
    cp_crash_result result;
    if (cp_crash_configuration_from_description(
            work->model, opponent, target->has_barrier ? &target->barrier : NULL, speed_m_s,
            speed_m_s, 1e-3 * target->offset_mm, cp_rad_from_deg(target->angle_deg), &configuration,
            &refused) != CP_OK)
        return CP_OK;
    cp_status status =
        cp_crash_simulate(work->model, opponent, &configuration, &options, &result, &refused);
    if (status != CP_OK)
        return status == CP_NO_MEMORY ? status : CP_OK;
    for (size_t b = 0; b < target->bound_count; b++)
        value[b] = quantity_of(target, &target->bound[b], &result);
    cp_crash_result_destroy(&result);
    return CP_OK;
}

cp_status cp_target_values(const cp_target *targets, size_t count, const cp_vehicle_model *model,
                           double time_step_s, int threads, double *value, cp_error *error)
{
    target_work work = {targets, model, time_step_s, value};
    return count == 0 ? CP_OK : cp_parallel_simulate(count, threads, judge_target, &work, error);
}

double cp_target_excess(const cp_target_bounds *bounds, double value)
{
    const double no_value_1 = 5.0;
    double width = bounds->max - bounds->min;
    if (isnan(value))
        return no_value_1;
    return value < bounds->min   ? (value - bounds->min) / width
           : value > bounds->max ? (value - bounds->max) / width
                                 : 0.0;
}

double cp_target_distance(const cp_target_bounds *bounds, double value)
{
    double width = bounds->max - bounds->min;
    if (isnan(value))
        return 1.0;
    return (fmin(bounds->max, fmax(bounds->min, value)) - bounds->aim) / width;
}
