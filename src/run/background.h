/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_BACKGROUND_H
#define RUN_BACKGROUND_H

#include "run/cross_check.h"
#include "run/sumo_words.h"
#include "store/background_rows.h"

/* The background of a network: what contacts its traffic makes without any driver error or
 * function. What is found there in a study is the network's doing, not the drivers'. In the worker
 * process only. */

typedef struct cp_background_options {
    const char *network; /* name for the result; borrowed by the rows */
    cp_sumo_start sumo;
    uint64_t seed;
    double step_length_s;
    double duration_s; /* warm-up included */
    double warmup_s;   /* contacts and exposure before it do not count */
    double stay_s;     /* crashed cars stand on the road this long */
} cp_background_options;

/* Simulate and fill in rows (zeroed) and check, SUMO's own collisions matched with ours; the caller
 * destroys both, also after an error. Errors: CP_BAD_INPUT for a configuration that does not start,
 * CP_TRAFFIC_FAILED. */
CP_MUST_CHECK cp_status cp_background_run(const cp_background_options *options,
                                          cp_background_rows *rows, cp_cross_check *check,
                                          cp_error *error);

/* Both to a file, as JSON: {"network", "seed", "step_length_s", "simulated_s", "vehicle_km",
 * "vehicle_h", "departed", "contacts": [{"reason": "crash" or a verdict, "crash_type": of crashes,
 * "contacts": how many}], "crashes": [{"time_s", "x_m", "y_m", "crash_type", "closing_speed_m_s",
 * "vehicle_1", "vehicle_2"}], "sumo_collisions": [{"found_as", "collisions"}]}. Error:
 * CP_IO_FAILED. */
CP_MUST_CHECK cp_status cp_background_write_json(const cp_background_rows *rows,
                                                 const cp_cross_check *check,
                                                 const char *result_path, cp_error *error);

#endif
