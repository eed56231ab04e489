/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_OBJECTIVE_H
#define CALIBRATE_OBJECTIVE_H

#include "calibrate/reference.h"
#include "crash/crash_simulation.h"

/* OLC of a vehicle model in the configurations of a reference, against its own barrier. */

/* Simulate cases[0..count) whose use[k] is true (NULL: all) on threads threads (>= 1); olc_g[k]
 * receives the model's OLC, 0 for one that is left-censored (no deceleration, beyond 0.5 s), NAN
 * where the crash could not be simulated; those not used stay as they are. time_step_s as in the
 * crash options. The result does not depend on threads. cp_crash_library_begin must have been
 * called. Errors: CP_NO_MEMORY, CP_RUN_FAILED. */
CP_MUST_CHECK cp_status cp_objective_olc(const cp_vehicle_model *model,
                                         const cp_reference_case *cases, size_t count,
                                         const bool *use, double time_step_s, int threads,
                                         double *olc_g, cp_error *error);

/* Mean absolute difference to the reference over the cases whose use[k] is true (NULL: all). A
 * case that failed counts as penalty_g. */
double cp_objective_mean_error(const cp_reference_case *cases, const double *olc_g, size_t count,
                               const bool *use, double penalty_g);

#endif
