/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_SUITE_SCHEMA_H
#define CALIBRATE_SUITE_SCHEMA_H

#include "core/yaml_file.h"

/* A suite file as libcyaml reads it, before anything is checked or converted: everything a string,
 * NULL where a key is not there. */

typedef struct cp_suite_yaml_bar {
    char *inside_1;
    char *mean_abs;
    char *median_abs;
    char *p90_abs;
    char *max_abs;
    char *max_step;
    char *falling;
    char *last_is_highest;
} cp_suite_yaml_bar;

typedef struct cp_suite_yaml_comparison {
    char *quantity;
    char **times_ms;
    unsigned times_ms_count;
    char *population;
    char **reference;
    unsigned reference_count;
    char **low;
    unsigned low_count;
    char **high;
    unsigned high_count;
    char *relative;
    char *car;
    cp_suite_yaml_bar *bar;
} cp_suite_yaml_comparison;

typedef struct cp_suite_yaml_barrier {
    char *width_m;
    char *depth_m;
    char *corner_radius_m;
    char *mass_kg;
    char *yaw_inertia_kg_m2;
    char *face_m;
    char *face_kn;
    char *face_bumper_m;
    char *face_bumper_kn;
} cp_suite_yaml_barrier;

typedef struct cp_suite_yaml_table {
    char *form;
    char *file;
    char *references_file;
    char **rows_with;
    unsigned rows_with_count;
} cp_suite_yaml_table;

typedef struct cp_suite_yaml_sweep {
    char *from_1;
    char *to_1;
    char *count;
} cp_suite_yaml_sweep;

typedef struct cp_suite_yaml_places {
    char *from_mm;
    char *to_mm;
    char *count;
} cp_suite_yaml_places;

typedef struct cp_suite_yaml_class {
    char *name;
    char *title;
    char *note;
    char **vehicles;
    unsigned vehicles_count;
    cp_suite_yaml_table *table;
    char **speeds_km_h;
    unsigned speeds_km_h_count;
    char **opponent_speeds_km_h;
    unsigned opponent_speeds_km_h_count;
    char **overlaps_1;
    unsigned overlaps_1_count;
    cp_suite_yaml_sweep *overlap_sweep;
    char **sides;
    unsigned sides_count;
    char **angles_deg;
    unsigned angles_deg_count;
    char *struck;
    char **struck_speeds_km_h;
    unsigned struck_speeds_km_h_count;
    char **at_mm;
    unsigned at_mm_count;
    cp_suite_yaml_places *at_sweep;
    char **struck_forces_1;
    unsigned struck_forces_1_count;
    cp_suite_yaml_barrier *barrier;
    char **against;
    unsigned against_count;
    cp_suite_yaml_comparison *compare;
    unsigned compare_count;
} cp_suite_yaml_class;

typedef struct cp_suite_yaml_suite {
    char *suite;
    char *description;
    char *quantiles;
    char **vehicles;
    unsigned vehicles_count;
    cp_suite_yaml_class *classes;
    unsigned classes_count;
} cp_suite_yaml_suite;

extern const cyaml_schema_value_t CP_SUITE_YAML_VALUE;

#endif
