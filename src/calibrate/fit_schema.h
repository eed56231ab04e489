/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_FIT_SCHEMA_H
#define CALIBRATE_FIT_SCHEMA_H

#include "calibrate/fit_pulses.h"
#include "calibrate/fit_targets.h"

/* A fit file as libcyaml reads it, before anything is checked or converted: everything a string,
 * NULL where a key is not there. */

typedef struct cp_yaml_unknown {
    char *name;
    char *min;
    char *max;
} cp_yaml_unknown;

typedef struct cp_yaml_range {
    char *speed_min_km_h;
    char *speed_max_km_h;
    char *offset_max_mm;
    char *angle_max_deg;
    char *reason;
} cp_yaml_range;

typedef struct cp_yaml_bounds {
    char *min;
    char *max;
} cp_yaml_bounds;

typedef struct cp_yaml_plausible {
    char *speed_km_h;
    char *offset_mm;
    char *angle_deg;
    cp_yaml_bounds *t_v0_ms;
    cp_yaml_bounds *crush_mm;
    cp_yaml_bounds *peak_g;
    cp_yaml_bounds *rebound_m_s;
    char *source;
} cp_yaml_plausible;

typedef struct cp_yaml_fit {
    char *fit;
    char *description;
    char *base;
    char *objective;
    char *reference;
    cp_yaml_pulse *pulses;
    unsigned pulses_count;
    cp_yaml_range *calibrated;
    char *output;
    char *algorithm;
    char *seed;
    char *population;
    char *generations;
    char *global_time_step_s;
    char *local_time_step_s;
    char *local_evaluations;
    char *starts;
    char *offspring;
    char *slope_evaluations;
    char *soft_g;
    char *prior_g;
    char *folds;
    char *neighbour_folds;
    char **leave_out;
    unsigned leave_out_count;
    cp_yaml_plausible *plausible;
    cp_yaml_target *targets;
    unsigned targets_count;
    char *ensemble;
    char *ensemble_within_1;
    char *threads;
    cp_yaml_unknown *unknowns;
    unsigned unknowns_count;
} cp_yaml_fit;

extern const cyaml_schema_value_t CP_YAML_FIT_VALUE;

#endif
