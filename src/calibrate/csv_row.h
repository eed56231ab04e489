/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_CSV_ROW_H
#define CALIBRATE_CSV_ROW_H

#include <stddef.h>

/* Rows of a CSV file of numbers and plain words, cut in place: no quotes. */

enum { CP_CSV_FIELDS_MAX = 32 };

/* Cut the first line off *rest, which moves to the next one or becomes NULL after the last.
 * Returns the line without its end. */
char *cp_csv_next_line(char **rest);

/* Cut a line into at most room fields; returns how many there are. */
size_t cp_csv_split(char *line, char **fields, size_t room);

#endif
