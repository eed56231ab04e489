/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_PAIRED_POINTS_H
#define REPORT_PAIRED_POINTS_H

#include "analysis/study_data.h"

/* What a page draws of the pairs of a study, one by one.
 *
 * Counterfactual design, {"crash": columns}: one entry for each valid pair of a frontal baseline
 * crash whose drawn[crash] is true: variant, scenario, crash_type (indices), baseline_olc_g,
 * treated_olc_g (0 when avoided), outcome (word; by OLC).
 *
 * Paired seeds, {"seed": columns}: one entry for each replication, crash type and variant with
 * frontally struck vehicles of known OLC: variant, scenario, crash_type, number, then vehicles and
 * mean_olc_g over all of them and, suffix _inside, those inside validity. {"seeds": [n, …]} by
 * scenario: replications that ran in every variant.
 *
 * JSON null for independent seeds. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_paired_points_json(const cp_study_data *data, const bool *drawn,
                                              json_t **points, cp_error *error);

#endif
