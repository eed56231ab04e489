/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_ENSEMBLE_H
#define CALIBRATE_ENSEMBLE_H

#include "calibrate/fit_search.h"

/* Parameter sets that fit about as well as the best: what the references leave open.
 *
 * From the fitted vehicle every unknown is moved by up to a quarter of its bounds to either side,
 * at random, and the vehicle brought down again by least squares with half of the fit's
 * evaluations. It is kept if its robust cost (cp_robust_mean over all residuals) is at most that of
 * the best and the share ensemble_within_1 of it more. Four times as many are tried as are wanted,
 * at most. */
typedef struct cp_ensemble {
    double best_cost;
    size_t tried;
    double cost[CP_ENSEMBLE_MAX]; /* of those kept, in the order they were found */
} cp_ensemble;

/* Fill model->member of the fitted model. The same seed gives the same sets. Errors: those of the
 * search. */
CP_MUST_CHECK cp_status cp_ensemble_search(const cp_fit *fit, cp_vehicle_model *model,
                                           cp_ensemble *ensemble, cp_error *error);

#endif
