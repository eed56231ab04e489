/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PULSE_OLC_H
#define PULSE_OLC_H

#include <stdbool.h>
#include <stddef.h>

/* Occupant load criterion (Kuebler, Gargallo, Elsaesser, ATZ 6/2009; Euro NCAP TB 027): a virtual
 * occupant flies free for 65 mm relative to the car, then decelerates constantly so that after a
 * further 235 mm it moves with the car. With s(t) = integral of (V0 - v):
 *   t1: s(t1) = 0.065 m
 *   t2: s(t2) - OLC/2 (t2 - t1)^2 = 0.300 m
 *   OLC = (V0 - v(t2)) / (t2 - t1)                                                              */
#define CP_OLC_FREE_FLIGHT_M 0.065
#define CP_OLC_TOTAL_M 0.300
#define CP_OLC_HORIZON_S 0.5

/* X(name, text in the database and in JSON). no_deceleration and beyond_0_5_s are left-censored:
 * below every value. */
#define CP_OLC_STATUSES(X)                                                                         \
    X(CP_OLC_VALUE, "value")                                                                       \
    X(CP_OLC_NOT_FRONT_CONTACT, "not_front_contact")                                               \
    X(CP_OLC_NO_DECELERATION, "no_deceleration")                                                   \
    X(CP_OLC_BEYOND_HORIZON, "beyond_0_5_s")                                                       \
    X(CP_OLC_SIMULATION_FAILED, "simulation_failed")

typedef enum cp_olc_status {
#define CP_OLC_STATUS_NAME(name, text) name,
    CP_OLC_STATUSES(CP_OLC_STATUS_NAME)
#undef CP_OLC_STATUS_NAME
} cp_olc_status;

typedef struct cp_olc {
    cp_olc_status status;
    double olc_g; /* NAN unless status is CP_OLC_VALUE */
    double t1_s;  /* NAN likewise */
    double t2_s;
} cp_olc;

const char *cp_olc_status_text(cp_olc_status status);

/* OLC of a longitudinal velocity record (accelerometer convention): count >= 2 samples at
 * interval_s from first contact, linear between samples, continued past its end at constant
 * velocity to at most 0.5 s. */
cp_olc cp_olc_from_velocity(const double *vx_m_s, size_t count, double interval_s);

/* Whether a record that ends at end_s decides the OLC found from it: it reaches t2, the horizon, or
 * beyond the last contact at separation_s (NAN: not known), after which the car coasts. Else the
 * continuation at constant velocity is a guess, and so is the OLC. */
bool cp_olc_is_decided(const cp_olc *olc, double end_s, double separation_s);

/* Standard deviation of several OLC of one crash, g; a left-censored one counts as 0 g. NAN for
 * fewer than two, or where one has failed. */
double cp_olc_sd(const cp_olc *olc, size_t count);

#endif
