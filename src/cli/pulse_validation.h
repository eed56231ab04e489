/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_PULSE_VALIDATION_H
#define CLI_PULSE_VALIDATION_H

#include "calibrate/pulse_objective.h"
#include "cli/output.h"

/* Simulate the condition of a reference pulse against the model's barrier and print how far the
 * two lie apart: OLC, time of v_x = 0, peak, crush, mean absolute errors. curves_path (may be
 * NULL): file for both pulses side by side, CSV with time_s, then ax_g, vx_m_s and x_m (integral
 * of v_x) of reference and model. Errors: those of the simulation and of writing. */
CP_MUST_CHECK cp_status cp_pulse_validate(const cp_vehicle_model *model,
                                          const cp_pulse_source *source, const char *curves_path,
                                          cp_format format, cp_error *error);

#endif
