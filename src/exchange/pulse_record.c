/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/pulse_record.h"

#include "core/units.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// How far the integral of an acceleration and a velocity may lie apart: filters and rounding.
static const double APART_1 = 0.1, APART_M_S = 1.0;
static const double SPEED_MAX_M_S = 150.0;
// A car that an accelerometer alone makes faster by more than this was struck from behind, or the
// accelerometer sits the other way round.
static const double GAIN_M_S = 1.0;

cp_pulse_request cp_pulse_request_default(const char *path)
{
    return (cp_pulse_request){.path = path, .speed_m_s = NAN};
}

bool cp_pulse_record_take_side(cp_pulse_record *record, const char *side)
{
    static const char *const SIDE[] = {"front", "left", "right", "rear"};
    for (size_t k = 0; k < sizeof SIDE / sizeof *SIDE; k++)
        if (strcmp(side, SIDE[k]) == 0) {
            snprintf(record->side, sizeof record->side, "%s", side);
            return true;
        }
    return false;
}

void cp_pulse_record_destroy(cp_pulse_record *record)
{
    cp_pulse_destroy(&record->pulse);
    *record = (cp_pulse_record){0};
}

// Velocity from its first value and the trapezoids under the acceleration.
static void integrate(const double *a_m_s2, double *v_m_s, const cp_pulse *pulse, double first_m_s)
{
    v_m_s[0] = first_m_s;
    for (size_t k = 1; k < pulse->sample_count; k++)
        v_m_s[k] = v_m_s[k - 1] + 0.5 * (a_m_s2[k - 1] + a_m_s2[k]) * pulse->sample_interval_s;
}

// Central differences; at the ends to the one neighbour there is.
static void differentiate(const double *v_m_s, double *a_m_s2, const cp_pulse *pulse)
{
    size_t last = pulse->sample_count - 1;
    for (size_t k = 0; k <= last; k++) {
        size_t from = k > 0 ? k - 1 : 0, to = k < last ? k + 1 : last;
        a_m_s2[k] = (v_m_s[to] - v_m_s[from]) / ((double)(to - from) * pulse->sample_interval_s);
    }
}

// Both are told: of the same motion?
static cp_status check_together(const cp_pulse_record *record, cp_pulse_channel a,
                                cp_pulse_channel v, cp_error *error)
{
    const cp_pulse *pulse = &record->pulse;
    const double *a_m_s2 = pulse->channel[a], *v_m_s = pulse->channel[v];
    double sum_m_s = 0.0, apart_m_s = 0.0, change_m_s = 0.0, at_s = 0.0, told_m_s = 0.0,
           found_m_s = 0.0;
    for (size_t k = 1; k < pulse->sample_count; k++) {
        sum_m_s += 0.5 * (a_m_s2[k - 1] + a_m_s2[k]) * pulse->sample_interval_s;
        double own_m_s = v_m_s[k] - v_m_s[0];
        change_m_s = fmax(change_m_s, fabs(own_m_s));
        if (fabs(own_m_s - sum_m_s) > apart_m_s) {
            apart_m_s = fabs(own_m_s - sum_m_s);
            at_s = (double)k * pulse->sample_interval_s;
            told_m_s = own_m_s;
            found_m_s = sum_m_s;
        }
    }
    if (apart_m_s <= APART_1 * change_m_s + APART_M_S)
        return CP_OK;
    return cp_fail(error, CP_BAD_INPUT,
                   "%s: %s and %s do not go together (unit, polarity, offset?): up to %.4g s the "
                   "velocity changes by %.3g m/s, the integral of the acceleration by %.3g m/s",
                   record->source, CP_PULSE_COLUMN[a], CP_PULSE_COLUMN[v], at_s, told_m_s,
                   found_m_s);
}

static cp_status check_speed(const cp_pulse_record *record, cp_error *error)
{
    const cp_pulse *pulse = &record->pulse;
    for (size_t k = 0; k < pulse->sample_count; k++) {
        double v_m_s = pulse->channel[CP_CHANNEL_VX][k];
        if (!(fabs(v_m_s) <= SPEED_MAX_M_S))
            return cp_fail(
                error, CP_BAD_INPUT, "%s: the velocity at %.4g s must be within %g m/s, found %g",
                record->source, (double)k * pulse->sample_interval_s, SPEED_MAX_M_S, v_m_s);
    }
    return CP_OK;
}

// What an accelerometer alone says of a car that is struck on its front: it gets slower.
static cp_status check_polarity(const cp_pulse_record *record, cp_error *error)
{
    const double *vx_m_s = record->pulse.channel[CP_CHANNEL_VX];
    double lowest = vx_m_s[0], highest = vx_m_s[0];
    for (size_t k = 0; k < record->pulse.sample_count; k++) {
        lowest = fmin(lowest, vx_m_s[k]);
        highest = fmax(highest, vx_m_s[k]);
    }
    double gain_m_s = highest - vx_m_s[0], loss_m_s = vx_m_s[0] - lowest;
    if (gain_m_s <= GAIN_M_S || gain_m_s <= loss_m_s)
        return CP_OK;
    return cp_fail(
        error, CP_BAD_INPUT,
        "%s: the acceleration makes the car faster, by %.3g m/s, and slower by %.3g m/s: "
        "reversed polarity?",
        record->source, gain_m_s, loss_m_s);
}

static cp_status complete_forward(cp_pulse_record *record, const cp_pulse_request *request,
                                  cp_error *error)
{
    cp_pulse *pulse = &record->pulse;
    double *ax_m_s2 = pulse->channel[CP_CHANNEL_AX], *vx_m_s = pulse->channel[CP_CHANNEL_VX];
    bool has_ax = record->known[CP_CHANNEL_AX], has_vx = record->known[CP_CHANNEL_VX];
    if (!has_ax && !has_vx)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: tells neither a longitudinal acceleration nor a velocity",
                       record->source);
    if (has_ax && has_vx)
        return check_together(record, CP_CHANNEL_AX, CP_CHANNEL_VX, error);
    if (has_vx) {
        differentiate(vx_m_s, ax_m_s2, pulse);
        return CP_OK;
    }
    if (isnan(request->speed_m_s))
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: tells no speed at first contact, which the velocity begins with",
                       record->source);
    integrate(ax_m_s2, vx_m_s, pulse, request->speed_m_s);
    return request->may_gain ? CP_OK : check_polarity(record, error);
}

cp_status cp_pulse_record_complete(cp_pulse_record *record, const cp_pulse_request *request,
                                   cp_error *error)
{
    cp_pulse *pulse = &record->pulse;
    if (pulse->sample_count < 2)
        return cp_fail(error, CP_BAD_INPUT, "%s: fewer than two samples", record->source);
    cp_status status = complete_forward(record, request, error);
    if (status == CP_OK)
        status = check_speed(record, error);
    if (status != CP_OK)
        return status;

    bool has_ay = record->known[CP_CHANNEL_AY], has_vy = record->known[CP_CHANNEL_VY];
    if (request->needs_both)
        has_ay = has_vy = has_ay && has_vy;
    if (has_ay && has_vy)
        status = check_together(record, CP_CHANNEL_AY, CP_CHANNEL_VY, error);
    else if (has_ay)
        integrate(pulse->channel[CP_CHANNEL_AY], pulse->channel[CP_CHANNEL_VY], pulse, 0.0);
    else if (has_vy)
        differentiate(pulse->channel[CP_CHANNEL_VY], pulse->channel[CP_CHANNEL_AY], pulse);
    // A heading from its rate, which turns the change of velocity.
    if (!record->known[CP_CHANNEL_YAW] && record->known[CP_CHANNEL_YAW_RATE])
        integrate(pulse->channel[CP_CHANNEL_YAW_RATE], pulse->channel[CP_CHANNEL_YAW], pulse, 0.0);
    record->known[CP_CHANNEL_AX] = record->known[CP_CHANNEL_VX] = true;
    record->known[CP_CHANNEL_AY] = record->known[CP_CHANNEL_VY] = has_ay || has_vy;
    record->known[CP_CHANNEL_YAW] |= record->known[CP_CHANNEL_YAW_RATE];
    return status;
}
