/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_ASSESSMENT_RECORD_H
#define REPORT_ASSESSMENT_RECORD_H

#include "analysis/study_data.h"

/* The items of an assessment record with what the study's author said of each
 * (store/assessment_items.h), read from the study file as it is stored:
 *
 *   [{"key": "target_population", "title": …, "says": what it should say, "text": … or null}, …]
 *
 * A stored text that is no YAML says nothing, with a warning. The caller releases it. Error:
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_assessment_record_json(const cp_study_data *data, json_t **items,
                                                  cp_error *error);

#endif
