/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_FUNCTION_PARAMETERS_H
#define CONTROL_FUNCTION_PARAMETERS_H

#include "control/control.h"

/* Parameters that are the host's and not the function's, by their keys in the study file. */
typedef enum cp_host_parameter {
    CP_HOST_RANGE_M,
    CP_HOST_FIELD_OF_VIEW_DEG,
    CP_HOST_LATENCY_S,
    CP_HOST_CONFIRMATION_S,
    CP_HOST_DETECTION_PROBABILITY_1,
    CP_HOST_OCCLUSION_1,
    CP_HOST_DEAD_TIME_S,
    CP_HOST_JERK_M_S3,
    CP_HOST_FRICTION_1,
    CP_HOST_STEP_LIMIT_S,
    CP_HOST_MEMORY_LIMIT_MB,
    CP_HOST_PARAMETERS
} cp_host_parameter;

/* All parameters of a function with their values. */
typedef struct cp_function_parameters {
    double own[CP_CONTROL_PARAMETERS_MAX]; /* by index of the function's table */
    double host[CP_HOST_PARAMETERS];
    crashpulse_extra *extra; /* keys in neither; texts borrowed from the settings */
    size_t extra_count;
} cp_function_parameters;

/* Values as the settings have them, else the defaults of the function's table, else the host's.
 * Zero-initialise; destroy. Errors: CP_BAD_INPUT for a key or value that neither knows;
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_function_parameters_take(const crashpulse_function *function,
                                                    const cp_control_settings *settings,
                                                    cp_function_parameters *parameters,
                                                    cp_error *error);
void cp_function_parameters_destroy(cp_function_parameters *parameters);

#endif
