/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_COMPARISON_JSON_H
#define REPORT_COMPARISON_JSON_H

#include "analysis/figures.h"

#include <jansson.h>

/* A comparison as JSON, the same for `crashpulse compare --format json` and for reports:
 * {"scenario": name or null, "crash_type": name or null, "baseline": name, "variants": [...],
 * "contrasts": [...]}. An estimate is null or {"relation": "=", "<" or ">", "value": x}; an
 * interval as of cp_interval_json. The caller releases
 * it; NULL when memory is gone. */
json_t *cp_comparison_json(const cp_study_data *data, const cp_comparison *comparison);

#endif
