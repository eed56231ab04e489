/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_ACTS_H
#define CONTROL_ACTS_H

#include "control/vehicle_table.h"
#include "traffic/traffic.h"

/* What one function does to whom and since when, kept for as long as it may be asked: for the crash
 * that came all the same. Braking is noted by cp_actuation_request on its own; a function tells the
 * rest with cp_acts_note. */

#define CP_ACTS_MEMORY_S 5.0 /* an act is forgotten this long after its end */

typedef enum cp_act_kind {
    CP_ACT_WARNING,
    CP_ACT_REQUEST, /* braking or steering is to come */
    CP_ACT_BRAKING,
    CP_ACT_STEERING,
    CP_ACT_LIMITING, /* keeps the car to a speed limit from now on */
    CP_ACT_KINDS
} cp_act_kind;

/* From its beginning until nothing of it is noted for a step. SUMO's clock; NAN: not so. */
typedef struct cp_act {
    double since_s[CP_ACT_KINDS];
    double last_s;            /* end of the last step in which it was noted */
    double speed_m_s;         /* of the car when braking began */
    double deceleration_m_s2; /* largest of the car since, mean of a step */
    double request_m_s2[2];   /* asked for in the last step and in the one before it */
    double requested_at_s[2]; /* ends of the steps in which they were */
} cp_act;

/* Of one function. Create, begin each step, note, destroy. */
typedef struct cp_acts {
    const cp_traffic *traffic;
    cp_vehicle_table cars; /* the last two acts of each that had one and is on the road */
} cp_acts;

cp_acts cp_acts_create(const cp_traffic *traffic);
void cp_acts_destroy(cp_acts *acts);

/* After a traffic step, before the function's own. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_acts_step(cp_acts *acts, cp_error *error);

/* What the function does now, again in each step it lasts (limiting: once); since_s: instant of its
 * beginning, kept from the first time. acts NULL: nobody keeps them. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_acts_note(cp_acts *acts, uint32_t vehicle, cp_act_kind kind,
                                     double since_s, cp_error *error);
/* The same of braking, with the deceleration asked for at the end of the coming step. */
CP_MUST_CHECK cp_status cp_acts_brake(cp_acts *acts, uint32_t vehicle, double since_s,
                                      double deceleration_m_s2, cp_error *error);

typedef enum cp_act_state {
    CP_ACT_IDLE,
    CP_ACT_LIMITED,
    CP_ACT_WARNED,
    CP_ACT_REQUESTED,
    CP_ACT_BRAKED,
    CP_ACT_STEERED,
    CP_ACT_RELEASED,
} cp_act_state;

/* What was done to a car at an instant within the last step; times are before it, NAN: not so. */
typedef struct cp_act_at {
    cp_act_state state;
    double warned_s, requested_s, braking_s, steering_s;
    double released_s;          /* NAN unless released */
    double brake_request_m_s2;  /* in force at the instant; NAN: none */
    double deceleration_m_s2;   /* NAN without braking_s, as the next */
    double speed_taken_off_m_s; /* since braking_s */
} cp_act_at;

/* speed_m_s: of the car at the instant. */
cp_act_at cp_acts_at(const cp_acts *acts, uint32_t vehicle, double instant_s, double speed_m_s);

#endif
