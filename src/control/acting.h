/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_ACTING_H
#define CONTROL_ACTING_H

#include "core/error.h"

#include <stdbool.h>

/* Who of the libraries that a study brings along is at work: so that the end of the process, by a
 * signal, an exit or a loop without end, has a name. The note is in memory that all forks of the
 * process share: the original can tell whom a branch died of. */

/* Begin to watch: signals that end a process, exit, and, in the process that calls cp_acting_limit,
 * calls that take too long. The text of what happened goes to report_fd, when that is open, else to
 * stderr. Once a process; again changes nothing. Errors: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_acting_watch(int report_fd, cp_error *error);

/* A call may take limit_s of wall clock, > 0, from now on, in this process. Errors: CP_RUN_FAILED.
 * Needs cp_acting_watch. */
CP_MUST_CHECK cp_status cp_acting_limit(double limit_s, cp_error *error);

/* Around each call: name of the function, its library, for whom ("vehicle 'b'") and when; time_s
 * NAN: no time. Without cp_acting_watch they do nothing. */
void cp_acting_enter(const char *name, const char *library, const char *whom, double time_s);
void cp_acting_leave(void);

/* A call failed as told: for the process that forked this one. */
void cp_acting_failed(const char *text);

/* After forks of this process have ended: what one of them failed or died of within a library, NULL
 * when nothing like that happened. Valid until the next call of it. */
const char *cp_acting_told(void);

#endif
