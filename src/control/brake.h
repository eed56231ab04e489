/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_BRAKE_H
#define CONTROL_BRAKE_H

/* A brake that builds up with limited jerk and then holds. */
typedef struct cp_brake {
    double start_s;           /* when deceleration begins to rise */
    double jerk_m_s3;         /* rise, > 0 */
    double deceleration_m_s2; /* held at the end, > 0 */
} cp_brake;

/* Speed taken away between start_s and time_s, m/s; 0 before. */
double cp_brake_speed_loss_m_s(const cp_brake *brake, double time_s);

#endif
