/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_FUNCTION_ROAD_H
#define CONTROL_FUNCTION_ROAD_H

#include "api/crashpulse/function.h"
#include "control/road_view.h"

/* The road ahead of a car as a function is told it: centre lines of its lane and of those that
 * follow on its route, in the car's frame. *is_known is false where no lane is. Errors:
 * CP_NO_MEMORY, those of the traffic. */
CP_MUST_CHECK cp_status cp_function_road(const cp_traffic *traffic, cp_road_view *view,
                                         const cp_vehicle_motion *own, crashpulse_road *road,
                                         bool *is_known, cp_error *error);

#endif
