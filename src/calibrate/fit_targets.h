/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_FIT_TARGETS_H
#define CALIBRATE_FIT_TARGETS_H

#include "calibrate/fit.h"
#include "core/yaml_file.h"

/* The section `targets` of a fit file (db/vehicles/README.md describes it). */
typedef struct cp_yaml_target_bounds {
    char *quantity;
    char *at_ms;
    char *min;
    char *max;
    char *aim;
} cp_yaml_target_bounds;

typedef struct cp_yaml_target_barrier {
    char *width_m;
    char *depth_m;
    char *corner_radius_m;
} cp_yaml_target_barrier;

typedef struct cp_yaml_target {
    char *name;
    char *source;
    char *against;
    char *speed_km_h;
    char *offset_mm;
    char *angle_deg;
    cp_yaml_target_barrier *barrier;
    char *weight;
    cp_yaml_target_bounds *bounds;
    unsigned bounds_count;
} cp_yaml_target;

extern const cyaml_schema_value_t CP_YAML_TARGET_VALUE;

/* Fill fit->target. Errors: CP_BAD_INPUT with file, line and field. */
CP_MUST_CHECK cp_status cp_fit_targets_read(const cp_yaml_file *file, const cp_yaml_target *yaml,
                                            size_t count, cp_fit *fit, cp_error *error);

#endif
