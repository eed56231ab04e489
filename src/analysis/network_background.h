/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_NETWORK_BACKGROUND_H
#define ANALYSIS_NETWORK_BACKGROUND_H

#include "store/store.h"

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

/* What the networks of a study do without any driver error or function, in words: the view
 * background_by_scenario. */

typedef struct cp_network_background {
    char *scenario;
    bool is_known;      /* it was simulated */
    bool is_negligible; /* at most 5 % of the baseline's crashes, by the upper bound of the exact 95
                           % interval of what was found */
    char *text;         /* "0 crashes and 12 other contacts (graze 10, clipped_waiting 2) in 45.2
                           vehicle-hours" */
    char *warning; /* "... of the baseline's 55 crashes are the network's doing", or may be; NULL if
                      negligible or not known */
} cp_network_background;

typedef struct cp_network_backgrounds {
    cp_network_background *row; /* one a scenario, in their order */
    size_t count;
    size_t known;
    bool is_assessment; /* nothing was simulated: there is no network */
} cp_network_backgrounds;

/* scenario: this one only; NULL: all. The caller destroys them, also after an error. Errors: those
 * of the store, CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_network_backgrounds_read(cp_store *store, const char *scenario,
                                                    cp_network_backgrounds *backgrounds,
                                                    cp_error *error);
void cp_network_backgrounds_destroy(cp_network_backgrounds *backgrounds);

/* All of it as one paragraph, warnings included; "" for an assessment. UTF-8; the caller frees.
 * Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_network_backgrounds_paragraph(const cp_network_backgrounds *backgrounds,
                                                         char **paragraph, cp_error *error);

/* [{"scenario", "is_known", "is_negligible", "text", "warning"}]; NULL when memory is gone. */
json_t *cp_network_backgrounds_json(const cp_network_backgrounds *backgrounds);

#endif
