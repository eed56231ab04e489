/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_PAGE_DATA_H
#define REPORT_PAGE_DATA_H

#include "analysis/figures.h"

#include <jansson.h>

/* Frontal crashes drawn at most, in about; of more, a random sample by the study's seed (tables and
 * statistics use all). */
#define CP_PAGE_CRASHES_MAX 2500

/* Everything the page shows, as one JSON object: the study, a comparison with its answer,
 * distribution functions and pulse corridors for every choice of scenario and crash type, the
 * crashes to draw in columns, the assessment record, activations of functions, networks, single
 * crashes simulated again, risk functions, and the SQL. store: the database data was read from.
 * answer_all: the sentence over everything; the caller frees it and releases *page. */
CP_MUST_CHECK cp_status cp_page_data(cp_store *store, const cp_study_data *data, size_t baseline,
                                     const cp_comparison_options *options, json_t **page,
                                     char **answer_all, cp_error *error);

#endif
