/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_BACKGROUND_H
#define RUN_BACKGROUND_H

#include "study/study_file.h"

/* The background of a network: what contacts its traffic makes without any driver error or
 * function. What is found there in a study is the network's doing, not the drivers'. In the worker
 * process only. */

typedef struct cp_background_options {
    const char *network;               /* name for the result */
    const cp_study_scenario *scenario; /* its driver errors are left out */
    uint64_t seed;
    double step_length_s;
    double duration_s;
} cp_background_options;

/* Simulate and write to result_path, as JSON: {"network", "seed", "step_length_s", "simulated_s",
 * "vehicle_km", "departed", "contacts": [{"reason": "crash" or a verdict, "crash_type": of crashes,
 * "contacts": how many}], "crashes": [{"time_s", "x_m", "y_m", "crash_type", "closing_speed_m_s",
 * "vehicle_1", "vehicle_2"}], "sumo_collisions": [{"found_as", "collisions"}]}. Errors:
 * CP_BAD_INPUT for a configuration that does not start, CP_TRAFFIC_FAILED, CP_IO_FAILED. */
CP_MUST_CHECK cp_status cp_background_run(const cp_background_options *options,
                                          const char *result_path, cp_error *error);

#endif
