/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_NHTSA_EV5_H
#define EXCHANGE_NHTSA_EV5_H

#include "core/error.h"

#include <stddef.h>

/* Crash tests as the NHTSA Vehicle Crash Test Database publishes them ("EV5 ASCII X-Y"): a folder
 * with <test>.EV5, sections "----- NAME -----" of records with '|' between their fields, and one
 * file <test>.NNN a measured curve: two columns, time in s and value in the record's unit. */

enum { CP_EV5_VEHICLES_MAX = 2 };

typedef struct cp_ev5_vehicle {
    int number;      /* as the instrumentation records name it */
    double mass_kg;  /* as tested */
    double length_m; /* 0 where the record leaves it open, as the next two */
    double width_m;
    double cg_behind_front_axle_m;
    double speed_m_s; /* at impact */
} cp_ev5_vehicle;

/* One measured curve, as its record describes it. */
typedef struct cp_ev5_instrument {
    size_t line; /* of the record in the EV5 file */
    int vehicle; /* number; 0: the barrier */
    int curve;   /* number of the curve, its "channel": file <test>.<curve, three digits> */
    char sensor[8];
    char position[8]; /* seat of the occupant it belongs to; "NA" or empty: the car's own */
    char attachment[16];
    char axis[8];
    char unit[8]; /* of the values: "G'S", "NWT", "NWM", "MM", "KPH", "DPS" */
    long first_sample;
    long last_sample;
    double interval_s;
    char status[8]; /* "AM" as measured, "CF" channel failed, "NO" no data */
    char rank[4];   /* "P" primary, "R" redundant */
    char comment[96];
} cp_ev5_instrument;

typedef struct cp_ev5_test {
    char *path;    /* owned: the EV5 file */
    char name[64]; /* its name without ".EV5": "v10146" */
    char title[128];
    char date[32];
    char laboratory_reference[32];
    double closing_speed_m_s;
    size_t vehicle_count;
    cp_ev5_vehicle vehicle[CP_EV5_VEHICLES_MAX];
    size_t instrument_count;
    cp_ev5_instrument *instrument; /* owned */
} cp_ev5_test;

/* Samples of one curve in SI units (m/s^2, N, N m, m, m/s, rad/s), the zero offset removed: the
 * mean over the last 40 ms before time 0, or as much of them as was recorded; nothing where the
 * record begins at 0 or later. Sample k is at (first_sample + k) * interval_s. */
typedef struct cp_ev5_channel {
    long first_sample;
    size_t sample_count;
    double interval_s;
    double *value;      /* owned */
    double zero_offset; /* what was removed, SI */
} cp_ev5_channel;

/* Read the records of a test: folder with exactly one EV5 file, or that file itself. The caller
 * destroys. Errors: CP_BAD_INPUT with file, line and field; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_ev5_load(const char *folder, cp_ev5_test *test, cp_error *error);
void cp_ev5_destroy(cp_ev5_test *test);

/* Record of a curve, NULL where the test has none of that number. */
const cp_ev5_instrument *cp_ev5_find(const cp_ev5_test *test, int curve);

/* Path of a curve's file; the caller frees. NULL when memory is gone. */
char *cp_ev5_curve_path(const cp_ev5_test *test, int curve);

/* Read a curve. The caller destroys. Errors: CP_BAD_INPUT with file, line and column where a value
 * is no number, times do not follow the record's interval, or samples are missing; for a curve the
 * test does not have or whose record says "NO" data, and for a unit this reader does not know. */
CP_MUST_CHECK cp_status cp_ev5_channel_load(const cp_ev5_test *test, int curve,
                                            cp_ev5_channel *channel, cp_error *error);
void cp_ev5_channel_destroy(cp_ev5_channel *channel);

#endif
