/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_STORED_PULSE_H
#define STORE_STORED_PULSE_H

#include "pulse/pulse.h"
#include "store/store.h"

#include <stdbool.h>
#include <stdint.h>

/* The stored pulse of a vehicle (role "a", "b") of a crash: as it happened (variant NULL), or of
 * what a baseline's crash became under the treatment called variant. *there is false, and pulse
 * empty, when none is stored. The caller destroys pulse. Errors: those of the store; CP_BAD_INPUT
 * for a damaged pulse. */
CP_MUST_CHECK cp_status cp_stored_pulse_read(cp_store *store, int64_t crash_id, const char *variant,
                                             const char *role, cp_pulse *pulse, bool *there,
                                             cp_error *error);

#endif
