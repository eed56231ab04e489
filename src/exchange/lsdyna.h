/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_LSDYNA_H
#define EXCHANGE_LSDYNA_H

#include "exchange/pulse_record.h"

#include <stddef.h>
#include <stdio.h>

/* Pulses as load curves of LS-DYNA (*DEFINE_CURVE_TITLE: title, card LCID SIDR SFA SFO OFFA OFFO in
 * fields of 10 columns, points in two fields of 20 columns): motion against time, for sled and
 * occupant models. Titles of ours tell the rest: "crashpulse vehicle a v_x" and so on, a comment in
 * front the system of units and the last contact. */

/* A consistent system of units: what one of ours is in it. */
typedef struct cp_unit_system {
    const char *name; /* "mm-ms-kg", "m-s-kg", "mm-s-t" */
    double length;    /* units of length in a metre */
    double time;      /* units of time in a second */
} cp_unit_system;

/* NULL: none of that name. CP_UNIT_SYSTEMS_TEXT lists them. */
const cp_unit_system *cp_unit_system_find(const char *name);
#define CP_UNIT_SYSTEMS_TEXT "mm-ms-kg, m-s-kg, mm-s-t"

/* Write the known channels of a vehicle's pulse, one curve each, with ids from first_id on;
 * *next_id is the one behind. role: "a", "b". */
void cp_lsdyna_write(FILE *file, const cp_pulse_record *record, const char *role,
                     const cp_unit_system *units, long first_id, long *next_id);
/* What stands before the curves, title in it as a comment; and behind them. */
void cp_lsdyna_begin(FILE *file, const char *title, const cp_unit_system *units);
void cp_lsdyna_end(FILE *file);

/* Read the pulse that a request names. Curves of ours are known by their titles. Of other files one
 * curve is taken (request->curve[0], or the only one) as a velocity or, with is_acceleration in the
 * request, an acceleration in request->units. path names the file in messages; content is
 * zero-terminated and written to. Points must be at even times, one at 0. The caller destroys the
 * record. Errors: CP_BAD_INPUT with file and line; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_lsdyna_parse(const cp_pulse_request *request, char *content,
                                        cp_pulse_record *record, cp_error *error);

#endif
