/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_FALSE_ACTIVATIONS_H
#define ANALYSIS_FALSE_ACTIVATIONS_H

#include "store/store.h"

#include <jansson.h>

/* How often functions act, and how often without a driver error, by scenario (network) and variant,
 * from the counters of the finished replications.
 *
 * [{"scenario", "variant", "function", "has_errors", "vehicle_h", "activations", "per_1000_h",
 * "low", "high", "without_error", "without_error_per_1000_h", "without_error_low",
 * "without_error_high"}]: rates per 1000 hours of all vehicles, with or without the function;
 * has_errors: the scenario has driver errors; 95 % intervals by cp_rate_widened over replications.
 * The last four are null where an earlier version has not counted it. Empty where no function acts
 * in whole traffic (counterfactual pairs, records of finished runs). The caller releases it.
 * Errors: those of the store, CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_false_activations_json(cp_store *store, json_t **rows, cp_error *error);

#endif
