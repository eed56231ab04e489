/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/simplex.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multimin.h>
#include <math.h>
#include <stdlib.h>

// The caller's function behind the substitution, counting its calls and keeping the best.
typedef struct bounded {
    cp_optimiser_function function;
    void *context;
    size_t dimension;
    size_t calls;
    double *point; /* work space */
    double *best_point;
    double best;
} bounded;

static double value_at(const gsl_vector *x, void *parameters)
{
    bounded *problem = parameters;
    for (size_t k = 0; k < problem->dimension; k++)
        problem->point[k] = 0.5 * (1.0 + sin(gsl_vector_get(x, k)));
    double value = problem->function(problem->context, problem->point, problem->dimension);
    problem->calls++;
    if (value < problem->best) {
        problem->best = value;
        for (size_t k = 0; k < problem->dimension; k++)
            problem->best_point[k] = problem->point[k];
    }
    return value;
}

static cp_status iterate(gsl_multimin_fminimizer *minimizer, bounded *problem, size_t evaluations,
                         double smallest, void (*progress)(void *, size_t, double), cp_error *error)
{
    while (problem->calls < evaluations) {
        int outcome = gsl_multimin_fminimizer_iterate(minimizer);
        if (outcome == GSL_ENOPROG)
            return CP_OK;
        if (outcome != GSL_SUCCESS)
            return cp_fail(error, CP_RUN_FAILED, "simplex search: %s", gsl_strerror(outcome));
        if (progress != NULL)
            progress(problem->context, problem->calls, problem->best);
        if (gsl_multimin_fminimizer_size(minimizer) < smallest)
            return CP_OK;
    }
    return CP_OK;
}

cp_status cp_simplex_search(cp_optimiser_function function, void *context, size_t dimension,
                            double size_0, size_t evaluations, double *point, double *value,
                            void (*progress)(void *, size_t, double), cp_error *error)
{
    gsl_set_error_handler_off();
    bounded problem = {.function = function,
                       .context = context,
                       .dimension = dimension,
                       .point = malloc(dimension * sizeof(double)),
                       .best_point = point,
                       .best = INFINITY};
    gsl_vector *start = gsl_vector_alloc(dimension), *step = gsl_vector_alloc(dimension);
    gsl_multimin_fminimizer *minimizer =
        gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, dimension);
    gsl_multimin_function described = {value_at, dimension, &problem};
    cp_status status = CP_OK;
    if (problem.point == NULL || start == NULL || step == NULL || minimizer == NULL)
        status = cp_fail_memory(error, "simplex search");
    if (status == CP_OK) {
        // Start a little inside the bounds, where the substitution is not flat.
        for (size_t k = 0; k < dimension; k++) {
            double inside = fmin(0.995, fmax(0.005, point[k]));
            gsl_vector_set(start, k, asin(2.0 * inside - 1.0));
            gsl_vector_set(step, k, size_0);
        }
        if (gsl_multimin_fminimizer_set(minimizer, &described, start, step) != GSL_SUCCESS)
            status = cp_fail(error, CP_RUN_FAILED, "simplex search could not start");
    }
    if (status == CP_OK)
        status = iterate(minimizer, &problem, evaluations, 1e-4 * size_0, progress, error);
    *value = problem.best;
    if (minimizer != NULL)
        gsl_multimin_fminimizer_free(minimizer);
    if (start != NULL)
        gsl_vector_free(start);
    if (step != NULL)
        gsl_vector_free(step);
    free(problem.point);
    return status;
}
