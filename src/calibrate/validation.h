/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_VALIDATION_H
#define CALIBRATE_VALIDATION_H

#include "calibrate/reference.h"

/* How far a model's OLC values lie from a reference. All errors in g, absolute unless signed. */
typedef struct cp_validation_group {
    double value; /* of the variable grouped by: km/h, mm or degrees */
    size_t count;
    double mean_abs_error_g;
} cp_validation_group;

enum { CP_VALIDATION_GROUPS_MAX = 32 };

typedef struct cp_validation {
    size_t count;
    double mean_abs_error_g;
    double quartile_g[3]; /* 25, 50, 75 per cent of the absolute errors */
    double max_abs_error_g;
    double lowest_error_g; /* signed */
    double highest_error_g;
    size_t group_count[3]; /* by speed, by offset, by angle */
    cp_validation_group group[3][CP_VALIDATION_GROUPS_MAX];
} cp_validation;

/* Summarise olc_g[k] against cases[k].olc_g. Errors: CP_RUN_FAILED when a value is NAN (names the
 * case), CP_BAD_INPUT for more than CP_VALIDATION_GROUPS_MAX levels of a variable. */
CP_MUST_CHECK cp_status cp_validate_olc(const cp_reference_case *cases, const double *olc_g,
                                        size_t count, cp_validation *validation, cp_error *error);

#endif
