/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_SUITE_VALIDATION_H
#define CLI_SUITE_VALIDATION_H

#include "cli/output.h"

/* crashpulse validate --suite: vehicles against all crash tests of a suite. */

enum { CP_SUITE_VEHICLES_MAX = 16 };

typedef struct cp_suite_validation {
    const char *path;
    const char *vehicles[CP_SUITE_VEHICLES_MAX]; /* names or paths; none: the suite's */
    size_t vehicle_count;
    const char *references; /* NULL: ../../../shared/reference as seen from the suite */
    bool list_cases;
    int threads;
} cp_suite_validation;

/* Run and print. Errors: CP_BAD_INPUT (suite, vehicle, table), those of simulating and printing. */
CP_MUST_CHECK cp_status cp_suite_validate(const cp_suite_validation *what, cp_format format,
                                          cp_error *error);

#endif
