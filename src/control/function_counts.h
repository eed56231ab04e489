/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_FUNCTION_COUNTS_H
#define CONTROL_FUNCTION_COUNTS_H

#include "api/crashpulse/function.h"

/* What the host of a function counts of it. */
typedef struct cp_function_counts {
    size_t activations, of_class[CRASHPULSE_CLASSES], for_nothing, activations_without_error;
    size_t warnings, warnings_without_error, warnings_borne_out;
    size_t interventions, limited;
    double braking_s;
} cp_function_counts;

/* Those of what the function does, and its own (counter, by index of its names), as the member
 * counters of a cp_control_type gives them. Returns how many. */
size_t cp_function_counts_list(const cp_function_counts *counts,
                               const crashpulse_function *function, const double *counter,
                               const char **names, double *values, size_t room);

#endif
