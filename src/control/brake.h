/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_BRAKE_H
#define CONTROL_BRAKE_H

#include "control/actuation.h"

/* A brake that builds up with limited jerk and then holds. */
typedef struct cp_brake {
    double start_s;           /* when deceleration begins to rise */
    double jerk_m_s3;         /* rise, > 0 */
    double deceleration_m_s2; /* held at the end, > 0 */
    double from_m_s2;         /* at the start: 0, but where another level was held before */
} cp_brake;

/* Speed taken away between start_s and time_s, m/s; 0 before. */
double cp_brake_speed_loss_m_s(const cp_brake *brake, double time_s);
/* Deceleration at time_s, m/s^2. */
double cp_brake_deceleration_m_s2(const cp_brake *brake, double time_s);

/* One braking of one car, from the request to the release. Zero-initialised: none. */
typedef struct cp_braking {
    bool is_requesting; /* from the request to the release */
    bool is_braking;    /* deceleration has begun */
    cp_brake brake;
    double commanded_until_s; /* the speed loss up to here has been asked for */
} cp_braking;

void cp_braking_begin(cp_braking *braking, const cp_brake *brake);

/* Another level is asked for from now on; it is gone to with the same jerk. */
void cp_braking_change(cp_braking *braking, double now_s, double deceleration_m_s2);

/* Ask for the speed at the end of the coming step. What was lost of the first step between the
 * start of deceleration and the first command is caught up, so that the speed is the profile's at
 * the end of every step. */
CP_MUST_CHECK cp_status cp_braking_command(cp_braking *braking, const cp_traffic *traffic,
                                           const cp_vehicle_motion *motion, cp_actuation *actuation,
                                           cp_error *error);

#endif
