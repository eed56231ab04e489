/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_DESCENT_JOURNAL_H
#define CALIBRATE_DESCENT_JOURNAL_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>

/* The descents of a search in their order, kept in a file, so that a search that was killed goes
 * on where it was: begun anew it asks for the same descents, and those that are known are not gone
 * again. A line a descent: evaluations, the value it began with, the point it came to; numbers in
 * hexadecimal, so that none loses a bit. */
typedef struct cp_descent_journal {
    char path[4096];
    size_t dimension;
    size_t count; /* of descents known */
    size_t next;  /* the one to be asked for next */
    double *row;  /* owned, as in the file: 2 + dimension numbers a descent */
} cp_descent_journal;

/* From the file at path if there is one, else empty. The caller closes, also after an error.
 * Errors: CP_BAD_INPUT with file and line, CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_descent_journal_open(cp_descent_journal *journal, const char *path,
                                                size_t dimension, cp_error *error);
/* The descent asked for next, if it is known: known says so, and point (dimension coordinates) is
 * where it came to. CP_BAD_INPUT: the one known had another budget or began with another value,
 * so the file is of another fit. */
CP_MUST_CHECK cp_status cp_descent_journal_recall(cp_descent_journal *journal, size_t evaluations,
                                                  double before, double *point, bool *known,
                                                  cp_error *error);
/* One more descent at the end, written at once. Errors: of the file, CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_descent_journal_add(cp_descent_journal *journal, size_t evaluations,
                                               double before, const double *point, cp_error *error);
void cp_descent_journal_close(cp_descent_journal *journal);

#endif
