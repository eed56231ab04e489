/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_REPORT_H
#define REPORT_REPORT_H

#include "store/store.h"

#include <jansson.h>

/* Write the report of a study: one HTML file that needs nothing else. baseline: name of the variant
 * to compare with, NULL for the study's own. controls: defaults of every driver error and function,
 * {"aeb": {"what": in words, "parameters": {"ttc_s": 1.2, …}}, …}, borrowed; NULL: not known.
 * Errors: CP_BAD_INPUT for a database without a study, without finished replications or without
 * that variant; those of the store; CP_IO_FAILED. */
CP_MUST_CHECK cp_status cp_report_write(cp_store *store, const char *baseline, json_t *controls,
                                        const char *path, cp_error *error);

#endif
