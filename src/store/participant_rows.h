/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_PARTICIPANT_ROWS_H
#define STORE_PARTICIPANT_ROWS_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>

/* What the drivers of two crashed cars did wrong and what their functions did, as rows of
 * crash_driver_error and crash_function (db/schema/012_cause_and_place.sql says what they mean).
 * Texts are static, times are before contact. */

typedef struct cp_driver_error_row {
    int role;            /* 0 = a, 1 = b */
    size_t number;       /* among the scenario's driver errors */
    const char *name;    /* failed_to_see, lane_drift, ... */
    const char *towards; /* everybody, opponent, another */
    double began_s;      /* >= ended_s */
    double ended_s;      /* >= 0; 0: at work at contact */
    bool is_cause;
} cp_driver_error_row;

typedef struct cp_function_row {
    int role;
    size_t number;    /* among the functions of the variant */
    const char *name; /* aeb, fcw, ... */
    const char
        *state; /* not_equipped, idle, limiting, warned, requested, braking, steering, released */
    double warned_s; /* NAN, as all that follow: not so */
    double requested_s;
    double braking_s;
    double steering_s;
    double released_s;
    double brake_request_m_s2;
    double deceleration_m_s2;
    double speed_taken_off_m_s;
} cp_function_row;

/* Of one crash. Zero-initialised: nothing is known of it. */
typedef struct cp_participant_rows {
    bool is_known;
    cp_driver_error_row *error; /* owned, as the next; in order of role and number */
    size_t error_count;
    cp_function_row *function;
    size_t function_count;
} cp_participant_rows;

void cp_participant_rows_destroy(cp_participant_rows *rows);

/* Fill rows, zeroed before, with those of another crash, roles changed where swapped. Error:
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_participant_rows_copy(const cp_participant_rows *from, bool swapped,
                                                 cp_participant_rows *rows, cp_error *error);

#endif
