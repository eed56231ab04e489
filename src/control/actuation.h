/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_ACTUATION_H
#define CONTROL_ACTUATION_H

#include "control/acts.h"
#include "traffic/traffic.h"

/* Who brakes what: functions, and drivers whose braking SUMO does not do, ask for the speed a
 * vehicle shall have at the end of the coming step, the lowest request goes to SUMO. The first
 * request takes the vehicle over from SUMO's driver (speed mode 27: all its checks but the maximum
 * deceleration of the vehicle type, so that it may brake harder still but not less), the first step
 * without one hands it back as it was. */
typedef struct cp_actuation_car {
    uint32_t vehicle;
    double request_m_s;       /* lowest of this step; valid if is_requested */
    double deceleration_m_s2; /* largest of this step */
    int driver_mode;          /* SUMO's speed mode before we took over */
    bool is_requested;
    bool is_taken;
} cp_actuation_car;

/* Zero-initialise, request and apply in every step, destroy. */
typedef struct cp_actuation {
    cp_actuation_car *cars; /* those that are ours or requested in this step, few of all */
    size_t count;
    size_t room;
    cp_acts *acts; /* of the function that asks now, whose braking is noted there; NULL: nowhere */
} cp_actuation;

/* Ask for a speed (>= 0) of a vehicle on the road at the end of the coming step; deceleration_m_s2
 * is what is told to who asks for the functions' brake request (drivers give 0). Error:
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_actuation_request(cp_actuation *actuation, uint32_t vehicle,
                                             double speed_m_s, double deceleration_m_s2,
                                             cp_error *error);
/* After all functions have spoken: commands to SUMO, and hand back what nobody asks for now. */
CP_MUST_CHECK cp_status cp_actuation_apply(cp_actuation *actuation, const cp_traffic *traffic,
                                           cp_error *error);
/* Deceleration the functions ask of a vehicle now, m/s^2; 0 when none does. */
double cp_actuation_deceleration_m_s2(const cp_actuation *actuation, uint32_t vehicle);
void cp_actuation_destroy(cp_actuation *actuation);

#endif
