/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/example_query.h"

#define EXAMPLE_QUERIES(X)                                                                         \
    X(exposure_and_rates)                                                                          \
    X(crash_rates)                                                                                 \
    X(crashes_above_severity)                                                                      \
    X(olc_quantiles)                                                                               \
    X(olc_distribution)                                                                            \
    X(olc_against_closing_speed)                                                                   \
    X(configuration_map)                                                                           \
    X(configuration_points)                                                                        \
    X(validity)                                                                                    \
    X(validity_classes)                                                                            \
    X(paired_replications)                                                                         \
    X(crash_sites)                                                                                 \
    X(counterfactual_outcomes)                                                                     \
    X(counterfactual_pairs)                                                                        \
    X(expected_injuries)                                                                           \
    X(pulses)                                                                                      \
    X(worst_crashes)                                                                               \
    X(reproducibility)

#define EMBEDDED(name) extern const unsigned char cp_query_##name[];
EXAMPLE_QUERIES(EMBEDDED)

const cp_example_query CP_EXAMPLE_QUERY[] = {
#define ROW(name) {#name, (const char *)cp_query_##name},
    EXAMPLE_QUERIES(ROW)};
const size_t CP_EXAMPLE_QUERY_COUNT = sizeof CP_EXAMPLE_QUERY / sizeof *CP_EXAMPLE_QUERY;
