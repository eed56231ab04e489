/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pulse/severity.h"

#include "core/geometry.h"
#include "core/units.h"
#include "pulse/cfc_filter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define END_LIMIT_S 0.5
#define WINDOW_S 0.05
#define PEAK_CFC 60.0
#define ASI_LIMIT_X_G 12.0
#define ASI_LIMIT_Y_G 9.0
/* Differences below this are rounding, m/s. */
#define ROUNDING_M_S 1e-9

static double record_end_s(const cp_pulse *pulse)
{
    return (double)(pulse->sample_count - 1) * pulse->sample_interval_s;
}

// Value of a channel between its samples; before and after the record its first and last value.
static double channel_at(const cp_pulse *pulse, cp_pulse_channel channel, double time_s)
{
    const double *value = pulse->channel[channel];
    double place = time_s / pulse->sample_interval_s;
    if (place <= 0.0)
        return value[0];
    if (place >= (double)(pulse->sample_count - 1))
        return value[pulse->sample_count - 1];
    size_t k = (size_t)place;
    double share = place - (double)k;
    return value[k] + share * (value[k + 1] - value[k]);
}

// Change of the world velocity in one sample interval, in the axes of the initial pose: the
// accelerometer's increments turned by the heading half-way (v_x and v_y are integrals of
// accelerations in turning axes, so they are not themselves components of a velocity).
static cp_vec2 world_increment(const cp_pulse *pulse, size_t k)
{
    const double *vx_m_s = pulse->channel[CP_CHANNEL_VX], *vy_m_s = pulse->channel[CP_CHANNEL_VY];
    const double *yaw_rad = pulse->channel[CP_CHANNEL_YAW];
    cp_vec2 increment_m_s = {vx_m_s[k + 1] - vx_m_s[k], vy_m_s[k + 1] - vy_m_s[k]};
    return cp_vec2_rotate(increment_m_s, 0.5 * (yaw_rad[k] + yaw_rad[k + 1]));
}

// Time of the largest change of the world velocity, within the limit.
static double largest_change_s(const cp_pulse *pulse)
{
    cp_vec2 change_m_s = {0};
    double largest_m_s = 0.0, time_s = 0.0;
    for (size_t k = 0; k + 1 < pulse->sample_count; k++) {
        double sample_s = (double)(k + 1) * pulse->sample_interval_s;
        if (sample_s > END_LIMIT_S)
            break;
        change_m_s = cp_vec2_add(change_m_s, world_increment(pulse, k));
        if (cp_vec2_length(change_m_s) > largest_m_s + ROUNDING_M_S) {
            largest_m_s = cp_vec2_length(change_m_s);
            time_s = sample_s;
        }
    }
    return time_s;
}

// Change of the world velocity from the beginning to time_s, in the axes of the initial pose.
static cp_vec2 world_change(const cp_pulse *pulse, double time_s)
{
    cp_vec2 change_m_s = {0};
    double place = time_s / pulse->sample_interval_s;
    for (size_t k = 0; k + 1 < pulse->sample_count && (double)k < place; k++) {
        double share = fmin(1.0, place - (double)k);
        change_m_s = cp_vec2_add(change_m_s, cp_vec2_scale(world_increment(pulse, k), share));
    }
    return change_m_s;
}

// Mean deceleration up to the lowest v_x.
static double mean_deceleration_g(const cp_pulse *pulse)
{
    const double *vx_m_s = pulse->channel[CP_CHANNEL_VX];
    size_t lowest = 0;
    for (size_t k = 1; k < pulse->sample_count; k++)
        if (vx_m_s[k] < vx_m_s[lowest] - ROUNDING_M_S)
            lowest = k;
    if (lowest == 0)
        return NAN;
    double time_s = (double)lowest * pulse->sample_interval_s;
    return (vx_m_s[0] - vx_m_s[lowest]) / time_s / CP_G0_M_S2;
}

// First v_x <= 0, linear between samples.
static double standstill_s(const cp_pulse *pulse)
{
    const double *vx_m_s = pulse->channel[CP_CHANNEL_VX];
    if (vx_m_s[0] <= 0.0)
        return 0.0;
    for (size_t k = 1; k < pulse->sample_count; k++)
        if (vx_m_s[k] <= 0.0) {
            double share = vx_m_s[k - 1] / (vx_m_s[k - 1] - vx_m_s[k]);
            return ((double)(k - 1) + share) * pulse->sample_interval_s;
        }
    return NAN;
}

// Means over the window that begins at time_s, from the velocities: -a_x, and the ASI of it.
static void judge_window(const cp_pulse *pulse, double time_s, cp_severity *severity)
{
    double end_s = time_s + WINDOW_S;
    double loss_x_m_s =
        channel_at(pulse, CP_CHANNEL_VX, time_s) - channel_at(pulse, CP_CHANNEL_VX, end_s);
    double loss_y_m_s =
        channel_at(pulse, CP_CHANNEL_VY, time_s) - channel_at(pulse, CP_CHANNEL_VY, end_s);
    double mean_x_g = loss_x_m_s / WINDOW_S / CP_G0_M_S2;
    double mean_y_g = loss_y_m_s / WINDOW_S / CP_G0_M_S2;
    severity->max_50ms_g = fmax(severity->max_50ms_g, mean_x_g);
    severity->max_50ms_y_g = fmax(severity->max_50ms_y_g, fabs(mean_y_g));
    severity->asi_1 =
        fmax(severity->asi_1, hypot(mean_x_g / ASI_LIMIT_X_G, mean_y_g / ASI_LIMIT_Y_G));
}

// Largest means over all windows, those reaching beyond either end included (no acceleration
// there). The velocities are linear between samples, so the largest window begins or ends on one.
static void judge_windows(const cp_pulse *pulse, cp_severity *severity)
{
    severity->max_50ms_g = -INFINITY;
    severity->asi_1 = -INFINITY;
    for (size_t k = 0; k < pulse->sample_count; k++) {
        double sample_s = (double)k * pulse->sample_interval_s;
        judge_window(pulse, sample_s, severity);
        judge_window(pulse, sample_s - WINDOW_S, severity);
    }
}

// Largest -a_x after the CFC60 filter.
static cp_status peak_deceleration(const cp_pulse *pulse, double *peak_g, cp_error *error)
{
    size_t size = pulse->sample_count * sizeof(double);
    double *ax_m_s2 = malloc(size);
    if (ax_m_s2 == NULL)
        return cp_fail_memory(error, "severity of a pulse");
    memcpy(ax_m_s2, pulse->channel[CP_CHANNEL_AX], size);
    cp_status status =
        cp_cfc_filter(ax_m_s2, pulse->sample_count, pulse->sample_interval_s, PEAK_CFC, error);
    double lowest_m_s2 = INFINITY;
    for (size_t k = 0; status == CP_OK && k < pulse->sample_count; k++)
        lowest_m_s2 = fmin(lowest_m_s2, ax_m_s2[k]);
    *peak_g = (0.0 - lowest_m_s2) / CP_G0_M_S2;
    free(ax_m_s2);
    return status;
}

cp_status cp_severity_of_pulse(const cp_pulse *raw, double separation_s, int against_barrier,
                               cp_severity *severity, cp_error *error)
{
    if (raw->sample_count < 2)
        return cp_fail(error, CP_BAD_INPUT, "a pulse of %zu samples has no severity: needs 2",
                       raw->sample_count);
    *severity = (cp_severity){0};
    severity->olc = cp_olc_from_velocity(raw->channel[CP_CHANNEL_VX], raw->sample_count,
                                         raw->sample_interval_s);

    // What is taken at the end of the crash.
    double end_s = fmin(fmax(separation_s, largest_change_s(raw)), END_LIMIT_S);
    end_s = fmin(end_s, record_end_s(raw));
    cp_vec2 change_m_s = world_change(raw, end_s);
    severity->end_s = end_s;
    severity->delta_v_m_s = cp_vec2_length(change_m_s);
    severity->delta_v_x_m_s =
        raw->channel[CP_CHANNEL_VX][0] - channel_at(raw, CP_CHANNEL_VX, end_s);
    severity->delta_v_y_m_s =
        raw->channel[CP_CHANNEL_VY][0] - channel_at(raw, CP_CHANNEL_VY, end_s);
    severity->yaw_change_rad_s =
        channel_at(raw, CP_CHANNEL_YAW_RATE, end_s) - raw->channel[CP_CHANNEL_YAW_RATE][0];
    severity->pdof_rad = severity->delta_v_m_s > ROUNDING_M_S
                             ? cp_wrap_angle(atan2(change_m_s.y, change_m_s.x) + CP_PI)
                             : NAN;

    // What is taken over the whole record.
    severity->mean_g = mean_deceleration_g(raw);
    severity->t_v0_s = against_barrier ? standstill_s(raw) : NAN;
    judge_windows(raw, severity);
    return peak_deceleration(raw, &severity->peak_g, error);
}
