/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PULSE_SEVERITY_H
#define PULSE_SEVERITY_H

#include "pulse/olc.h"
#include "pulse/pulse.h"

/* Severity measures of one pulse (defined in reports/README.md).
 * End of the crash t_e: separation or, if later, the time of the largest |delta v|, at most 0.5 s.
 * World velocities come from v_x, v_y turned by the heading, in the axes of the initial pose. Means
 * over windows count no acceleration before and after the record. What does not exist is NAN. */
typedef struct cp_severity {
    cp_olc olc;
    double end_s;            /* t_e */
    double delta_v_m_s;      /* |v_world(t_e) - v_world(0)|, >= 0 */
    double delta_v_x_m_s;    /* v_x(0) - v_x(t_e) */
    double delta_v_y_m_s;    /* v_y(0) - v_y(t_e) */
    double peak_g;           /* largest -a_x, CFC60 */
    double mean_g;           /* (v_x(0) - min v_x) / (g t(min v_x)) */
    double t_v0_s;           /* first v_x <= 0, interpolated; barrier only, else NAN */
    double max_50ms_g;       /* largest 50 ms moving mean of -a_x */
    double max_50ms_y_g;     /* largest 50 ms moving mean of a_y, either way */
    double asi_1;            /* acceleration severity index of EN 1317-1:1998: largest of
                              * sqrt((a_x / 12 g)^2 + (a_y / 9 g)^2) of 50 ms means; its third
                              * part, a_z / 10 g, is 0 in the plane. (The edition of 2010 has a
                              * 13 Hz filter in place of the means.) */
    double pdof_rad;         /* principal direction of force, vehicle frame */
    double yaw_change_rad_s; /* yaw rate at t_e minus at 0 */
} cp_severity;

/* raw: the unfiltered pulse. separation_s: time of the last contact force. against_barrier: whether
 * t_v0_s is defined. OLC is computed as for front contact; a caller that knows better overrides
 * its status. Errors: CP_NO_MEMORY, CP_BAD_INPUT for a pulse too coarse for CFC60 or of fewer than
 * 2 samples. */
CP_MUST_CHECK cp_status cp_severity_of_pulse(const cp_pulse *raw, double separation_s,
                                             int against_barrier, cp_severity *severity,
                                             cp_error *error);

#endif
