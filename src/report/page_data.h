/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_PAGE_DATA_H
#define REPORT_PAGE_DATA_H

#include "report/comparison.h"

#include <jansson.h>

/* Vehicles drawn at most; of more, every k-th is drawn (tables and statistics use all). */
#define CP_PAGE_VEHICLES_MAX 50000

/* Everything the page shows, as one JSON object: the study, a comparison with its answer for every
 * choice of scenario and crash type, the vehicles to draw in columns, and the SQL. answer_all: the
 * sentence over everything; the caller frees it and releases *page. */
CP_MUST_CHECK cp_status cp_page_data(const cp_study_data *data, size_t baseline,
                                     const cp_comparison_options *options, json_t **page,
                                     char **answer_all, cp_error *error);

/* JSON text that may stand in a script element: every <, >, & and character beyond ASCII is
 * escaped. The caller frees; NULL when memory is gone. */
char *cp_page_data_text(const json_t *page);

#endif
