/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_PULSE_METRICS_H
#define CLI_PULSE_METRICS_H

#include "cli/output.h"
#include "exchange/pulse_record.h"

/* Print what a pulse says: OLC, delta-v, peak, means, times, direction of force. JSON: one object;
 * CSV: one row; table: one line a figure. What the record does not tell is null, empty or "-". An
 * OLC that the record ends too early for is not given (olc_status record_ends_early), and a delta-v
 * that still grows at its end is said. Errors: CP_BAD_INPUT for a record too coarse for CFC60. */
CP_MUST_CHECK cp_status cp_pulse_metrics_print(const cp_pulse_record *record, cp_format format,
                                               FILE *file, cp_error *error);

#endif
