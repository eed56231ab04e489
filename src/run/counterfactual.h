/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_COUNTERFACTUAL_H
#define RUN_COUNTERFACTUAL_H

#include "run/fleet.h"
#include "run/simulation.h"
#include "run/treatment.h"
#include "store/counterfactual_rows.h"

/* Counterfactual pairs: while the baseline runs, checkpoints are kept; each crash is gone through
 * again from one of them, once with nothing changed (null treatment) and once with each treatment's
 * functions on its two vehicles. The checkpoint lies at least CP_COUNTERFACTUAL_LEAD_S before
 * contact, and at least 1 s before the driver error began; the onset is known as the last
 * checkpoint at which the driver was not yet at fault. Branches run until
 * counterfactual.horizon_s after the baseline's contact. */
#define CP_COUNTERFACTUAL_LEAD_S 4.0
#define CP_COUNTERFACTUAL_BEFORE_ERROR_S 1.0

typedef struct cp_counterfactual cp_counterfactual;

/* For a simulation that has begun as one that is treated; both are borrowed. */
CP_MUST_CHECK cp_status cp_counterfactual_create(const cp_treatments *treatments,
                                                 cp_simulation *simulation,
                                                 cp_counterfactual **counterfactual,
                                                 cp_error *error);
/* Ends its processes; NULL is fine. */
void cp_counterfactual_destroy(cp_counterfactual *counterfactual);

/* After each step of the baseline: branches for the crashes of the step, checkpoints when due. */
CP_MUST_CHECK cp_status cp_counterfactual_step(cp_counterfactual *counterfactual, cp_error *error);

/* After the last step and before the simulation ends: the outcomes, with the surrogate run on every
 * treated crash. crashes: the counted crashes of the simulation, in order. */
CP_MUST_CHECK cp_status cp_counterfactual_conclude(cp_counterfactual *counterfactual,
                                                   const cp_fleet *fleet,
                                                   const cp_crash_row *crashes, size_t count,
                                                   cp_counterfactual_rows *rows, cp_error *error);

#endif
