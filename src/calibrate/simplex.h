/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_SIMPLEX_H
#define CALIBRATE_SIMPLEX_H

#include "calibrate/optimiser.h"

/* Local search by Nelder and Mead's simplex (GSL nmsimplex2) on a point of 0..1 coordinates. The
 * bounds are kept by the substitution u = (1 + sin x) / 2. */

/* Improve point in place with at most evaluations calls of function; *value receives the value at
 * it. size_0: first edge of the simplex in x, e.g. 0.1. Stops early when the simplex has shrunk to
 * a ten-thousandth. progress (may be NULL) is called now and then with the evaluations done and
 * the best value. Errors: CP_NO_MEMORY, CP_RUN_FAILED. */
CP_MUST_CHECK cp_status cp_simplex_search(cp_optimiser_function function, void *context,
                                          size_t dimension, double size_0, size_t evaluations,
                                          double *point, double *value,
                                          void (*progress)(void *context, size_t done, double best),
                                          cp_error *error);

#endif
