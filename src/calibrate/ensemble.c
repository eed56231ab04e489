/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/ensemble.h"

#include "core/rng.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Share of its bounds that an unknown is moved to either side, and sets tried per set wanted.
static const double MOVED_1 = 0.25;
enum { TRIES = 4 };

static void keep(const cp_fit *fit, const double *point, cp_vehicle_model *model)
{
    cp_vehicle_model member = cp_candidate_model(model, fit->unknown, fit->unknown_count, point);
    double *set = model->member[model->member_count++];

    // As a file of nine digits holds it.
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++) {
        char text[32];
        snprintf(text, sizeof text, "%.9g", cp_vehicle_model_get(&member, k));
        set[k] = strtod(text, NULL);
    }
}

cp_status cp_ensemble_search(const cp_fit *fit, cp_vehicle_model *model, cp_ensemble *ensemble,
                             cp_error *error)
{
    *ensemble = (cp_ensemble){0};
    model->member_count = 0;
    if (fit->ensemble == 0)
        return CP_OK;
    double best[CP_UNKNOWNS_MAX];
    cp_candidate_point(model, fit->unknown, fit->unknown_count, best);
    cp_status status = cp_fit_descend(fit, "", 0, best, &ensemble->best_cost, error);
    double limit = (1.0 + fit->ensemble_within_1) * ensemble->best_cost;
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(fit->seed), "ensemble");
    while (status == CP_OK && model->member_count < fit->ensemble &&
           ensemble->tried < TRIES * fit->ensemble) {
        double point[CP_UNKNOWNS_MAX], cost = 0.0;
        for (size_t k = 0; k < fit->unknown_count; k++) {
            double moved =
                best[k] +
                MOVED_1 * (2.0 * cp_rng_uniform(key, ensemble->tried * CP_UNKNOWNS_MAX + k) - 1.0);
            point[k] = fmin(1.0, fmax(0.0, moved));
        }
        char label[64];
        snprintf(label, sizeof label, "ensemble, set %zu of %zu", model->member_count + 1,
                 fit->ensemble);
        status = cp_fit_descend(fit, label, fit->slope_evaluations / 2, point, &cost, error);
        ensemble->tried++;
        if (status == CP_OK && cost <= limit) {
            ensemble->cost[model->member_count] = cost;
            keep(fit, point, model);
        }
    }
    return status;
}
