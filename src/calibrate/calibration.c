/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/calibration.h"

#include "calibrate/objective.h"
#include "calibrate/optimiser.h"
#include "calibrate/simplex.h"
#include "core/log.h"
#include "core/progress.h"
#include "core/rng.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// A candidate that is no car counts as this far off: far worse than any car.
static const double PENALTY_G = 50.0;
static const double PENALTY_TOTAL = 1000.0;

// One search: which cases count, at which time step, and how far it is.
typedef struct search {
    const cp_fit *fit;
    const bool *use; /* NULL: all cases */
    double time_step_s;
    double *olc_g;               /* work space, one value a case */
    cp_pulse_error *pulse_error; /* likewise; NULL by objective olc */
    cp_progress progress;
    cp_status failed;
    cp_error *error;
} search;

static double penalty_of(const cp_fit *fit)
{
    return fit->objective == CP_FIT_PULSE ? PENALTY_TOTAL : PENALTY_G;
}

// Simulate a model in every case and judge it; keeps what was found in the work space.
static cp_status judge_model(search *run, const cp_vehicle_model *model, double *value)
{
    const cp_fit *fit = run->fit;
    const cp_reference *reference = &fit->reference;
    if (fit->objective == CP_FIT_OLC) {
        cp_status status = cp_objective_olc(model, reference->cases, reference->count,
                                            run->time_step_s, fit->threads, run->olc_g, run->error);
        if (status == CP_OK)
            *value = cp_objective_mean_error(reference->cases, run->olc_g, reference->count,
                                             run->use, PENALTY_G);
        return status;
    }
    cp_status status = cp_objective_pulse(model, fit->pulses, fit->pulse_count, run->time_step_s,
                                          fit->threads, run->pulse_error, run->error);
    if (status != CP_OK)
        return status;
    for (size_t k = 0; k < fit->pulse_count; k++) {
        const cp_pulse_error *found = &run->pulse_error[k];
        bool censored = !isnan(found->total) && isnan(found->model.olc_g);
        run->olc_g[k] = censored ? 0.0 : found->model.olc_g;
    }
    *value = cp_objective_pulse_mean(fit->pulses, run->pulse_error, fit->pulse_count, run->use,
                                     PENALTY_TOTAL);
    return CP_OK;
}

static double value_at(void *context, const double *point, size_t dimension)
{
    search *run = context;
    cp_vehicle_model model =
        cp_candidate_model(&run->fit->base, run->fit->unknown, dimension, point);
    cp_error refused = {0};
    if (cp_vehicle_model_validate(&model, &refused) != CP_OK)
        return penalty_of(run->fit);
    double value = penalty_of(run->fit);
    cp_status status = judge_model(run, &model, &value);
    if (status != CP_OK)
        run->failed = status;
    return value;
}

// The best so far, in the words of the progress line.
static void describe_best(const cp_fit *fit, double best, char text[48])
{
    snprintf(text, 48, "best %.4f%s", best, fit->objective == CP_FIT_OLC ? " g" : "");
}

// Global search, saved after every generation.
static cp_status search_globally(search *run, const char *state_path, uint32_t seed, double *point)
{
    const cp_fit *fit = run->fit;
    double start[CP_UNKNOWNS_MAX];
    cp_candidate_point(&fit->base, fit->unknown, fit->unknown_count, start);
    cp_optimiser_settings settings = {.algorithm = fit->algorithm,
                                      .dimension = fit->unknown_count,
                                      .population = fit->population,
                                      .seed = seed,
                                      .start = start,
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
        char best[48];
        describe_best(fit, cp_optimiser_best(optimiser, NULL), best);
        cp_progress_update(&run->progress, cp_optimiser_generation(optimiser), best);
    }
    cp_progress_end(&run->progress);
    cp_optimiser_best(optimiser, point);
    cp_optimiser_destroy(optimiser);
    return status;
}

static void show_simplex(void *context, size_t done, double best)
{
    search *run = context;
    char text[48];
    describe_best(run->fit, best, text);
    cp_progress_update(&run->progress, done, text);
}

// Local search at the finer step, started again from its own best until it stops gaining.
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
                                   fit->local_evaluations / restarts, point, &value, show_simplex,
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

// Fit to the cases use names; found's work space then holds how the model does in all of them.
static cp_status fit_once(const cp_fit *fit, const bool *use, const char *state_path, uint32_t seed,
                          cp_calibration *found, cp_error *error)
{
    search run = {.fit = fit,
                  .use = use,
                  .olc_g = found->olc_g,
                  .pulse_error = found->pulse_error,
                  .failed = CP_OK,
                  .error = error};
    double point[CP_UNKNOWNS_MAX] = {0};
    cp_status status = search_globally(&run, state_path, seed, point);
    if (status == CP_OK)
        status = search_locally(&run, point);
    if (status != CP_OK)
        return status;
    found->model = cp_candidate_model(&fit->base, fit->unknown, fit->unknown_count, point);
    run.time_step_s = fit->local_time_step_s;
    return judge_model(&run, &found->model, &found->objective);
}

// Work space for what a model does in every case.
static cp_status allocate(const cp_fit *fit, cp_calibration *found, cp_error *error)
{
    *found = (cp_calibration){0};
    found->olc_g = calloc(fit->reference.count, sizeof *found->olc_g);
    if (fit->objective == CP_FIT_PULSE)
        found->pulse_error = calloc(fit->pulse_count, sizeof *found->pulse_error);
    if (found->olc_g == NULL || (fit->objective == CP_FIT_PULSE && found->pulse_error == NULL))
        return cp_fail_memory(error, "calibration");
    return CP_OK;
}

// Fold of every case: a seeded shuffle dealt out in turn.
static void deal_folds(const cp_fit *fit, size_t *fold)
{
    size_t count = fit->reference.count;
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(fit->seed), "folds");
    for (size_t k = 0; k < count; k++)
        fold[k] = k % fit->folds;
    for (size_t k = count; k > 1; k--) {
        size_t other = (size_t)(cp_rng_uniform(key, k) * (double)k);
        size_t keep = fold[k - 1];
        fold[k - 1] = fold[other];
        fold[other] = keep;
    }
}

// Fit without each fold in turn, predict the fold.
static cp_status cross_validate(const cp_fit *fit, cp_calibration *calibration, cp_error *error)
{
    size_t count = fit->reference.count;
    size_t *fold = calloc(count, sizeof *fold);
    bool *use = calloc(count, sizeof *use);
    cp_calibration without;
    calibration->held_out_g = calloc(count, sizeof *calibration->held_out_g);
    cp_status status = allocate(fit, &without, error);
    if (fold == NULL || use == NULL || calibration->held_out_g == NULL)
        status = cp_fail_memory(error, "cross-validation");
    if (status == CP_OK)
        deal_folds(fit, fold);
    for (size_t f = 0; status == CP_OK && f < fit->folds; f++) {
        cp_log_info("cross-validation: fold %zu of %zu", f + 1, fit->folds);
        for (size_t k = 0; k < count; k++)
            use[k] = fold[k] != f;
        char state_path[4096];
        snprintf(state_path, sizeof state_path, "%s.fold%zu.fit.state", fit->output_path, f + 1);
        status = fit_once(fit, use, state_path, fit->seed + (uint32_t)f + 1, &without, error);
        for (size_t k = 0; status == CP_OK && k < count; k++)
            if (!use[k])
                calibration->held_out_g[k] = without.olc_g[k];
    }
    calibration->fold_count = fit->folds;
    if (status == CP_OK)
        status = cp_validate_olc(fit->reference.cases, calibration->held_out_g, count,
                                 &calibration->cross_validation, error);
    free(fold);
    free(use);
    cp_calibration_destroy(&without);
    return status;
}

cp_status cp_calibration_run(const cp_fit *fit, cp_calibration *calibration, cp_error *error)
{
    size_t count = fit->reference.count;
    char state_path[4096];
    snprintf(state_path, sizeof state_path, "%s.fit.state", fit->output_path);
    cp_status status = allocate(fit, calibration, error);
    if (status == CP_OK)
        status = fit_once(fit, NULL, state_path, fit->seed, calibration, error);
    if (status == CP_OK)
        status = cp_validate_olc(fit->reference.cases, calibration->olc_g, count,
                                 &calibration->validation, error);
    if (status == CP_OK && fit->folds > 1)
        status = cross_validate(fit, calibration, error);
    if (status != CP_OK)
        cp_calibration_destroy(calibration);
    return status;
}

void cp_calibration_destroy(cp_calibration *calibration)
{
    free(calibration->olc_g);
    free(calibration->pulse_error);
    free(calibration->held_out_g);
    *calibration = (cp_calibration){0};
}
