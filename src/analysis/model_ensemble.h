/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_MODEL_ENSEMBLE_H
#define ANALYSIS_MODEL_ENSEMBLE_H

#include "analysis/study_data.h"

/* OLC of a study by every parameter set of its vehicle models, from the tables crash_vehicle_member
 * and counterfactual_vehicle_member. Set m of the study is set m of every vehicle model that has an
 * ensemble; a vehicle without one keeps its own OLC in every set. */
typedef struct cp_model_ensemble {
    size_t count; /* sets that every vehicle with an ensemble has; 0: none in the database */
    size_t vehicle_count;
    size_t pair_count;
    double *olc_g;     /* of vehicle k by set m at m vehicle_count + k: -INFINITY left-censored,
                          INFINITY simulation failed, NAN: keeps its own */
    double *treated_g; /* likewise of pair k's treated crash, the larger of its frontally struck
                          vehicles, left-censored as 0 */
    cp_study_vehicle *vehicle; /* rows of the set at hand */
    cp_study_pair *pair;
} cp_model_ensemble;

/* Fewer sets than this show no scatter. */
#define CP_MODEL_SETS_MIN 2

/* Read what belongs to a study read from the same database. The caller destroys, also after an
 * error. Errors: those of the store; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_model_ensemble_read(cp_store *store, const cp_study_data *data,
                                               cp_model_ensemble *ensemble, cp_error *error);
/* A zero-initialised one is fine too. */
void cp_model_ensemble_destroy(cp_model_ensemble *ensemble);

/* The study with every OLC by set number set < count. Borrows from both, is not to be destroyed,
 * and holds until the next call. */
cp_study_data cp_model_ensemble_study(const cp_model_ensemble *ensemble, const cp_study_data *data,
                                      size_t set);

#endif
