/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_REFERENCE_PULSE_H
#define CALIBRATE_REFERENCE_PULSE_H

#include "calibrate/reference.h"

#include <stdbool.h>
#include <stddef.h>

/* Crash pulses a vehicle model is held against: of a real test (EV5 folder) or a file of the form
 * `crashpulse crash --pulse` writes. */

enum { CP_PULSE_SENSORS_MAX = 8 }; /* CP_PULSE_CURVES_MAX of exchange */

/* What a pulse shows at a glance; NAN: it does not. */
typedef struct cp_pulse_marks {
    double olc_g;
    double t_v0_s;  /* first v_x <= 0 */
    double peak_g;  /* largest -a_x, CFC60 */
    double crush_m; /* largest integral of v_x */
} cp_pulse_marks;

typedef struct cp_reference_pulse {
    char source[256]; /* "v10146.EV5, channels 93 and 94" */
    char hash[65];    /* SHA-256 of its file; of all its files' hashes for an EV5 folder */
    cp_reference_case condition; /* olc_g: that of the marks, 0 where there is none */
    double weight_1;             /* > 0, share in a fit */
    double until_s;              /* compared from first contact to here */
    bool lateral;                /* a_y and v_y were measured */
    double interval_s;
    size_t count;         /* of samples compared */
    double *ax_g;         /* owned, CFC60; the other three lie behind it */
    double *ay_g;         /* zeros unless lateral */
    double *vx_m_s;       /* accelerometer convention */
    double *vy_m_s;       /* zeros unless lateral */
    cp_pulse_marks marks; /* of the whole record */
} cp_reference_pulse;

/* Where a pulse comes from. */
typedef struct cp_pulse_source {
    const char *path; /* file, or EV5 folder (or EV5 file) when there are sensors */
    size_t sensor_count;
    int sensor[CP_PULSE_SENSORS_MAX]; /* curve numbers; the pulse is their mean */
    double speed_km_h;                /* NAN: the one recorded */
    double offset_mm;                 /* of the barrier */
    double angle_deg;
    double until_s; /* NAN: to the end of the record */
    double weight_1;
} cp_pulse_source;

/* Read one pulse. From an EV5 folder: the mean of longitudinal accelerometers with their zero
 * offsets removed, v_x the recorded speed and its integral from time 0 on; no lateral motion. From
 * a file: columns time_s (from 0 on, even steps), ax_m_s2 (taken as CFC60), vx_m_s and, where
 * present, ay_m_s2 and vy_m_s; of a column vehicle only rows "a". The caller destroys. Errors:
 * CP_BAD_INPUT with file, line and column or field; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_reference_pulse_load(const cp_pulse_source *source,
                                                cp_reference_pulse *pulse, cp_error *error);
void cp_reference_pulse_destroy(cp_reference_pulse *pulse);

/* Value of count samples at interval_s, linear between them; after the last: that one. */
double cp_samples_at(const double *values, size_t count, double interval_s, double time_s);

#endif
