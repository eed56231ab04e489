/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_CALIBRATION_H
#define CALIBRATE_CALIBRATION_H

#include "calibrate/cross_validation.h"
#include "calibrate/ensemble.h"
#include "crash/crash_simulation.h"

/* Fitting a vehicle model to a reference: the search of fit_search.h over all cases, then the
 * cross-validations the fit file asks for. The objective is the fit file's: the mean absolute OLC
 * error over the reference's cases (and how far the marks of its pulse leave their bounds, if
 * bounds are given), or the weighted mean total error over its pulses. */

typedef struct cp_calibration {
    cp_vehicle_model model; /* the fitted one */
    double objective;       /* its value: g for olc, total error for pulse */
    cp_fit_work work;       /* owned: what it does in every case */
    cp_validation validation;
    double mark[CP_MARK_COUNT]; /* of its pulse, where the fit bounds them */
    double target[CP_TARGETS_MAX * CP_TARGET_BOUNDS_MAX]; /* of its targets (target.h) */
    cp_ensemble ensemble;                                 /* how the model's was found */
    size_t energy_count;                                  /* of the wall tests below */
    double energy_speed_km_h[3];
    cp_crash_whole
        energy[3]; /* what its parts absorb at a wall wider than the car, at those speeds */
    size_t cross_count;
    cp_cross_validation cross[CP_CROSS_KINDS]; /* owned */
} cp_calibration;

/* Run the fit, with progress on stderr. A killed fit goes on from its state file. Writes nothing
 * but state files. The caller destroys. */
CP_MUST_CHECK cp_status cp_calibration_run(const cp_fit *fit, cp_calibration *calibration,
                                           cp_error *error);
void cp_calibration_destroy(cp_calibration *calibration);

/* The fitted vehicle as a file of the kind cp_vehicle_model_load reads, with where every value
 * comes from; and the report of the fit beside it (<output>.fit.md). Removes the state files. */
CP_MUST_CHECK cp_status cp_calibration_write(const cp_fit *fit, const cp_calibration *calibration,
                                             cp_error *error);

#endif
