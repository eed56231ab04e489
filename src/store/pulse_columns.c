/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/pulse_columns.h"

#include "pulse/pulse_codec.h"

cp_status cp_pulse_of_columns(const cp_statement *statement, int first, cp_pulse *pulse,
                              cp_error *error)
{
    sqlite3_stmt *row = statement->handle;
    return cp_pulse_decode(sqlite3_column_int(row, first), sqlite3_column_blob(row, first + 1),
                           (size_t)sqlite3_column_bytes(row, first + 1),
                           sqlite3_column_int64(row, first + 2),
                           sqlite3_column_double(row, first + 3), pulse, error);
}
