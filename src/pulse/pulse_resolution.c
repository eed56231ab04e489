/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pulse/pulse_resolution.h"

const double CP_PULSE_RESOLUTION[CP_CHANNEL_COUNT] = {
    [CP_CHANNEL_AX] = 0.1,     [CP_CHANNEL_AY] = 0.1,         [CP_CHANNEL_VX] = 0.001,
    [CP_CHANNEL_VY] = 0.001,   [CP_CHANNEL_X] = 0.0001,       [CP_CHANNEL_Y] = 0.0001,
    [CP_CHANNEL_YAW] = 0.0001, [CP_CHANNEL_YAW_RATE] = 0.001, [CP_CHANNEL_YAW_ACC] = 1.0};
