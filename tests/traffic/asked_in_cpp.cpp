/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/sumo_bridge.h"

#include <libsumo/libsumo.h>

/* What test_sumo_bridge asks from the other language: the bridge's header in it, and SUMO itself.
 */

extern "C" const char *version_by_cpp(void);
extern "C" double sumo_angle_deg(const char *vehicle);
extern "C" double sumo_speed_m_s(const char *vehicle);

const char *version_by_cpp(void)
{
    return sumo_bridge_version();
}

double sumo_angle_deg(const char *vehicle)
{
    return libsumo::Vehicle::getAngle(vehicle);
}

double sumo_speed_m_s(const char *vehicle)
{
    return libsumo::Vehicle::getSpeed(vehicle);
}
