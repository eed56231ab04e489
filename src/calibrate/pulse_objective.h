/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_PULSE_OBJECTIVE_H
#define CALIBRATE_PULSE_OBJECTIVE_H

#include "calibrate/reference_pulse.h"
#include "crash/crash_simulation.h"

/* How far a vehicle model's pulses lie from reference pulses, against its own barrier: the "total
 * error" of "A physics-based fast-running surrogate model for crash pulse prediction" (ESV
 * conference), the sum of five mean absolute errors (MAE),
 *   MAE a_x + MAE a_y + 10 MAE v_x + 10 MAE v_y + MAE of the time where v_x reaches zero,
 * a in g (CFC60), v in m/s, time in s (the source does not give its units), over the samples of
 * the reference. What a reference has not measured (a_y and v_y of a longitudinal sensor) does not
 * count. A pulse whose v_x does not reach zero counts as reaching it at the end of the stretch
 * compared. */
typedef struct cp_pulse_error {
    double total; /* NAN: the crash could not be simulated, as all below */
    double ax_g;
    double ay_g; /* 0 unless the reference is lateral, as the next but one */
    double vx_m_s;
    double vy_m_s;
    double t_v0_s;
    cp_pulse_marks model; /* of the model's pulse; olc_g is NAN where it is left-censored */
} cp_pulse_error;

/* The model's pulse in the condition of a reference, raw, at least to its until_s. The caller
 * destroys. Errors: those of the simulation. */
CP_MUST_CHECK cp_status cp_reference_pulse_simulate(const cp_vehicle_model *model,
                                                    const cp_reference_pulse *reference,
                                                    double time_step_s, cp_crash_result *result,
                                                    cp_error *error);

/* A pulse's misfits with their sign, for a search that goes by slopes: mean difference model minus
 * reference over each of equal stretches of time, of a_x and a_y in g, then of v_x and v_y in
 * m/s times their weight in the total error; a_y and v_y 0 unless the reference is lateral. */
enum { CP_PULSE_STRETCHES = 30, CP_PULSE_MISFITS = 4 * CP_PULSE_STRETCHES };

/* Compare a simulated crash with a reference; misfit (CP_PULSE_MISFITS values) may be NULL.
 * Errors: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_pulse_compare(const cp_reference_pulse *reference,
                                         const cp_crash_result *result, cp_pulse_error *found,
                                         double *misfit, cp_error *error);

/* errors[k] of pulses[0..count), and CP_PULSE_MISFITS of each in misfits unless that is NULL (NAN
 * of one that failed), simulated on threads threads; the result does not depend on threads.
 * cp_crash_library_begin must have been called. Errors: CP_BAD_INPUT for threads, CP_RUN_FAILED. */
CP_MUST_CHECK cp_status cp_objective_pulse(const cp_vehicle_model *model,
                                           const cp_reference_pulse *pulses, size_t count,
                                           double time_step_s, int threads, cp_pulse_error *errors,
                                           double *misfits, cp_error *error);

/* Weighted mean total error over the pulses whose use[k] is true (NULL: all). One that failed
 * counts as penalty. */
double cp_objective_pulse_mean(const cp_reference_pulse *pulses, const cp_pulse_error *errors,
                               size_t count, const bool *use, double penalty);

#endif
