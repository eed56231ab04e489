/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_parameters.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const cp_control_parameter HOST[CP_HOST_PARAMETERS] = {
    [CP_HOST_RANGE_M] = {"sensor_range_m", 80.0, 1.0, 500.0, "how far the sensor sees, m"},
    [CP_HOST_FIELD_OF_VIEW_DEG] = {"sensor_field_of_view_deg", 60.0, 1.0, 360.0,
                                   "whole opening angle of the sensor, degrees"},
    [CP_HOST_LATENCY_S] = {"sensor_latency_s", 0.1, 0.0, 2.0, "age of what the sensor tells, s"},
    [CP_HOST_CONFIRMATION_S] = {"sensor_confirmation_s", 0.2, 0.0, 5.0,
                                "a target is known after this long in view, s"},
    [CP_HOST_DETECTION_PROBABILITY_1] = {"sensor_detection_probability_1", 1.0, 0.0, 1.0,
                                         "chance that one particular target is ever detected"},
    [CP_HOST_OCCLUSION_1] = {"sensor_occlusion_1", 1.0, 0.0, 1.0,
                             "1: other vehicles hide what is behind them"},
    [CP_HOST_DEAD_TIME_S] = {"dead_time_s", 0.1, 0.0, 2.0,
                             "from request to the first deceleration, s"},
    [CP_HOST_JERK_M_S3] = {"jerk_m_s3", 40.0, 1.0, 1000.0, "rise of deceleration, m/s^3"},
    [CP_HOST_FRICTION_1] = {"friction_1", 0.9, 0.05, 1.5, "friction coefficient"},
    [CP_HOST_STEP_LIMIT_S] = {"step_limit_s", 10.0, 0.05, 600.0,
                              "one call of a library may take this long, s of wall clock"},
    [CP_HOST_MEMORY_LIMIT_MB] = {"memory_limit_mb", 1024.0, 1.0, 1048576.0,
                                 "and all its calls may let memory grow by this, MB"},
};

static const cp_control_parameter *find(const cp_control_parameter *table, size_t count,
                                        const char *name)
{
    for (size_t k = 0; k < count; k++)
        if (strcmp(table[k].name, name) == 0)
            return &table[k];
    return NULL;
}

static cp_status fail_unknown(const crashpulse_function *function, const cp_library *library,
                              const char *name, cp_error *error)
{
    char names[512] = "";
    for (size_t k = 0; k < function->parameter_count; k++) {
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", k > 0 ? ", " : "",
                 function->parameters[k].name);
    }
    return cp_fail(error, CP_BAD_INPUT,
                   "'%s' is not a parameter of %s; it has %s, and those of the host "
                   "(crashpulse/function.h)",
                   name, library->written, names[0] != '\0' ? names : "none");
}

// One key of the study: of the function's table, else the host's, else handed on.
static cp_status take_given(const crashpulse_function *function, const cp_library *library,
                            const cp_library_parameter *given, cp_function_parameters *parameters,
                            cp_error *error)
{
    const cp_control_parameter *row =
        find(function->parameters, function->parameter_count, given->name);
    double *value = row != NULL ? &parameters->own[row - function->parameters] : NULL;
    if (row == NULL && (row = find(HOST, CP_HOST_PARAMETERS, given->name)) != NULL)
        value = &parameters->host[row - HOST];
    if (row == NULL && !(function->does & CRASHPULSE_ANY_PARAMETER))
        return fail_unknown(function, library, given->name, error);
    if (row == NULL) {
        parameters->extra[parameters->extra_count++] =
            (crashpulse_extra){given->name, given->text, given->number};
        return CP_OK;
    }
    if (!(given->number >= row->smallest && given->number <= row->largest))
        return cp_fail(error, CP_BAD_INPUT, "%s must be a number in %g..%g, found '%s'", row->name,
                       row->smallest, row->largest, given->text);
    *value = given->number;
    return CP_OK;
}

// The host's keys that stand in the function's table too have the value they have there.
static void share(const crashpulse_function *function, cp_function_parameters *parameters)
{
    for (size_t k = 0; k < function->parameter_count; k++) {
        const cp_control_parameter *host =
            find(HOST, CP_HOST_PARAMETERS, function->parameters[k].name);
        if (host != NULL)
            parameters->host[host - HOST] = parameters->own[k];
    }
}

cp_status cp_function_parameters_take(const crashpulse_function *function,
                                      const cp_control_settings *settings,
                                      cp_function_parameters *parameters, cp_error *error)
{
    const cp_library *library = settings->library;
    for (size_t k = 0; k < CP_HOST_PARAMETERS; k++)
        parameters->host[k] = HOST[k].standard;
    for (size_t k = 0; k < function->parameter_count; k++)
        parameters->own[k] =
            library != NULL ? function->parameters[k].standard : settings->parameter[k];
    cp_status status = CP_OK;
    if (library != NULL) {
        parameters->extra = calloc(library->given_count + 1, sizeof *parameters->extra);
        if (parameters->extra == NULL)
            return cp_fail_memory(error, "parameters");
        // Its share of cars is the study's, read already.
        for (size_t k = 0; k < function->parameter_count; k++)
            if (strcmp(function->parameters[k].name, settings->type->parameters[0].name) == 0)
                parameters->own[k] = settings->parameter[0];
        for (size_t k = 0; status == CP_OK && k < library->given_count; k++)
            status = take_given(function, library, &library->given[k], parameters, error);
    }
    share(function, parameters);
    return status;
}

void cp_function_parameters_destroy(cp_function_parameters *parameters)
{
    free(parameters->extra);
    *parameters = (cp_function_parameters){0};
}
