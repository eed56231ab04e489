/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_SIGNALS_H
#define RUN_SIGNALS_H

#include "core/error.h"

#include <signal.h>
#include <stdbool.h>

/* SIGCHLD, SIGINT and SIGTERM as data, between begin and end: nothing happens behind the caller's
 * back. */
typedef struct cp_signals {
    int descriptor; /* -1: not begun */
    sigset_t old_mask;
} cp_signals;

#define CP_SIGNALS_NONE ((cp_signals){.descriptor = -1})

/* Error: CP_IO_FAILED. */
CP_MUST_CHECK cp_status cp_signals_begin(cp_signals *signals, cp_error *error);
void cp_signals_end(cp_signals *signals); /* not begun is fine */

/* Sleep until one comes or longest_s are over. *interrupted is set by SIGINT and SIGTERM, and left
 * as it is otherwise. Error: CP_IO_FAILED. */
CP_MUST_CHECK cp_status cp_signals_wait(cp_signals *signals, double longest_s, bool *interrupted,
                                        cp_error *error);

#endif
