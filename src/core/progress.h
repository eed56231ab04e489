/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_PROGRESS_H
#define CORE_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>

/* Progress of a long job on stderr: a bar with the time left on a terminal, else a plain line at
 * every tenth. Zero-initialise, begin, update as often as you like, end. */
typedef struct cp_progress {
    const char *label; /* borrowed; must outlive the progress */
    size_t total;
    size_t done;
    double started_s;
    bool terminal;
    int last_tenth;
} cp_progress;

void cp_progress_begin(cp_progress *progress, const char *label, size_t total);
/* detail may be NULL: short text behind the numbers, e.g. "123 crashes". */
void cp_progress_update(cp_progress *progress, size_t done, const char *detail);
void cp_progress_end(cp_progress *progress);

/* Monotonic clock, s. */
double cp_clock_s(void);

#endif
