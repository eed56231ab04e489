/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_ERROR_LOG_H
#define CONTROL_ERROR_LOG_H

#include "core/error.h"

#include <stddef.h>
#include <stdint.h>

/* When drivers erred, for as long as it may be asked: an error that ended just before a crash may
 * have led to it. */

#define CP_ERROR_MEMORY_S 5.0 /* an error is forgotten this long after its end */

/* other of an error that a driver makes whoever the other is. */
#define CP_EVERYBODY UINT32_MAX

/* One error of one driver; of several in a row the last. SUMO's clock, ends of steps. */
typedef struct cp_logged_error {
    size_t control; /* which driver error */
    uint32_t vehicle, other;
    double since_s;
    double until_s; /* last seen at work */
} cp_logged_error;

/* Zero-initialise, note, destroy. */
typedef struct cp_error_log {
    cp_logged_error *errors;
    size_t count, room;
    uint32_t *slots; /* hash table of index + 1; 0: empty */
    size_t slot_count;
    double tidy_at_s;
} cp_error_log;

/* An error is at work at the end of the step, now_s. Each step's are noted in any order, steps one
 * after another. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_error_log_note(cp_error_log *log, size_t control, uint32_t vehicle,
                                          uint32_t other, double now_s, double step_s,
                                          cp_error *error);
/* Forget what is too old; costs something only now and then. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_error_log_tidy(cp_error_log *log, double now_s, cp_error *error);
void cp_error_log_destroy(cp_error_log *log);

#endif
