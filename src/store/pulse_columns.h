/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_PULSE_COLUMNS_H
#define STORE_PULSE_COLUMNS_H

#include "pulse/pulse.h"
#include "store/store_sqlite.h"

/* How a query asks for a stored pulse, and what it then reads; for the files of this folder only.
 */
#define CP_PULSE_COLUMNS "codec, samples, sample_count, sample_interval_s"

/* Unpack the pulse whose CP_PULSE_COLUMNS stand in the statement's row from column first on. The
 * caller destroys it. Errors: CP_BAD_INPUT for a damaged one; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_pulse_of_columns(const cp_statement *statement, int first,
                                            cp_pulse *pulse, cp_error *error);

#endif
