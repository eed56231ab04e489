/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_UNITS_H
#define CORE_UNITS_H

/* SI inside; these convert at the edges (command line, YAML, reports). */

#define CP_PI 3.14159265358979323846
#define CP_G0_M_S2 9.80665 /* standard acceleration of gravity, m/s^2 per g */

static inline double cp_m_s_from_km_h(double speed_km_h)
{
    return speed_km_h / 3.6;
}

static inline double cp_km_h_from_m_s(double speed_m_s)
{
    return speed_m_s * 3.6;
}

static inline double cp_rad_from_deg(double angle_deg)
{
    return angle_deg * CP_PI / 180.0;
}

static inline double cp_deg_from_rad(double angle_rad)
{
    return angle_rad * 180.0 / CP_PI;
}

#endif
