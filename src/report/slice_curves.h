/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_SLICE_CURVES_H
#define REPORT_SLICE_CURVES_H

#include "analysis/corridor.h"
#include "analysis/figures.h"

/* What a page draws of a slice as curves, besides its comparison. */

/* What all slices have in common. */
typedef struct cp_slice_curves {
    const cp_study_data *data;
    const cp_comparison_options *options;
    const cp_corridor_pulses *pulses;
    unsigned char *chosen; /* room for one mark a vehicle and treated vehicle */
} cp_slice_curves;

/* Add to the JSON object of a comparison:
 *
 * to each of "variants": "ecdf" (of OLC, g) and "ecdf_delta_v_km_h", each {"all": {"x": […],
 * "share": […], "n", "censored"}, "inside": …}; "corridor" likewise,
 * {"n", "p10": […], "p50": […], "p90": […]} (analysis/corridor.h).
 *
 * counterfactual design: "judged": {"all": {"crashes", "left_out", "variants": [{"variant",
 * "avoided", "olc": curve, "delta_v": curve}]}, "inside": …} (judged.h), curve = {"ecdf",
 * "ecdf_band_half_width_1", "x", "crashes", "per_million_km", "low", "high"}, delta-v in km/h; and
 * "treated": [{"variant", "corridor"}].
 *
 * "convergence": {"what", "series": [{"variant", "replications": […], "value", "low", "high"}]}.
 *
 * Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_slice_curves_add(const cp_slice_curves *curves,
                                            const cp_comparison *comparison, json_t *object,
                                            cp_error *error);

#endif
