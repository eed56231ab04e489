/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_FIT_VEHICLE_H
#define CALIBRATE_FIT_VEHICLE_H

#include "calibrate/calibration.h"

#include <stdio.h>

/* The fitted vehicle as a file of the kind cp_vehicle_model_load reads, with where every value
 * comes from. */
void cp_fit_write_vehicle(FILE *file, const cp_fit *fit, const cp_calibration *calibration);

/* How it was searched for, a sentence; it stands in the vehicle file and in the report. */
void cp_fit_write_way(FILE *file, const cp_fit *fit);

#endif
