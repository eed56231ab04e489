/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/pulse_objective.h"

#include "calibrate/parallel.h"
#include "core/units.h"

#include <math.h>

// Weight of the velocities in the total error.
static const double VELOCITY_WEIGHT = 10.0;

// Simulated beyond the stretch compared, so that the filter's end lies outside of it.
static const double BEYOND_S = 0.01;
static const double LONGEST_RECORD_S = 0.25;

cp_status cp_reference_pulse_simulate(const cp_vehicle_model *model,
                                      const cp_reference_pulse *reference, double time_step_s,
                                      cp_crash_result *result, cp_error *error)
{
    *result = (cp_crash_result){0};
    cp_crash_options options = cp_crash_options_default();
    options.time_step_s = time_step_s;
    options.duration_s = reference->until_s + BEYOND_S;
    options.longest_duration_s = fmax(options.duration_s, LONGEST_RECORD_S);
    const cp_reference_case *condition = &reference->condition;
    cp_crash_configuration configuration;
    cp_status status = cp_crash_configuration_from_description(
        model, NULL, NULL, cp_m_s_from_km_h(condition->speed_km_h), 0.0,
        1e-3 * condition->offset_mm, cp_rad_from_deg(condition->angle_deg), &configuration, error);
    return status == CP_OK ? cp_crash_simulate(model, NULL, &configuration, &options, result, error)
                           : status;
}

// One channel of both, and where its misfits go.
typedef struct channel_look {
    cp_pulse_channel channel;
    double unit_si;       /* of the reference */
    const double *values; /* of the reference */
    double weight_1;
    double *misfit; /* CP_PULSE_STRETCHES, or NULL */
} channel_look;

// Mean absolute difference of a channel of the model to the reference's, in the latter's unit.
static double mean_error(const cp_pulse *pulse, const cp_reference_pulse *reference,
                         const channel_look *look)
{
    double sum = 0.0, part[CP_PULSE_STRETCHES] = {0.0};
    size_t samples[CP_PULSE_STRETCHES] = {0};
    for (size_t k = 0; k < reference->count; k++) {
        double own = cp_samples_at(pulse->channel[look->channel], pulse->sample_count,
                                   pulse->sample_interval_s, (double)k * reference->interval_s);
        double apart = own / look->unit_si - look->values[k];
        size_t stretch = k * CP_PULSE_STRETCHES / reference->count;
        sum += fabs(apart);
        part[stretch] += apart;
        samples[stretch]++;
    }
    for (size_t s = 0; look->misfit != NULL && s < CP_PULSE_STRETCHES; s++)
        look->misfit[s] = samples[s] > 0 ? look->weight_1 * part[s] / (double)samples[s] : 0.0;
    return sum / (double)reference->count;
}

static double largest_displacement_m(const cp_pulse *pulse)
{
    double way_m = 0.0, largest_m = 0.0;
    for (size_t k = 1; k < pulse->sample_count; k++) {
        const double *vx_m_s = pulse->channel[CP_CHANNEL_VX];
        way_m += 0.5 * (vx_m_s[k - 1] + vx_m_s[k]) * pulse->sample_interval_s;
        largest_m = fmax(largest_m, way_m);
    }
    return largest_m;
}

// Time of v_x = 0 within the stretch compared, or its end.
static double standstill_s(const cp_pulse_marks *marks, double until_s)
{
    return isnan(marks->t_v0_s) ? until_s : fmin(marks->t_v0_s, until_s);
}

// Mean errors of the channels the reference has, and their misfits.
static void compare_channels(const cp_reference_pulse *reference, const cp_pulse *filtered,
                             cp_pulse_error *found, double *misfit)
{
    const channel_look looks[4] = {
        {CP_CHANNEL_AX, CP_G0_M_S2, reference->ax_g, 1.0, NULL},
        {CP_CHANNEL_AY, CP_G0_M_S2, reference->ay_g, 1.0, NULL},
        {CP_CHANNEL_VX, 1.0, reference->vx_m_s, VELOCITY_WEIGHT, NULL},
        {CP_CHANNEL_VY, 1.0, reference->vy_m_s, VELOCITY_WEIGHT, NULL},
    };
    double *mean[4] = {&found->ax_g, &found->ay_g, &found->vx_m_s, &found->vy_m_s};
    for (size_t c = 0; misfit != NULL && c < CP_PULSE_MISFITS; c++)
        misfit[c] = 0.0;
    for (size_t c = 0; c < 4; c++) {
        bool longitudinal = c % 2 == 0;
        channel_look look = looks[c];
        look.misfit = misfit != NULL ? misfit + c * CP_PULSE_STRETCHES : NULL;
        if (longitudinal || reference->lateral)
            *mean[c] = mean_error(filtered, reference, &look);
    }
}

cp_status cp_pulse_compare(const cp_reference_pulse *reference, const cp_crash_result *result,
                           cp_pulse_error *found, double *misfit, cp_error *error)
{
    cp_pulse filtered = {0};
    cp_status status = cp_pulse_filtered(&result->pulse[0], 60.0, &filtered, error);
    if (status != CP_OK)
        return status;
    const cp_severity *severity = &result->severity[0];
    *found = (cp_pulse_error){.model = {.olc_g = severity->olc.olc_g,
                                        .t_v0_s = severity->t_v0_s,
                                        .peak_g = severity->peak_g,
                                        .crush_m = largest_displacement_m(&result->pulse[0])}};
    compare_channels(reference, &filtered, found, misfit);
    cp_pulse_destroy(&filtered);
    found->t_v0_s = fabs(standstill_s(&found->model, reference->until_s) -
                         standstill_s(&reference->marks, reference->until_s));
    found->total = found->ax_g + found->ay_g + VELOCITY_WEIGHT * (found->vx_m_s + found->vy_m_s) +
                   found->t_v0_s;
    return CP_OK;
}

// The work of one evaluation.
typedef struct evaluation {
    const cp_vehicle_model *model;
    const cp_reference_pulse *pulses;
    double time_step_s;
    cp_pulse_error *errors;
    double *misfits;
} evaluation;

static cp_status evaluate_pulse(void *context, size_t k)
{
    evaluation *work = context;
    double *misfit = work->misfits != NULL ? work->misfits + k * CP_PULSE_MISFITS : NULL;
    cp_crash_result result;
    cp_error error = {0};
    cp_status status = cp_reference_pulse_simulate(work->model, &work->pulses[k], work->time_step_s,
                                                   &result, &error);
    if (status == CP_OK)
        status = cp_pulse_compare(&work->pulses[k], &result, &work->errors[k], misfit, &error);
    for (size_t m = 0; status != CP_OK && misfit != NULL && m < CP_PULSE_MISFITS; m++)
        misfit[m] = NAN;
    if (status != CP_OK)
        work->errors[k] =
            (cp_pulse_error){NAN, NAN, NAN, NAN, NAN, NAN, .model = {NAN, NAN, NAN, NAN}};
    cp_crash_result_destroy(&result);
    return status == CP_NO_MEMORY ? status : CP_OK;
}

cp_status cp_objective_pulse(const cp_vehicle_model *model, const cp_reference_pulse *pulses,
                             size_t count, double time_step_s, int threads, cp_pulse_error *errors,
                             double *misfits, cp_error *error)
{
    evaluation work = {model, pulses, time_step_s, errors, misfits};
    return cp_parallel_simulate(count, threads, evaluate_pulse, &work, error);
}

double cp_objective_pulse_mean(const cp_reference_pulse *pulses, const cp_pulse_error *errors,
                               size_t count, const bool *use, double penalty)
{
    double sum = 0.0, weights_1 = 0.0;
    for (size_t k = 0; k < count; k++) {
        if (use != NULL && !use[k])
            continue;
        sum += pulses[k].weight_1 * (isnan(errors[k].total) ? penalty : errors[k].total);
        weights_1 += pulses[k].weight_1;
    }
    return weights_1 > 0.0 ? sum / weights_1 : 0.0;
}
