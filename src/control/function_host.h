/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_FUNCTION_HOST_H
#define CONTROL_FUNCTION_HOST_H

#include "control/control.h"

/* The control that every function is (crashpulse/function.h): it has the sensor, asks the function
 * for each equipped car what it wants, checks that, brakes, steers, notes and counts. The members
 * of a cp_control_type; context->settings says which function. */

CP_MUST_CHECK cp_status cp_function_host_create(const cp_control_context *context, void **state,
                                                cp_error *error);
CP_MUST_CHECK cp_status cp_function_host_step(void *state, const cp_control_context *context,
                                              cp_error *error);
size_t cp_function_host_counters(const void *state, const char **names, double *values,
                                 size_t room);
void cp_function_host_destroy(void *state);

/* In a function's own file, behind its crashpulse_function: the row for control_types.h. Built with
 * CRASHPULSE_PLUGIN the same file is a library of its own instead. parameters: an array; its first
 * is CP_CONTROL_PENETRATION. */
#ifdef CRASHPULSE_PLUGIN
#define CP_FUNCTION_TYPE(symbol, text, function_, parameters_, what_, long_before)                 \
    const crashpulse_function *crashpulse_function_entry(void)                                     \
    {                                                                                              \
        return &(function_);                                                                       \
    }
#else
#define CP_FUNCTION_TYPE(symbol, text, function_, parameters_, what_, long_before)                 \
    extern const cp_control_type symbol;                                                           \
    const cp_control_type symbol = {                                                               \
        .name = (text),                                                                            \
        .kind = CP_CONTROL_FUNCTION,                                                               \
        .what = (what_),                                                                           \
        .acts_long_before = (long_before),                                                         \
        .parameters = (parameters_),                                                               \
        .parameter_count = sizeof(parameters_) / sizeof *(parameters_),                            \
        .function = &(function_),                                                                  \
        .create = cp_function_host_create,                                                         \
        .step = cp_function_host_step,                                                             \
        .counters = cp_function_host_counters,                                                     \
        .destroy = cp_function_host_destroy,                                                       \
    };
#endif

#endif
