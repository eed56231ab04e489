/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BUILDERS_CRASH_BUILDER_H
#define BUILDERS_CRASH_BUILDER_H

#include "core/rng.h"
#include "core/units.h"
#include "crash/crash_simulation.h"

#include <stdio.h>
#include <stdlib.h>

/* Crashes for tests and benchmarks. A failure ends the program with its message: a builder's
 * caller has nothing sensible to do with it. */

static inline void crash_builder_stop(const cp_error *error)
{
    fprintf(stderr, "crash builder: %s\n", error->text);
    exit(99);
}

/* Configuration against the barrier (opponent NULL) or another car at speeds in km/h, mm, deg. */
static inline cp_crash_configuration crash_builder_configuration(const cp_vehicle_model *own,
                                                                 const cp_vehicle_model *opponent,
                                                                 double speed_km_h,
                                                                 double opponent_speed_km_h,
                                                                 double offset_mm, double angle_deg)
{
    cp_error error = {0};
    cp_crash_configuration configuration;
    if (cp_crash_configuration_from_description(own, opponent, NULL, cp_m_s_from_km_h(speed_km_h),
                                                cp_m_s_from_km_h(opponent_speed_km_h),
                                                1e-3 * offset_mm, cp_rad_from_deg(angle_deg),
                                                &configuration, &error) != CP_OK)
        crash_builder_stop(&error);
    return configuration;
}

static inline cp_crash_result crash_builder_simulate(const cp_vehicle_model *own,
                                                     const cp_vehicle_model *opponent,
                                                     const cp_crash_configuration *configuration,
                                                     const cp_crash_options *options)
{
    cp_error error = {0};
    cp_crash_result result;
    if (cp_crash_simulate(own, opponent, configuration, options, &result, &error) != CP_OK)
        crash_builder_stop(&error);
    return result;
}

/* Uniform draw in [low, high] of a named quantity of case number index. */
static inline double crash_builder_draw(const char *quantity, uint64_t index, double low,
                                        double high)
{
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(2014), quantity);
    return low + (high - low) * cp_rng_uniform(key, index);
}

#endif
