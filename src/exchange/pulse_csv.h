/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_PULSE_CSV_H
#define EXCHANGE_PULSE_CSV_H

#include "exchange/pulse_record.h"

/* Pulses as tables: a first line names the columns, fields as in core/csv_row.h.
 *   time_s and at least one of ax_m_s2, vx_m_s; further the other columns of CP_PULSE_COLUMN
 *   vehicle: which one ("a", "b"); crash_id and treatment: of several crashes in one table, as
 *   exported; separation_s: last contact force; contact_side: where it is struck; the same in every
 *   row of a pulse
 * Other columns are passed over. Times rise in even steps of at most 0.01 s (to a hundredth of a
 * step and 1e-9 s); what lies before time 0 is passed over, and one sample is at 0. */

/* Read the pulse that the request names, completed (pulse_record.h): of the vehicle "a" unless it
 * names another. request->path names the file in messages; content is zero-terminated and written
 * to. The caller destroys the record. Errors: CP_BAD_INPUT with file, line and column;
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_pulse_csv_parse(const cp_pulse_request *request, char *content,
                                           cp_pulse_record *record, cp_error *error);

#endif
