/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_CAVEATS_H
#define ANALYSIS_CAVEATS_H

#include "store/store.h"

#include <jansson.h>
#include <stddef.h>

/* What is not as the study's plan would have one think, a sentence each: replications that failed
 * (those that SUMO ended are not missing at random), traffic that ended before duration_s, driver
 * errors that never acted, crashes where the network crashes by itself, with the rates without
 * them. */

typedef struct cp_caveats {
    char **sentence; /* without a full stop, names made plain */
    size_t count;
} cp_caveats;

/* scenario: of this one only; NULL: of all. The caller destroys them, also after an error. Errors:
 * those of the store, CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_caveats_read(cp_store *store, const char *scenario, cp_caveats *caveats,
                                        cp_error *error);
void cp_caveats_destroy(cp_caveats *caveats);

/* All as one paragraph, "" when there is none; the caller frees. NULL when memory is gone. */
char *cp_caveats_paragraph(const cp_caveats *caveats);

/* A list of texts; NULL when memory is gone. */
json_t *cp_caveats_json(const cp_caveats *caveats);

#endif
