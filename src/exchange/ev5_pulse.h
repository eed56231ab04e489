/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_EV5_PULSE_H
#define EXCHANGE_EV5_PULSE_H

#include "exchange/nhtsa_ev5.h"
#include "exchange/pulse_record.h"

#include <stdbool.h>
#include <stddef.h>

/* The pulse of a car in a crash test: the mean of longitudinal accelerometers on its structure.
 * Taken are sensors AC on axis X with data status AM that belong to no occupant and sit on the
 * structure by their attachment (VECG, floor pan, sill, pillar, ...) or comment, not on the engine,
 * the brakes, doors, seats or the instrument panel, which move against it. */

/* Fill curve[0 ... *count) with the primary ones of a vehicle (its number; 0: the first that has
 * any), at most CP_PULSE_CURVES_MAX. Error: CP_BAD_INPUT when there is none. */
CP_MUST_CHECK cp_status cp_ev5_find_structure(const cp_ev5_test *test, int vehicle,
                                              int curve[CP_PULSE_CURVES_MAX], size_t *count,
                                              cp_error *error);

/* Mean of the curves, zero offsets removed. The caller destroys. Errors: CP_BAD_INPUT for a curve
 * that is no such sensor (with line and reason), curves of two vehicles, curves that are sampled
 * differently or begin after time 0. */
CP_MUST_CHECK cp_status cp_ev5_mean_of_structure(const cp_ev5_test *test, const int curve[],
                                                 size_t count, cp_ev5_channel *mean,
                                                 cp_error *error);

/* Speed at impact of the vehicle that a curve belongs to, m/s: its own record or, where that is
 * blank or 0 and it is the only vehicle, the closing speed. NAN: not told. */
double cp_ev5_speed_m_s(const cp_ev5_test *test, int curve);

/* Velocity from speed_m_s at time 0 on: vx_m_s[k] at sample k of the mean's from time 0 on, their
 * number is mean->first_sample + mean->sample_count. Error: CP_BAD_INPUT when the car only gets
 * faster (reversed polarity), unless may_gain. */
CP_MUST_CHECK cp_status cp_ev5_velocity(const cp_ev5_test *test, const int curve[], size_t count,
                                        const cp_ev5_channel *mean, double speed_m_s, bool may_gain,
                                        double *vx_m_s, cp_error *error);

/* "v10146.EV5, channels 93 and 94" */
void cp_ev5_describe(const cp_ev5_test *test, const int curve[], size_t count, char *text,
                     size_t size);

/* The pulse that a request names of a test (folder or EV5 file), completed. The caller destroys.
 * Errors: as above. */
CP_MUST_CHECK cp_status cp_ev5_pulse_read(const cp_pulse_request *request, cp_pulse_record *record,
                                          cp_error *error);

#endif
