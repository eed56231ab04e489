/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_host.h"

#include "control/control_types.h"

/* A function from a library that the study names. Of its parameters only the share of equipped cars
 * is known before it is loaded. */

static const cp_control_parameter PARAMETERS[] = {CP_CONTROL_PENETRATION};

const cp_control_type CP_CONTROL_PLUGIN = {
    .name = "plugin",
    .kind = CP_CONTROL_FUNCTION,
    .what = "a function of your own from a shared library (crashpulse/function.h)",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .create = cp_function_host_create,
    .step = cp_function_host_step,
    .counters = cp_function_host_counters,
    .destroy = cp_function_host_destroy,
};
