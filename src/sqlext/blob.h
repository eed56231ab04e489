/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef SQLEXT_BLOB_H
#define SQLEXT_BLOB_H

#include "pulse/pulse.h"

#include <sqlite3ext.h>

/* Pulse blobs as arguments. */

/* Unpack values[0], or values[0 ... 3] = samples, codec, sample_interval_s, sample_count. The
 * caller destroys the pulse. Errors: CP_BAD_INPUT for another type or a damaged blob. */
CP_MUST_CHECK cp_status cp_sqlext_decode(int count, sqlite3_value **values, cp_pulse *pulse,
                                         cp_error *error);

/* "function: error" as the result of a function. */
void cp_sqlext_fail(sqlite3_context *context, const char *function, const cp_error *error);

#endif
