/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_CALIBRATION_H
#define CALIBRATE_CALIBRATION_H

#include "calibrate/fit_file.h"
#include "calibrate/pulse_objective.h"
#include "calibrate/validation.h"

/* Fitting a vehicle model to a reference: a global search (pagmo), then Nelder-Mead from its best.
 * The objective is the fit file's: the mean absolute OLC error over the reference's cases, or the
 * weighted mean total error over its pulses. */

typedef struct cp_calibration {
    cp_vehicle_model model;      /* the fitted one */
    double objective;            /* its value: g for olc, total error for pulse */
    double *olc_g;               /* owned: its OLC a case, 0 where left-censored */
    cp_pulse_error *pulse_error; /* owned: its error a pulse; NULL by objective olc */
    cp_validation validation;
    size_t fold_count;
    double *held_out_g; /* owned: a case's OLC by the model fitted without its fold; NULL: none */
    cp_validation cross_validation;
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
