/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PULSE_PULSE_H
#define PULSE_PULSE_H

#include "core/error.h"

#include <stddef.h>
#include <stdio.h>

/* The crash pulse of one vehicle: motion of the root's material point at the undeformed car's
 * centre of gravity, ISO 8855 vehicle axes (x forward, y left, yaw counter-clockwise).
 *
 * Accelerations are in the turning vehicle axes; velocities follow the accelerometer convention
 * of test labs, v_x(t) = v_x(0) + integral of a_x (likewise y); displacements x, y are of the
 * centre of gravity in the axes of the initial pose; yaw from the initial heading. Sample k is at
 * k * sample_interval_s, sample 0 at first contact. */
#define CP_PULSE_CHANNELS(X)                                                                       \
    X(CP_CHANNEL_AX, "ax_m_s2")                                                                    \
    X(CP_CHANNEL_AY, "ay_m_s2")                                                                    \
    X(CP_CHANNEL_VX, "vx_m_s")                                                                     \
    X(CP_CHANNEL_VY, "vy_m_s")                                                                     \
    X(CP_CHANNEL_X, "x_m")                                                                         \
    X(CP_CHANNEL_Y, "y_m")                                                                         \
    X(CP_CHANNEL_YAW, "yaw_rad")                                                                   \
    X(CP_CHANNEL_YAW_RATE, "yaw_rate_rad_s")                                                       \
    X(CP_CHANNEL_YAW_ACC, "yaw_acc_rad_s2")

typedef enum cp_pulse_channel {
#define CP_PULSE_CHANNEL_NAME(name, column) name,
    CP_PULSE_CHANNELS(CP_PULSE_CHANNEL_NAME)
#undef CP_PULSE_CHANNEL_NAME
        CP_CHANNEL_COUNT
} cp_pulse_channel;

/* Column names of the channels, in the order of the enum. */
extern const char *const CP_PULSE_COLUMN[CP_CHANNEL_COUNT];

typedef struct cp_pulse {
    size_t sample_count;
    double sample_interval_s;          /* > 0 */
    double *channel[CP_CHANNEL_COUNT]; /* sample_count values each; owned by the pulse */
} cp_pulse;

/* All samples zero. The caller destroys. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_pulse_create(cp_pulse *pulse, size_t sample_count,
                                        double sample_interval_s, cp_error *error);
/* A zero-initialised or destroyed pulse is fine too. */
void cp_pulse_destroy(cp_pulse *pulse);

/* A copy whose three acceleration channels went through the CFC filter of class cfc (60, 180,
 * 600, 1000; SAE J211-1); the rest as it is. The caller destroys it. */
CP_MUST_CHECK cp_status cp_pulse_filtered(const cp_pulse *pulse, double cfc, cp_pulse *filtered,
                                          cp_error *error);

/* Append the samples as CSV rows "vehicle,time_s,<channels>" with 10 significant digits; no
 * header. role is the first field ("a", "b"). */
CP_MUST_CHECK cp_status cp_pulse_write_csv(const cp_pulse *pulse, const char *role, FILE *file,
                                           cp_error *error);

#endif
