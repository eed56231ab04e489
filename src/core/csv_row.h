/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_CSV_ROW_H
#define CORE_CSV_ROW_H

#include "core/error.h"

#include <stddef.h>

/* Rows of a CSV file of numbers and plain words, cut in place. A pair of quotes around a field is
 * left out; nothing is quoted within it. Decimal signs are points, whatever separates the fields.
 */

enum { CP_CSV_FIELDS_MAX = 32 };

/* Cut the first line off *rest, which moves to the next one or becomes NULL after the last.
 * Returns the line without its end. */
char *cp_csv_next_line(char **rest);

/* What separates the fields of a file with this header: ';' where it has one and no comma, as
 * spreadsheets write it in countries with a decimal comma, else ','. */
char cp_csv_separator(const char *header);

/* Cut a line into fields, the first room of them, without the blanks around them; returns how many
 * there are. */
size_t cp_csv_split(char *line, char separator, char **fields, size_t room);

/* Whether a row has as many fields as the file has columns, which are at most CP_CSV_FIELDS_MAX:
 * one more or less shifts numbers into other columns. Error: CP_BAD_INPUT with file and line. */
CP_MUST_CHECK cp_status cp_csv_check_fields(const char *path, size_t line_number, size_t count,
                                            size_t header, cp_error *error);

#endif
