/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_FIT_SEARCH_H
#define CALIBRATE_FIT_SEARCH_H

#include "calibrate/fit.h"
#include "calibrate/pulse_objective.h"

#include <stdbool.h>

/* One search for the vehicle that fits a set of cases: from each of the fit's starts a global
 * search (pagmo), then least squares (GSL) where the fit asks for it; from the best of them
 * Nelder-Mead (GSL). Several starts without generations of a global search are drawn around what is
 * known instead (drawn_starts.h). */

/* What a model does in every case. */
typedef struct cp_fit_work {
    double *olc_g;               /* one a case, 0 where left-censored */
    cp_pulse_error *pulse_error; /* one a pulse; NULL by objective olc, as the next */
    double *pulse_misfit;        /* CP_PULSE_MISFITS a pulse */
} cp_fit_work;

/* The caller destroys. Errors: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_fit_work_create(const cp_fit *fit, cp_fit_work *work, cp_error *error);
void cp_fit_work_destroy(cp_fit_work *work);

/* Fit to the cases whose use[k] is true (NULL: all). state_stem: path the state of the global
 * search is kept at, ".startN.fit.state" appended; a killed search goes on from there. model
 * receives the fitted vehicle with every number as a file of nine digits holds it; *value its
 * objective over the cases used; work what it does in all cases, also those not used. */
CP_MUST_CHECK cp_status cp_fit_search(const cp_fit *fit, const bool *use, const char *state_stem,
                                      uint32_t seed, cp_vehicle_model *model, double *value,
                                      cp_fit_work *work, cp_error *error);

/* Down the slopes of all misfits from a point of 0..1 coordinates, over all cases: point is moved
 * in place, *cost receives the robust cost that least squares make small (cp_robust_mean), also for
 * evaluations 0. label: what the progress line calls it. Errors: CP_NO_MEMORY, CP_RUN_FAILED. */
CP_MUST_CHECK cp_status cp_fit_descend(const cp_fit *fit, const char *label, size_t evaluations,
                                       double *point, double *cost, cp_error *error);

/* Remove the states a search has left at state_stem. */
void cp_fit_search_forget(const cp_fit *fit, const char *state_stem);

#endif
