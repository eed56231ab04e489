/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_OWNER_H
#define RUN_OWNER_H

#include "store/claim.h"

/* Who holds a claim, and whether it still lives. */

/* This process. Errors: CP_IO_FAILED when /proc does not tell. */
CP_MUST_CHECK cp_status cp_owner_self(cp_owner *owner, cp_error *error);

/* Whether the process that made a claim still runs: same host, same pid, same start. Owners on
 * other hosts cannot be asked and count as alive. */
bool cp_owner_is_alive(const cp_owner *owner);

#endif
