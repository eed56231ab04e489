/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_PULSE_INPUT_H
#define CLI_PULSE_INPUT_H

#include "cli/args.h"
#include "exchange/pulse_record.h"

#include <stdint.h>

/* Options that say which pulse of a file or database is meant, for the commands that take one. */

typedef struct cp_pulse_input {
    cp_pulse_request request; /* path: the file or database */
    int64_t crash_id;         /* -1: not given */
    char crash_text[32];      /* the same as text */
} cp_pulse_input;

cp_pulse_input cp_pulse_input_default(void);

/* --vehicle, --crash, --treatment, --channels, --code, --speed, --reversed, --struck-from-behind,
 * --units, --acceleration as a child parser; its input is a cp_pulse_input*. */
extern const struct argp CP_PULSE_INPUT_ARGS;

/* Read the pulse: of a database the stored one of the crash, else of the file. The caller destroys.
 * Errors: those of the readers; CP_BAD_INPUT for a database without --crash, or a crash that is not
 * there or has no pulse. */
CP_MUST_CHECK cp_status cp_pulse_input_read(const cp_pulse_input *input, cp_pulse_record *record,
                                            cp_error *error);

#endif
