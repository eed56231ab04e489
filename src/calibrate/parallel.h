/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_PARALLEL_H
#define CALIBRATE_PARALLEL_H

#include "core/error.h"

#include <stddef.h>

/* Independent crash simulations spread over threads. */

/* Does number index of the work and keeps what comes out in a place of its own, so that the result
 * does not depend on who does it when. What is a result too, as a crash that cannot be simulated,
 * is kept there and CP_OK; CP_NO_MEMORY: no result of the whole work is worth anything. */
typedef cp_status (*cp_parallel_job)(void *context, size_t index);

/* Call job for 0..count on threads threads (1 to 64), this one among them; returns when all are
 * done. cp_crash_library_begin must have been called. Errors: CP_BAD_INPUT for threads,
 * CP_RUN_FAILED when a thread could not run; CP_NO_MEMORY of a job. */
CP_MUST_CHECK cp_status cp_parallel_simulate(size_t count, int threads, cp_parallel_job job,
                                             void *context, cp_error *error);

#endif
