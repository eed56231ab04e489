/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/target.h"

#include "calibrate/parallel.h"
#include "core/units.h"
#include "crash/crash_simulation.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const cp_target_kind KIND[] = {
    {"olc_g", CP_SUITE_olc_g, 1.0},
    {"peak_g", CP_SUITE_peak_g, 1.0},
    {"crush_mm", CP_SUITE_crush_mm, 1e-3},
    {"t_v0_ms", CP_SUITE_t_v0_ms, 1e-3},
    {"rebound_m_s", CP_SUITE_rebound_m_s, 1.0},
    {"loss_x_m_s", CP_SUITE_dvx_m_s, 1.0},
    {"gain_away_m_s", CP_SUITE_dvy_away_m_s, 1.0},
    {"yaw_rate_deg_s", CP_SUITE_yaw_rate_at_deg_s, CP_PI / 180.0},
    {"restitution_1", CP_SUITE_restitution_1, 1.0},
};
enum { KINDS = sizeof KIND / sizeof *KIND };

const cp_target_kind *cp_target_kind_find(const char *key)
{
    for (size_t k = 0; k < KINDS; k++)
        if (strcmp(KIND[k].key, key) == 0)
            return &KIND[k];
    return NULL;
}

const cp_target_kind *cp_target_kind_of(cp_suite_quantity quantity)
{
    size_t k = 0;
    while (k + 1 < KINDS && KIND[k].quantity != quantity)
        k++;
    return &KIND[k];
}

const char *cp_target_keys(char text[CP_TARGET_KEYS_SIZE])
{
    size_t used = 0;
    for (size_t k = 0; k < KINDS && used < CP_TARGET_KEYS_SIZE; k++)
        used += (size_t)snprintf(text + used, CP_TARGET_KEYS_SIZE - used, "%s%s",
                                 k == 0           ? ""
                                 : k + 1 == KINDS ? " or "
                                                  : ", ",
                                 KIND[k].key);
    return text;
}

static double quantity_of(const cp_target *target, const cp_target_bounds *bounds,
                          const cp_crash_result *result)
{
    const cp_suite_look look = {.quantity = bounds->quantity,
                                .time_s = bounds->at_s,
                                .side_1 = target->offset_mm >= 0.0 ? 1.0 : -1.0};
    return cp_suite_quantity_of(&look, result) * cp_target_kind_of(bounds->quantity)->si_per_unit;
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
