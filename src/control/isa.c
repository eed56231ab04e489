/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_host.h"

/* Intelligent speed assistance: a car that has it is driven no faster than the speed limits of its
 * lanes plus a tolerance. In SUMO's terms its speed factor, which the driver brings along, is
 * limited once, when the car enters; it acts all the way and belongs to whole-traffic designs. */

enum { PENETRATION_1, TOLERANCE_1 };

static const cp_control_parameter PARAMETERS[] = {
    [PENETRATION_1] = CP_CONTROL_PENETRATION,
    [TOLERANCE_1] = {"tolerance_1", 0.0, 0.0, 1.0,
                     "how much faster than the limit a car may go, as a share of it (assumed)"},
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
    request->speed_factor_1 = 1.0 + parameter[TOLERANCE_1];
    return NULL;
}

static const crashpulse_function ISA = {
    .abi = CRASHPULSE_FUNCTION_ABI,
    .does = CRASHPULSE_LIMITS | CRASHPULSE_ACTS_LONG_BEFORE,
    .what = "intelligent speed assistance: no faster than the speed limit",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .create = create,
    .step = step,
};

CP_FUNCTION_TYPE(CP_CONTROL_ISA, "isa", ISA, PARAMETERS,
                 "intelligent speed assistance: no faster than the speed limit", true)
