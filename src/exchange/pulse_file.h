/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_PULSE_FILE_H
#define EXCHANGE_PULSE_FILE_H

#include "exchange/pulse_record.h"

/* Read the pulse that a request names from whatever it is: the folder or EV5 file of an NHTSA test,
 * the folder, .mme file or channel file of an ISO-MME test, an LS-DYNA keyword file, a table (CSV).
 * The caller destroys the record. Errors: those of the readers; CP_BAD_INPUT for a folder that is
 * neither and for a database, whose crash must be named. */
CP_MUST_CHECK cp_status cp_pulse_file_read(const cp_pulse_request *request, cp_pulse_record *record,
                                           cp_error *error);

/* Whether a file begins as SQLite's databases do. */
bool cp_pulse_file_is_database(const char *path);

#endif
