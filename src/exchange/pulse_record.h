/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_PULSE_RECORD_H
#define EXCHANGE_PULSE_RECORD_H

#include "pulse/pulse.h"

#include <stdbool.h>
#include <stddef.h>

/* The crash pulse of one vehicle as a file tells it, whatever the format: in our axes (ISO 8855, y
 * to the left) and SI units, sample 0 at first contact. */

enum { CP_PULSE_CURVES_MAX = 8 };

typedef struct cp_pulse_record {
    char source[256];             /* "v10146.EV5, channels 93 and 94" */
    char vehicle[32];             /* which one of the file: "a", "1"; "": there is one only */
    cp_pulse pulse;               /* owned; channels that are not known are zero */
    bool known[CP_CHANNEL_COUNT]; /* told by the file, or following from what it tells */
    double separation_s;          /* last contact force; NAN: not told */
    bool against_car;             /* the other vehicle is in the file too */
    char side[8];                 /* struck on its "front", "left", "right", "rear"; "": not told */
    double mass_kg;               /* NAN: not told */
} cp_pulse_record;

/* Which pulse of a file. Zero-initialise, then cp_pulse_request_default. */
typedef struct cp_pulse_request {
    const char *path;
    const char *vehicle;   /* role or number; NULL: the first */
    const char *crash_id;  /* of an exported table of several crashes; NULL: the only one */
    const char *treatment; /* likewise */
    size_t curve_count; /* measured curves (EV5: numbers; LS-DYNA: ids) whose mean is taken; 0: */
    int curve[CP_PULSE_CURVES_MAX]; /* those that are the car's */
    double speed_m_s;               /* at first contact; NAN: as told by the file */
    const char *code;               /* ISO-MME: channel code of the longitudinal acceleration */
    const char *units;              /* of LS-DYNA curves of others; NULL: told by the file */
    bool is_reversed;               /* accelerometers mounted the other way round */
    bool may_gain;                  /* the car may be accelerated: struck from behind */
    bool is_acceleration;           /* of LS-DYNA curves of others: accelerations, not velocities */
    bool needs_both;                /* a_x and v_x must be told, none is made from the other */
} cp_pulse_request;

cp_pulse_request cp_pulse_request_default(const char *path);

/* Take over a side that a file tells into record->side; false for any other word. */
bool cp_pulse_record_take_side(cp_pulse_record *record, const char *side);

/* A zero-initialised or destroyed record is fine too. */
void cp_pulse_record_destroy(cp_pulse_record *record);

/* Fill in what follows: velocities from accelerations and the speed at first contact, or
 * accelerations from velocities (central differences); lateral ones likewise, v_y from 0. Errors:
 * CP_BAD_INPUT when neither a_x nor v_x is known, no speed is known for a_x alone, a_x and v_x do
 * not go together (a wrong unit or polarity: differing by more than a tenth of the change of
 * velocity and 1 m/s), a speed is above 150 m/s, or an a_x alone makes the car faster and the
 * request does not allow that. */
CP_MUST_CHECK cp_status cp_pulse_record_complete(cp_pulse_record *record,
                                                 const cp_pulse_request *request, cp_error *error);

#endif
