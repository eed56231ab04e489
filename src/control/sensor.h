/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_SENSOR_H
#define CONTROL_SENSOR_H

#include "core/geometry.h"

#include <stddef.h>

/* A forward sensor at the middle of the front: a sector of a circle, no measuring error; all it
 * tells is latency_s old. */
typedef struct cp_sensor {
    double range_m;
    double field_of_view_rad; /* whole opening angle, half to either side */
    double latency_s;
} cp_sensor;

/* Whether the sensor of the vehicle own has target in view: a corner, the middle of a side or the
 * centre of it inside the sector and not behind one of the screens (other vehicles; own and target
 * may be among them and hide nothing). */
bool cp_sensor_sees(const cp_sensor *sensor, const cp_rectangle *own, const cp_rectangle *target,
                    const cp_rectangle *const *screens, size_t screen_count);

#endif
