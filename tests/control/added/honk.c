/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_host.h"

/* The function that test_added.c adds: a car that has it slows down, gently and for good. */

enum { PENETRATION_1, DECELERATION_M_S2 };

static const cp_control_parameter PARAMETERS[] = {
    [PENETRATION_1] = CP_CONTROL_PENETRATION,
    [DECELERATION_M_S2] = {"deceleration_m_s2", 1.0, 0.1, 3.0, "how gently, m/s^2 (assumed)"},
};

static const char *create(const crashpulse_setup *setup, crashpulse_outlook *outlook, void **state)
{
    (void)outlook;
    *state = (void *)setup->parameter;
    return NULL;
}

static const char *step(void *state, void *car, const crashpulse_view *view,
                        crashpulse_request *request)
{
    (void)car;
    (void)view;
    const double *parameter = state;
    request->acceleration_m_s2 = -parameter[DECELERATION_M_S2];
    return NULL;
}

static const crashpulse_function HONK = {
    .abi = CRASHPULSE_FUNCTION_ABI,
    .does = CRASHPULSE_BRAKES,
    .what = "slows down",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .create = create,
    .step = step,
};

CP_FUNCTION_TYPE(CP_CONTROL_HONK, "honk", HONK, PARAMETERS, "slows down", false)
