/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/fit_search.h"

#include "calibrate/descent_journal.h"
#include "calibrate/drawn_starts.h"
#include "calibrate/least_squares.h"
#include "calibrate/objective.h"
#include "calibrate/optimiser.h"
#include "calibrate/simplex.h"
#include "core/progress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// A candidate that is no car counts as this far off: far worse than any car.
static const double PENALTY_G = 50.0;
static const double PENALTY_TOTAL = 1000.0;
// A mark one width of its bounds outside weighs like 1 g of mean error, and among the residuals
// like one configuration off by 10 g.
static const double EXCESS_G = 1.0;
static const double EXCESS_RESIDUAL_G = 10.0;
// Inside its corridor a target's quantity is drawn to its aim: from the aim to a bound half a width
// away like half a gram of one configuration.
static const double DISTANCE_RESIDUAL_G = 1.0;

// One search: which cases count, at which time step, and how far it is.
typedef struct search {
    const cp_fit *fit;
    const bool *use; /* NULL: all cases */
    double time_step_s;
    cp_fit_work *work;
    double excess_1[CP_MARK_COUNT];                       /* of the candidate judged last */
    double target[CP_TARGETS_MAX * CP_TARGET_BOUNDS_MAX]; /* likewise */
    double known[CP_UNKNOWNS_MAX];                        /* point of the base vehicle */
    cp_descent_journal journal;                           /* of drawn starts */
    double *residual; /* of the candidate judged last, likewise; else NULL */
    cp_progress progress;
    cp_status failed;
    cp_error *error;
} search;

cp_status cp_fit_work_create(const cp_fit *fit, cp_fit_work *work, cp_error *error)
{
    *work = (cp_fit_work){0};
    work->olc_g = calloc(fit->reference.count + 1, sizeof *work->olc_g);
    if (fit->objective == CP_FIT_PULSE) {
        work->pulse_error = calloc(fit->pulse_count, sizeof *work->pulse_error);
        work->pulse_misfit =
            calloc(fit->pulse_count * CP_PULSE_MISFITS, sizeof *work->pulse_misfit);
    }
    if (work->olc_g == NULL || (fit->objective == CP_FIT_PULSE &&
                                (work->pulse_error == NULL || work->pulse_misfit == NULL)))
        return cp_fail_memory(error, "calibration");
    return CP_OK;
}

void cp_fit_work_destroy(cp_fit_work *work)
{
    free(work->olc_g);
    free(work->pulse_error);
    free(work->pulse_misfit);
    *work = (cp_fit_work){0};
}

// ---- how good a vehicle is -------------------------------------------------------------------

static double penalty_of(const cp_fit *fit)
{
    return fit->objective == CP_FIT_PULSE ? PENALTY_TOTAL : PENALTY_G;
}

// How far its marks leave their bounds; a pulse that fails is outside of all.
static void judge_marks(search *run, const cp_vehicle_model *model)
{
    const cp_plausibility *guard = &run->fit->plausible;
    double mark[CP_MARK_COUNT];
    cp_error refused = {0};
    for (int k = 0; k < CP_MARK_COUNT; k++)
        run->excess_1[k] = 0.0;
    if (!guard->given)
        return;
    if (cp_plausibility_marks(guard, model, run->time_step_s, mark, &refused) != CP_OK)
        for (int k = 0; k < CP_MARK_COUNT; k++)
            mark[k] = NAN;
    cp_plausibility_excess(guard, mark, run->excess_1);
}

// What the corridors of the targets cost: the mean excess of every target.
static cp_status judge_targets(search *run, const cp_vehicle_model *model, double *cost)
{
    const cp_fit *fit = run->fit;
    *cost = 0.0;
    cp_status status = cp_target_values(fit->target, fit->target_count, model, run->time_step_s,
                                        fit->threads, run->target, run->error);
    for (size_t t = 0; status == CP_OK && t < fit->target_count; t++) {
        const cp_target *target = &fit->target[t];
        const double *value = run->target + t * CP_TARGET_BOUNDS_MAX;
        double excess = 0.0;
        for (size_t b = 0; b < target->bound_count; b++)
            excess += fabs(cp_target_excess(&target->bound[b], value[b]));
        *cost += EXCESS_G * target->weight * excess / (double)target->bound_count;
    }
    return status;
}

// Simulate the cases in simulated (NULL: all), judge those the search uses; keeps what was found
// in the work space.
static cp_status judge_model(search *run, const cp_vehicle_model *model, const bool *simulated,
                             double *value)
{
    const cp_fit *fit = run->fit;
    const cp_reference *reference = &fit->reference;
    double targets = 0.0;
    cp_status status = judge_targets(run, model, &targets);
    if (status != CP_OK)
        return status;
    if (fit->objective == CP_FIT_OLC) {
        status = cp_objective_olc(model, reference->cases, reference->count, simulated,
                                  run->time_step_s, fit->threads, run->work->olc_g, run->error);
        if (status != CP_OK)
            return status;
        *value = cp_objective_mean_error(reference->cases, run->work->olc_g, reference->count,
                                         run->use, PENALTY_G);
        judge_marks(run, model);
        for (int k = 0; k < CP_MARK_COUNT; k++)
            *value += EXCESS_G * fabs(run->excess_1[k]);
        *value += targets;
        return CP_OK;
    }
    status =
        cp_objective_pulse(model, fit->pulses, fit->pulse_count, run->time_step_s, fit->threads,
                           run->work->pulse_error, run->work->pulse_misfit, run->error);
    if (status != CP_OK)
        return status;
    for (size_t k = 0; k < fit->pulse_count; k++) {
        const cp_pulse_error *found = &run->work->pulse_error[k];
        bool censored = !isnan(found->total) && isnan(found->model.olc_g);
        run->work->olc_g[k] = censored ? 0.0 : found->model.olc_g;
    }
    *value = cp_objective_pulse_mean(fit->pulses, run->work->pulse_error, fit->pulse_count,
                                     run->use, PENALTY_TOTAL);
    *value += targets;
    return CP_OK;
}

// What the way from what is known of the car costs, spread over the cases as their errors are.
static double prior_cost(const search *run, const double *point, size_t dimension)
{
    size_t used = 0;
    for (size_t k = 0; k < run->fit->reference.count; k++)
        used += run->use == NULL || run->use[k];
    double way_1 = 0.0;
    for (size_t k = 0; k < dimension; k++)
        way_1 += fabs(point[k] - run->known[k]);
    return used > 0 ? run->fit->prior_g * way_1 / (double)used : 0.0;
}

static double value_at(void *context, const double *point, size_t dimension)
{
    search *run = context;
    cp_vehicle_model model =
        cp_candidate_model(&run->fit->base, run->fit->unknown, dimension, point);
    cp_error refused = {0};
    double value = penalty_of(run->fit);
    if (cp_vehicle_model_validate(&model, &refused) != CP_OK)
        return value;
    cp_status status = judge_model(run, &model, run->use, &value);
    if (status != CP_OK)
        run->failed = status;
    return value + prior_cost(run, point, dimension);
}

// Misfits of the pulses in use, each by its weight.
static size_t pulse_residuals(const search *run, bool no_car, double *residual)
{
    const cp_fit *fit = run->fit;
    size_t row = 0;
    for (size_t k = 0; k < fit->pulse_count; k++) {
        if (run->use != NULL && !run->use[k])
            continue;
        const double *misfit = run->work->pulse_misfit + k * CP_PULSE_MISFITS;
        for (size_t m = 0; m < CP_PULSE_MISFITS; m++)
            residual[row++] =
                fit->pulses[k].weight_1 * (no_car || isnan(misfit[m]) ? PENALTY_G : misfit[m]);
    }
    return row;
}

// Signed errors of the cases in use, and how far the marks are outside.
static size_t olc_residuals(const search *run, bool no_car, double *residual)
{
    const cp_reference *reference = &run->fit->reference;
    size_t row = 0;
    for (size_t k = 0; k < reference->count; k++) {
        if (run->use != NULL && !run->use[k])
            continue;
        double olc_g = run->work->olc_g[k];
        residual[row++] = no_car || isnan(olc_g) ? PENALTY_G : olc_g - reference->cases[k].olc_g;
    }
    for (int k = 0; run->fit->plausible.given && k < CP_MARK_COUNT; k++)
        residual[row++] = no_car ? PENALTY_G : EXCESS_RESIDUAL_G * run->excess_1[k];
    return row;
}

// The targets' quantities: how far outside of their corridors, and inside of them from their aims.
static size_t target_residuals(const search *run, bool no_car, double *residual)
{
    const cp_fit *fit = run->fit;
    size_t row = 0;
    for (size_t t = 0; t < fit->target_count; t++) {
        const cp_target *target = &fit->target[t];
        for (size_t b = 0; b < target->bound_count; b++) {
            const cp_target_bounds *bounds = &target->bound[b];
            double value = run->target[t * CP_TARGET_BOUNDS_MAX + b];
            double misfit = EXCESS_RESIDUAL_G * cp_target_excess(bounds, value) +
                            DISTANCE_RESIDUAL_G * cp_target_distance(bounds, value);
            residual[row++] = no_car ? PENALTY_G : target->weight * misfit;
        }
    }
    return row;
}

// All misfits with their sign, then how far the unknowns have come; the value beside them, or among
// drawn starts what least squares make small.
static double residuals_at(void *context, const double *point, size_t dimension, double *residual,
                           size_t count)
{
    search *run = context;
    double value = value_at(run, point, dimension);
    bool no_car = value >= penalty_of(run->fit);
    size_t row = run->fit->objective == CP_FIT_PULSE ? pulse_residuals(run, no_car, residual)
                                                     : olc_residuals(run, no_car, residual);
    row += target_residuals(run, no_car, residual + row);
    for (size_t k = 0; row < count; k++)
        residual[row++] = run->fit->prior_g * (point[k] - run->known[k]);
    return run->residual != NULL ? cp_robust_mean(residual, count, run->fit->soft_g) : value;
}

// ---- the stages ------------------------------------------------------------------------------

// The best so far, in the words of the progress line.
static void describe_best(const cp_fit *fit, double best, char text[48])
{
    snprintf(text, 48, "best %.4f%s", best, fit->objective == CP_FIT_OLC ? " g" : "");
}

static void show_progress(void *context, size_t done, double best)
{
    search *run = context;
    char text[48];
    describe_best(run->fit, best, text);
    cp_progress_update(&run->progress, done, text);
}

// Global search, saved after every generation.
static cp_status search_globally(search *run, const char *state_path, uint32_t seed, double *point)
{
    const cp_fit *fit = run->fit;
    cp_optimiser_settings settings = {.algorithm = fit->algorithm,
                                      .dimension = fit->unknown_count,
                                      .population = fit->population,
                                      .seed = seed,
                                      .start = run->known,
                                      .function = value_at,
                                      .context = run};
    cp_optimiser *optimiser = NULL;
    run->time_step_s = fit->global_time_step_s;
    cp_status status = access(state_path, R_OK) == 0
                           ? cp_optimiser_restore(&settings, state_path, &optimiser, run->error)
                           : cp_optimiser_create(&settings, &optimiser, run->error);
    if (status != CP_OK)
        return status;
    cp_progress_begin(&run->progress, "global search", fit->generations);
    while (status == CP_OK && cp_optimiser_generation(optimiser) < fit->generations) {
        status = cp_optimiser_evolve(optimiser, run->error);
        if (status == CP_OK)
            status = run->failed;
        if (status == CP_OK)
            status = cp_optimiser_save(optimiser, state_path, run->error);
        show_progress(run, cp_optimiser_generation(optimiser), cp_optimiser_best(optimiser, NULL));
    }
    cp_progress_end(&run->progress);
    cp_optimiser_best(optimiser, point);
    cp_optimiser_destroy(optimiser);
    return status;
}

static size_t target_bounds(const cp_fit *fit)
{
    size_t count = 0;
    for (size_t t = 0; t < fit->target_count; t++)
        count += fit->target[t].bound_count;
    return count;
}

static size_t residual_count(const search *run)
{
    const cp_fit *fit = run->fit;
    size_t used = 0;
    for (size_t k = 0; k < fit->reference.count; k++)
        used += run->use == NULL || run->use[k];
    return used * (fit->objective == CP_FIT_PULSE ? (size_t)CP_PULSE_MISFITS : 1) +
           (fit->plausible.given ? (size_t)CP_MARK_COUNT : 0) + target_bounds(fit) +
           (fit->prior_g > 0.0 ? fit->unknown_count : 0);
}

// Down the slopes of all misfits; label: what the progress line calls it.
static cp_status search_slopes(search *run, const char *label, size_t evaluations, double *point)
{
    const cp_fit *fit = run->fit;
    if (evaluations == 0)
        return CP_OK;
    run->time_step_s = fit->local_time_step_s;
    cp_least_squares settings = {.function = residuals_at,
                                 .context = run,
                                 .dimension = fit->unknown_count,
                                 .count = residual_count(run),
                                 .soft = fit->soft_g,
                                 .step = 0.01,
                                 .evaluations = evaluations,
                                 .progress = show_progress};
    double value = 0.0;
    cp_progress_begin(&run->progress, label, evaluations);
    cp_status status = cp_least_squares_search(&settings, point, &value, run->error);
    cp_progress_end(&run->progress);
    return status == CP_OK ? run->failed : status;
}

// Nelder-Mead, started again from its own best until it stops gaining.
static cp_status search_locally(search *run, double *point)
{
    const cp_fit *fit = run->fit;
    if (fit->local_evaluations == 0)
        return CP_OK;
    run->time_step_s = fit->local_time_step_s;
    const int restarts = 3;
    cp_status status = CP_OK;
    double best[CP_UNKNOWNS_MAX], best_value = value_at(run, point, fit->unknown_count);
    cp_progress_begin(&run->progress, "local search", fit->local_evaluations);
    for (int k = 0; status == CP_OK && k < restarts; k++) {
        double value = 0.0;
        memcpy(best, point, sizeof best);
        status = cp_simplex_search(value_at, run, fit->unknown_count, 0.15 / (k + 1),
                                   fit->local_evaluations / restarts, point, &value, show_progress,
                                   run->error);
        if (status == CP_OK)
            status = run->failed;

        // The simplex starts a little inside the bounds: it may end above where it came from.
        if (value < best_value)
            best_value = value;
        else
            memcpy(point, best, sizeof best);
    }
    cp_progress_end(&run->progress);
    return status;
}

static void state_path(const char *stem, size_t start, char path[4096])
{
    snprintf(path, 4096, "%s.start%zu.fit.state", stem, start + 1);
}

// Starts and children are compared by what brings them down.
static double cost_at(void *context, const double *point, size_t dimension)
{
    search *run = context;
    return residuals_at(run, point, dimension, run->residual, residual_count(run));
}

// Down the slopes, or to where a search that was killed has come that way.
static cp_status descend(void *context, size_t evaluations, double *point)
{
    search *run = context;
    bool known = false;
    double before = cost_at(run, point, run->fit->unknown_count);
    cp_status status =
        cp_descent_journal_recall(&run->journal, evaluations, before, point, &known, run->error);
    if (status != CP_OK || known)
        return status;
    char label[64];
    snprintf(label, sizeof label, "descent %zu of %zu", run->journal.count + 1,
             cp_drawn_starts_descents(run->fit->starts, run->fit->offspring));
    status = search_slopes(run, label, evaluations, point);
    return status == CP_OK
               ? cp_descent_journal_add(&run->journal, evaluations, before, point, run->error)
               : status;
}

// Without a global search: from what is known and from points drawn around it.
static cp_status search_drawn_starts(search *run, const char *stem, uint32_t seed, double *point)
{
    const cp_fit *fit = run->fit;
    cp_drawn_starts starts = {.value = cost_at,
                              .descend = descend,
                              .context = run,
                              .known = run->known,
                              .dimension = fit->unknown_count,
                              .count = fit->starts,
                              .offspring = fit->offspring,
                              .evaluations = fit->slope_evaluations,
                              .seed = seed};
    run->time_step_s = fit->local_time_step_s;
    run->residual = calloc(residual_count(run), sizeof *run->residual);
    if (run->residual == NULL)
        return cp_fail_memory(run->error, "starts of a search");
    char path[4096];
    state_path(stem, 0, path);
    cp_status status = cp_descent_journal_open(&run->journal, path, fit->unknown_count, run->error);
    if (status == CP_OK)
        status = cp_drawn_starts_search(&starts, point, run->error);
    cp_descent_journal_close(&run->journal);
    free(run->residual);
    run->residual = NULL;
    return status == CP_OK ? run->failed : status;
}

// By a global search. Of several starts each goes down the slopes a little way, the best the whole
// of it.
static cp_status search_starts(search *run, const char *stem, uint32_t seed, double *point)
{
    const cp_fit *fit = run->fit;
    double best = INFINITY;
    cp_status status = CP_OK;
    for (size_t s = 0; status == CP_OK && s < fit->starts; s++) {
        double candidate[CP_UNKNOWNS_MAX] = {0};
        char path[4096];
        state_path(stem, s, path);
        status = search_globally(run, path, seed + 1000 * (uint32_t)s, candidate);
        if (status == CP_OK)
            status = search_slopes(run, "least squares",
                                   fit->slope_evaluations / (fit->starts > 1 ? 4 : 1), candidate);
        if (status != CP_OK)
            break;
        run->time_step_s = fit->local_time_step_s;
        double value = value_at(run, candidate, fit->unknown_count);
        if (value < best) {
            best = value;
            memcpy(point, candidate, sizeof candidate);
        }
    }
    if (status == CP_OK && fit->starts > 1)
        status = search_slopes(run, "least squares", fit->slope_evaluations, point);
    return status;
}

// Every number as a file of nine digits holds it, so that what is reported is what is written.
static void round_as_written(const cp_fit *fit, cp_vehicle_model *model)
{
    for (size_t k = 0; k < fit->unknown_count; k++) {
        char text[32];
        snprintf(text, sizeof text, "%.9g", cp_unknown_get(model, fit->unknown[k].name));
        cp_unknown_set(model, fit->unknown[k].name, strtod(text, NULL));
    }
    // What one length has cut of another.
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++) {
        char text[32];
        snprintf(text, sizeof text, "%.9g", cp_vehicle_model_get(model, k));
        cp_vehicle_model_set(model, k, strtod(text, NULL));
    }
}

cp_status cp_fit_search(const cp_fit *fit, const bool *use, const char *state_stem, uint32_t seed,
                        cp_vehicle_model *model, double *value, cp_fit_work *work, cp_error *error)
{
    search run = {.fit = fit, .use = use, .work = work, .failed = CP_OK, .error = error};
    cp_candidate_point(&fit->base, fit->unknown, fit->unknown_count, run.known);
    double point[CP_UNKNOWNS_MAX] = {0};
    cp_status status = cp_fit_draws_starts(fit) ? search_drawn_starts(&run, state_stem, seed, point)
                                                : search_starts(&run, state_stem, seed, point);
    if (status == CP_OK)
        status = search_locally(&run, point);
    if (status != CP_OK)
        return status;
    *model = cp_candidate_model(&fit->base, fit->unknown, fit->unknown_count, point);
    round_as_written(fit, model);
    run.time_step_s = fit->local_time_step_s;
    return judge_model(&run, model, NULL, value);
}

cp_status cp_fit_descend(const cp_fit *fit, const char *label, size_t evaluations, double *point,
                         double *cost, cp_error *error)
{
    cp_fit_work work;
    cp_status status = cp_fit_work_create(fit, &work, error);
    search run = {.fit = fit, .work = &work, .failed = CP_OK, .error = error};
    cp_candidate_point(&fit->base, fit->unknown, fit->unknown_count, run.known);
    if (status == CP_OK)
        status = search_slopes(&run, label, evaluations, point);
    run.residual = calloc(residual_count(&run), sizeof *run.residual);
    if (status == CP_OK && run.residual == NULL)
        status = cp_fail_memory(error, "calibration");
    if (status == CP_OK) {
        run.time_step_s = fit->local_time_step_s;
        *cost = cost_at(&run, point, fit->unknown_count);
        status = run.failed;
    }
    free(run.residual);
    cp_fit_work_destroy(&work);
    return status;
}

void cp_fit_search_forget(const cp_fit *fit, const char *state_stem)
{
    for (size_t s = 0; s < fit->starts; s++) {
        char path[4096];
        state_path(state_stem, s, path);
        unlink(path);
    }
}
