/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/least_squares.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// One search: where it is, what is known there, and the best it has seen.
typedef struct descent {
    const cp_least_squares *settings;
    double *here;     /* point, one value a coordinate */
    double *residual; /* at it */
    double *trial;
    double *trial_residual;
    double *slope;       /* of every residual over every coordinate, a row a residual */
    gsl_vector *pull;    /* minus the gradient of the cost */
    gsl_matrix *curving; /* Gauss-Newton matrix */
    gsl_matrix *damped;
    gsl_vector *step;
    double cost;
    double damping;
    double raise; /* of the damping after the next failure */
    double *best_point;
    double best;
    size_t calls;
} descent;

static double evaluate(descent *work, const double *point, double *residual)
{
    const cp_least_squares *s = work->settings;
    double value = s->function(s->context, point, s->dimension, residual, s->count);
    work->calls++;
    if (value < work->best) {
        work->best = value;
        memcpy(work->best_point, point, s->dimension * sizeof *point);
    }
    if (s->progress != NULL)
        s->progress(s->context, work->calls, work->best);
    return value;
}

static double cost_of(const double *residual, size_t count, double soft)
{
    double cost = 0.0;
    for (size_t k = 0; k < count; k++) {
        double share = residual[k] / soft;
        cost += 2.0 * soft * soft * (sqrt(1.0 + share * share) - 1.0);
    }
    return cost;
}

double cp_robust_mean(const double *residual, size_t count, double soft)
{
    // The cost of one, solved for the misfit.
    double share = 1.0 + cost_of(residual, count, soft) / (2.0 * soft * soft * (double)count);
    return soft * sqrt(share * share - 1.0);
}

// Slopes of all residuals by a step in every coordinate, away from the nearer bound.
static void find_slopes(descent *work, double size)
{
    const cp_least_squares *s = work->settings;
    memcpy(work->trial, work->here, s->dimension * sizeof *work->here);
    for (size_t j = 0; j < s->dimension; j++) {
        double step = work->here[j] < 0.5 ? size : -size;
        work->trial[j] = work->here[j] + step;
        evaluate(work, work->trial, work->trial_residual);
        work->trial[j] = work->here[j];
        for (size_t k = 0; k < s->count; k++)
            work->slope[k * s->dimension + j] =
                (work->trial_residual[k] - work->residual[k]) / step;
    }
}

// What a step from `from` to here has taught of the slopes (Broyden 1965): no evaluation needed.
static void learn_slopes(descent *work, const double *from, const double *from_residual)
{
    const cp_least_squares *s = work->settings;
    double square = 0.0;
    for (size_t j = 0; j < s->dimension; j++)
        square += (work->here[j] - from[j]) * (work->here[j] - from[j]);
    for (size_t k = 0; square > 0.0 && k < s->count; k++) {
        double *row = &work->slope[k * s->dimension];
        double surprise = work->residual[k] - from_residual[k];
        for (size_t j = 0; j < s->dimension; j++)
            surprise -= row[j] * (work->here[j] - from[j]);
        for (size_t j = 0; j < s->dimension; j++)
            row[j] += surprise * (work->here[j] - from[j]) / square;
    }
}

// Gradient and Gauss-Newton matrix of the robust cost.
static void build_system(descent *work)
{
    const cp_least_squares *s = work->settings;
    gsl_vector_set_zero(work->pull);
    gsl_matrix_set_zero(work->curving);
    for (size_t k = 0; k < s->count; k++) {
        double share = work->residual[k] / s->soft, weight = 1.0 / sqrt(1.0 + share * share);
        const double *row = &work->slope[k * s->dimension];
        for (size_t i = 0; i < s->dimension; i++) {
            double weighted = weight * row[i];
            *gsl_vector_ptr(work->pull, i) -= weighted * work->residual[k];
            for (size_t j = 0; j <= i; j++)
                *gsl_matrix_ptr(work->curving, i, j) += weighted * row[j];
        }
    }
}

// Whether a coordinate sits on a bound and is pulled outwards.
static bool held(const descent *work, size_t k)
{
    double pull = gsl_vector_get(work->pull, k);
    return (work->here[k] <= 0.0 && pull < 0.0) || (work->here[k] >= 1.0 && pull > 0.0);
}

// The damped step from here, cut at the bounds, as trial; false: the system has no solution.
static bool propose(descent *work)
{
    size_t n = work->settings->dimension;
    for (size_t i = 0; i < n; i++) {
        bool out = held(work, i);
        gsl_vector_set(work->step, i, out ? 0.0 : gsl_vector_get(work->pull, i));
        for (size_t j = 0; j <= i; j++) {
            bool free = !out && !held(work, j);
            gsl_matrix_set(work->damped, i, j, free ? gsl_matrix_get(work->curving, i, j) : 0.0);
        }
        *gsl_matrix_ptr(work->damped, i, i) += out ? 1.0 : work->damping;
    }
    if (gsl_linalg_cholesky_decomp1(work->damped) != GSL_SUCCESS)
        return false;
    gsl_linalg_cholesky_svx(work->damped, work->step);
    for (size_t k = 0; k < n; k++)
        work->trial[k] = fmin(1.0, fmax(0.0, work->here[k] + gsl_vector_get(work->step, k)));
    return true;
}

// What the linear model promises for the step as it was cut.
static double promised_gain(const descent *work)
{
    size_t n = work->settings->dimension;
    double gain = 0.0;
    for (size_t i = 0; i < n; i++) {
        double step_i = work->trial[i] - work->here[i];
        gain += 2.0 * gsl_vector_get(work->pull, i) * step_i;
        for (size_t j = 0; j < n; j++) {
            double curving = gsl_matrix_get(work->curving, i > j ? i : j, i > j ? j : i);
            gain -= curving * step_i * (work->trial[j] - work->here[j]);
        }
    }
    return gain;
}

// One try with the present damping; whether it was taken.
static bool try_step(descent *work)
{
    const cp_least_squares *s = work->settings;
    if (propose(work)) {
        evaluate(work, work->trial, work->trial_residual);
        double cost = cost_of(work->trial_residual, s->count, s->soft);
        double quality = (work->cost - cost) / fmax(promised_gain(work), 1e-300);
        if (cost < work->cost) {
            // The point left stays in trial, its residuals in trial_residual.
            double *left = work->here, *left_residual = work->residual;
            work->here = work->trial;
            work->residual = work->trial_residual;
            work->trial = left;
            work->trial_residual = left_residual;
            work->cost = cost;
            double change = 2.0 * quality - 1.0;
            work->damping *= fmax(1.0 / 3.0, 1.0 - change * change * change);
            work->raise = 2.0;
            return true;
        }
    }
    work->damping *= work->raise;
    work->raise *= 2.0;
    return false;
}

static double first_damping(const descent *work)
{
    const double share = 0.01;
    double largest = 1e-12;
    for (size_t k = 0; k < work->settings->dimension; k++)
        largest = fmax(largest, gsl_matrix_get(work->curving, k, k));
    return share * largest;
}

// Step after step until the budget is spent or nothing more is gained. Slopes are found anew when
// those learnt on the way no longer lead down, or after some steps; where they lead nowhere, again
// by a longer and by a shorter step, which see past a kink or a ripple.
static void descend(descent *work)
{
    enum { TRIES = 8, TRIES_LEARNT = 2, STEPS_LEARNT = 6 };
    const cp_least_squares *s = work->settings;
    const double least_gain = 1e-4;
    evaluate(work, work->here, work->residual);
    work->cost = cost_of(work->residual, s->count, s->soft);
    work->raise = 2.0;
    static const double SIZE[] = {1.0, 3.0, 0.3};
    size_t stalled = 0;
    while (stalled < sizeof SIZE / sizeof *SIZE && work->calls + s->dimension < s->evaluations) {
        double before = work->cost;
        find_slopes(work, SIZE[stalled] * s->step);
        bool taken = false;
        for (int step = 0; step <= STEPS_LEARNT; step++) {
            build_system(work);
            if (work->damping <= 0.0)
                work->damping = first_damping(work);
            taken = false;
            int tries = step == 0 ? TRIES : TRIES_LEARNT;
            for (int k = 0; !taken && k < tries && work->calls < s->evaluations; k++)
                taken = try_step(work);
            if (!taken)
                break;
            learn_slopes(work, work->trial, work->trial_residual);
        }
        if (before - work->cost > least_gain * before) {
            stalled = 0;
        } else {
            stalled++;
            work->damping = 0.0;
            work->raise = 2.0;
        }
    }
}

static void release(descent *work)
{
    free(work->here);
    free(work->residual);
    free(work->trial);
    free(work->trial_residual);
    free(work->slope);
    gsl_vector_free(work->pull);
    gsl_vector_free(work->step);
    gsl_matrix_free(work->curving);
    gsl_matrix_free(work->damped);
}

cp_status cp_least_squares_search(const cp_least_squares *settings, double *point, double *value,
                                  cp_error *error)
{
    size_t n = settings->dimension, m = settings->count;
    if (m < n)
        return cp_fail(error, CP_BAD_INPUT,
                       "least squares need as many residuals as unknowns: %zu, found %zu", n, m);
    gsl_set_error_handler_off();
    descent work = {.settings = settings,
                    .here = malloc(n * sizeof(double)),
                    .residual = malloc(m * sizeof(double)),
                    .trial = malloc(n * sizeof(double)),
                    .trial_residual = malloc(m * sizeof(double)),
                    .slope = malloc(m * n * sizeof(double)),
                    .pull = gsl_vector_alloc(n),
                    .curving = gsl_matrix_alloc(n, n),
                    .damped = gsl_matrix_alloc(n, n),
                    .step = gsl_vector_alloc(n),
                    .best_point = point,
                    .best = INFINITY};
    cp_status status = CP_OK;
    if (work.here == NULL || work.residual == NULL || work.trial == NULL ||
        work.trial_residual == NULL || work.slope == NULL || work.pull == NULL ||
        work.curving == NULL || work.damped == NULL || work.step == NULL)
        status = cp_fail_memory(error, "least squares");
    if (status == CP_OK) {
        memcpy(work.here, point, n * sizeof *point);
        descend(&work);
    }
    *value = work.best;
    release(&work);
    return status;
}
