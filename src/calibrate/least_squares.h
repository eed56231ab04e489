/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_LEAST_SQUARES_H
#define CALIBRATE_LEAST_SQUARES_H

#include "core/error.h"

#include <stddef.h>

/* Local search for a function that is a sum of many misfits, each known with its sign, on a point
 * of 0..1 coordinates: Levenberg-Marquardt with the damping rule of Nielsen (1999), the robust cost
 *   sum of 2 soft^2 (sqrt(1 + (r / soft)^2) - 1),
 * which counts large misfits by their absolute value rather than their square (Gauss-Newton weight
 * 1 / sqrt(1 + (r / soft)^2)), and bounds kept by projection: a coordinate on a bound that pulls
 * outwards sits out the step. GSL solves the linear systems; its own nonlinear fits know no bounds.
 * Uses what Nelder-Mead does not see, the slope of every misfit, and so comes as far in a tenth of
 * the evaluations. */

/* Misfits at point: fills residual[0..count-1] (every one finite) and returns the value that is
 * to be made small. */
typedef double (*cp_residual_function)(void *context, const double *point, size_t dimension,
                                       double *residual, size_t count);

typedef struct cp_least_squares {
    cp_residual_function function;
    void *context;
    size_t dimension;
    size_t count;       /* of residuals, >= dimension */
    double soft;        /* residual from which on the absolute value counts, e.g. 0.3 */
    double step;        /* of the slopes, in coordinates, e.g. 0.01 */
    size_t evaluations; /* at most */
    /* Now and then, with the evaluations done and the best value; may be NULL. */
    void (*progress)(void *context, size_t done, double best);
} cp_least_squares;

/* The misfit that, the same everywhere, costs as much as these: their root mean square for a large
 * soft, their mean absolute value for a small one, and between the two in between. */
double cp_robust_mean(const double *residual, size_t count, double soft);

/* Improve point in place; *value receives the value at it, never worse than at the start. Errors:
 * CP_NO_MEMORY, CP_BAD_INPUT (fewer residuals than coordinates). */
CP_MUST_CHECK cp_status cp_least_squares_search(const cp_least_squares *settings, double *point,
                                                double *value, cp_error *error);

#endif
