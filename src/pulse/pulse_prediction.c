/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pulse/pulse_prediction.h"

#include "pulse/pulse_resolution.h"

#include <math.h>
#include <stdbool.h>

#define LARGEST ((double)INT32_MAX)

// A channel comes after those that predict it.
static const cp_pulse_channel ORDER_1[CP_CHANNEL_COUNT] = {
    CP_CHANNEL_AX, CP_CHANNEL_VX,      CP_CHANNEL_X,        CP_CHANNEL_AY, CP_CHANNEL_VY,
    CP_CHANNEL_Y,  CP_CHANNEL_YAW_ACC, CP_CHANNEL_YAW_RATE, CP_CHANNEL_YAW};
static const cp_pulse_channel ORDER_2[CP_CHANNEL_COUNT] = {
    CP_CHANNEL_YAW_ACC, CP_CHANNEL_AX,  CP_CHANNEL_AY, CP_CHANNEL_YAW_RATE, CP_CHANNEL_VX,
    CP_CHANNEL_VY,      CP_CHANNEL_YAW, CP_CHANNEL_X,  CP_CHANNEL_Y};

cp_pulse_channel cp_prediction_channel(int codec, size_t place)
{
    return codec == 1 ? ORDER_1[place] : ORDER_2[place];
}

// The channel that one is the integral of; itself: none. Displacements are none of a single one.
static cp_pulse_channel rate_of(cp_pulse_channel channel)
{
    switch (channel) {
    case CP_CHANNEL_VX:
        return CP_CHANNEL_AX;
    case CP_CHANNEL_VY:
        return CP_CHANNEL_AY;
    case CP_CHANNEL_YAW_RATE:
        return CP_CHANNEL_YAW_ACC;
    case CP_CHANNEL_YAW:
        return CP_CHANNEL_YAW_RATE;
    default:
        return channel;
    }
}

static double value(const cp_prediction *p, cp_pulse_channel channel, size_t k)
{
    return (double)p->steps[channel][k] * CP_PULSE_RESOLUTION[channel];
}

// Trapezoid of the rate over the interval that ends at sample k, in steps of the channel.
static double trapezoid(const cp_prediction *p, cp_pulse_channel rate, size_t k)
{
    double mean = 0.5 * ((double)p->steps[rate][k - 1] + (double)p->steps[rate][k]);
    return mean * CP_PULSE_RESOLUTION[rate] * p->interval_s / CP_PULSE_RESOLUTION[p->channel];
}

// ---- codec 1: from the last samples only ----------------------------------------------------

static int64_t next_1(const cp_prediction *p, size_t k)
{
    const int64_t *own = p->steps[p->channel];
    cp_pulse_channel rate = rate_of(p->channel);
    if (k == 0)
        return 0;
    if (rate != p->channel) {
        // Bounded: a hostile blob may hold anything.
        double gain = trapezoid(p, rate, k);
        return fabs(gain) < LARGEST ? own[k - 1] + llround(gain) : own[k - 1];
    }
    bool straight = p->channel == CP_CHANNEL_X || p->channel == CP_CHANNEL_Y;
    return straight && k > 1 ? 2 * own[k - 1] - own[k - 2] : own[k - 1];
}

// ---- codec 2: integrals are followed unrounded -----------------------------------------------

// Turn the direction by a small angle: the rational rotation of tan(angle / 2), which keeps its
// length, with two terms of the tangent.
static void turn(double direction[2], double angle_rad)
{
    double half = 0.5 * angle_rad;
    double q = half + half * half * half / 3.0;
    double scale = 1.0 / (1.0 + q * q);
    double cosine = (1.0 - q * q) * scale, sine = 2.0 * q * scale;
    double x = cosine * direction[0] - sine * direction[1];
    direction[1] = sine * direction[0] + cosine * direction[1];
    direction[0] = x;
}

// Way of the centre of gravity along the channel's axis over the interval that ends at sample k, in
// steps: velocity changes are known in the turning axes, displacements are in those at the start.
static double displacement(cp_prediction *p, size_t k)
{
    int axis = p->channel == CP_CHANNEL_Y;
    double before = p->velocity[axis];
    double change[2] = {value(p, CP_CHANNEL_VX, k) - value(p, CP_CHANNEL_VX, k - 1),
                        value(p, CP_CHANNEL_VY, k) - value(p, CP_CHANNEL_VY, k - 1)};
    double angle = value(p, CP_CHANNEL_YAW, k) - value(p, CP_CHANNEL_YAW, k - 1);
    turn(p->direction, 0.5 * angle);
    p->velocity[0] += p->direction[0] * change[0] - p->direction[1] * change[1];
    p->velocity[1] += p->direction[1] * change[0] + p->direction[0] * change[1];
    turn(p->direction, 0.5 * angle);
    double way_m = 0.5 * (before + p->velocity[axis]) * p->interval_s;
    return way_m / CP_PULSE_RESOLUTION[p->channel];
}

// The last sample was rounded: the unrounded value lies within half a step of it.
static void correct(cp_prediction *p, int64_t last)
{
    double lowest = (double)last - 0.5, highest = (double)last + 0.5;
    if (!(p->estimate >= lowest))
        p->estimate = lowest;
    if (p->estimate > highest)
        p->estimate = highest;
}

static int64_t next_2(cp_prediction *p, size_t k)
{
    const int64_t *own = p->steps[p->channel];
    cp_pulse_channel rate = rate_of(p->channel);
    bool straight = p->channel == CP_CHANNEL_X || p->channel == CP_CHANNEL_Y;
    if (k == 0) {
        p->estimate = 0.0;
        p->velocity[0] = value(p, CP_CHANNEL_VX, 0);
        p->velocity[1] = value(p, CP_CHANNEL_VY, 0);
        p->direction[0] = 1.0;
        p->direction[1] = 0.0;
        return 0;
    }
    // Accelerations: half way between staying and going on straight packs smallest.
    if (rate == p->channel && !straight)
        return k > 1 ? own[k - 1] + (own[k - 1] - own[k - 2]) / 2 : own[k - 1];

    // Bounded: a hostile blob may hold anything.
    correct(p, own[k - 1]);
    double gain = straight ? displacement(p, k) : trapezoid(p, rate, k);
    if (!(fabs(gain) < LARGEST))
        return own[k - 1];
    p->estimate += gain;
    return llround(p->estimate);
}

// ---- public ----------------------------------------------------------------------------------

cp_prediction cp_prediction_begin(int codec, size_t place, int64_t *const *steps, double interval_s)
{
    return (cp_prediction){.codec = codec,
                           .channel = cp_prediction_channel(codec, place),
                           .steps = steps,
                           .interval_s = interval_s};
}

int64_t cp_prediction_next(cp_prediction *prediction, size_t k)
{
    return prediction->codec == 1 ? next_1(prediction, k) : next_2(prediction, k);
}
