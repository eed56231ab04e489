/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_FUNCTION_ACTIONS_H
#define CONTROL_FUNCTION_ACTIONS_H

#include "control/brake.h"
#include "control/control.h"
#include "control/function_counts.h"
#include "control/function_view.h"

/* What becomes of the requests of a function: warning, steering, limit, brake and acceleration of
 * each car, noted and counted. */

/* Of one car. Zero: nothing yet. */
typedef struct cp_function_car {
    cp_braking braking;
    double requested_s;
    bool has_target, has_cause; /* of the braking */
    cp_target_class class_of;
    bool is_warned, is_steering;
    uint32_t warned_of;     /* in the last warning, */
    double until_s;         /* looked at until then, SUMO clock */
    double factor_1;        /* speed factor that is set; 0: none */
    double driver_factor_1; /* that the driver brought along */
} cp_function_car;

/* Of one function. */
typedef struct cp_function_actions {
    const cp_traffic *traffic;
    const cp_function_senses *senses; /* for the class of targets */
    uint32_t does;                    /* of the function */
    double brake_delay_s;             /* from a request to the first deceleration */
    double jerk_m_s3, friction_m_s2;
    cp_function_counts counts;
} cp_function_actions;

/* After the function's step for a car, with a request that is checked. Errors: those of the
 * commands. */
CP_MUST_CHECK cp_status cp_function_carry_out(cp_function_actions *self,
                                              const cp_control_context *context,
                                              cp_function_car *car, const cp_vehicle_motion *motion,
                                              const crashpulse_request *request, cp_error *error);

/* Before it: whether what the car was warned of has come. */
void cp_function_look_back(cp_function_actions *self, const cp_vehicle_motion *motion,
                           cp_function_car *car);

/* Deceleration that is held for the function at a time. */
double cp_function_held_m_s2(const cp_function_car *car, double now_s);

#endif
