/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PULSE_PULSE_RESOLUTION_H
#define PULSE_PULSE_RESOLUTION_H

#include "pulse/pulse.h"

/* Steps of the channels of a packed pulse (pulse_codec.h), in the units of CP_PULSE_COLUMN. */
extern const double CP_PULSE_RESOLUTION[CP_CHANNEL_COUNT];

#endif
