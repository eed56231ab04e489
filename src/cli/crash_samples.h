/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_CRASH_SAMPLES_H
#define CLI_CRASH_SAMPLES_H

#include "cli/crash_run.h"
#include "cli/output.h"

/* What parameter scatter makes of a crash: the same speeds, offset and angle with cars drawn about
 * their vehicle files (crash/parameter_scatter.h). Sample number k is the same crash whatever N. */

#define CP_SAMPLED_QUANTITIES(X)                                                                   \
    X(CP_SAMPLED_OLC, "olc_g", "OLC, g")                                                           \
    X(CP_SAMPLED_DELTA_V, "delta_v_km_h", "delta-v, km/h")                                         \
    X(CP_SAMPLED_PEAK, "peak_g", "peak, CFC60, g")

typedef enum cp_sampled_quantity {
#define CP_SAMPLED_NAME(name, text, label) name,
    CP_SAMPLED_QUANTITIES(CP_SAMPLED_NAME)
#undef CP_SAMPLED_NAME
        CP_SAMPLED_COUNT
} cp_sampled_quantity;

typedef struct cp_crash_samples {
    size_t asked_for;
    uint64_t seed;
    size_t missed;  /* drawn cars that pass each other: not among the values */
    size_t redrawn; /* cars drawn again because their parameters did not fit together */
    /* Values of each vehicle; -INFINITY: left-censored (no OLC because the deceleration is too low
     * or too slow). OLC of the samples struck on their front only. */
    size_t count[2][CP_SAMPLED_COUNT];
    double *value[2][CP_SAMPLED_COUNT]; /* owned */
} cp_crash_samples;

/* Draw and crash. nominal: the run with the files' own values. path: of each vehicle file, for the
 * message. Errors: CP_BAD_INPUT when no parameter of either vehicle has scatter; what a sample
 * meets, with its number. The caller destroys, also after an error. */
CP_MUST_CHECK cp_status cp_crash_samples_run(const cp_crash_request *request,
                                             const cp_crash_run *nominal, const char *const path[2],
                                             size_t count, uint64_t seed, cp_crash_samples *samples,
                                             cp_error *error);
void cp_crash_samples_destroy(cp_crash_samples *samples);

/* Median and 5 ... 95 % interval of every quantity and vehicle beside the nominal value; share
 * censored. JSON: {"configuration", "samples", "seed", "vehicles": [{"role", "scatter",
 * "quantities": {"olc_g": {...}}}]}; CSV: one row a quantity and vehicle. */
CP_MUST_CHECK cp_status cp_crash_samples_print(const cp_crash_samples *samples,
                                               const cp_crash_run *nominal, cp_format format,
                                               FILE *file, cp_error *error);

#endif
