/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/suite_schema.h"

#include "calibrate/suite.h"

#define TEXT(key, type)                                                                            \
    CYAML_FIELD_STRING_PTR(#key, CYAML_FLAG_POINTER, type, key, 0, CYAML_UNLIMITED)
#define OPTIONAL_TEXT(key, type)                                                                   \
    CYAML_FIELD_STRING_PTR(#key, CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, type, key, 0,           \
                           CYAML_UNLIMITED)
#define OPTIONAL_LIST(key, type)                                                                   \
    CYAML_FIELD_SEQUENCE(#key, CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, type, key, &WORD_VALUE,   \
                         1, CP_SUITE_LIST_MAX)
#define OPTIONAL_MAPPING(key, type, fields)                                                        \
    CYAML_FIELD_MAPPING_PTR(#key, CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, type, key, fields)

static const cyaml_schema_value_t WORD_VALUE = {
    CYAML_VALUE_STRING(CYAML_FLAG_POINTER, char, 0, CYAML_UNLIMITED)};

static const cyaml_schema_field_t BAR_FIELDS[] = {OPTIONAL_TEXT(inside_1, cp_suite_yaml_bar),
                                                  OPTIONAL_TEXT(mean_abs, cp_suite_yaml_bar),
                                                  OPTIONAL_TEXT(median_abs, cp_suite_yaml_bar),
                                                  OPTIONAL_TEXT(p90_abs, cp_suite_yaml_bar),
                                                  OPTIONAL_TEXT(max_abs, cp_suite_yaml_bar),
                                                  OPTIONAL_TEXT(max_step, cp_suite_yaml_bar),
                                                  OPTIONAL_TEXT(falling, cp_suite_yaml_bar),
                                                  OPTIONAL_TEXT(last_is_highest, cp_suite_yaml_bar),
                                                  CYAML_FIELD_END};

static const cyaml_schema_field_t COMPARISON_FIELDS[] = {
    TEXT(quantity, cp_suite_yaml_comparison),
    OPTIONAL_LIST(times_ms, cp_suite_yaml_comparison),
    OPTIONAL_TEXT(population, cp_suite_yaml_comparison),
    OPTIONAL_LIST(reference, cp_suite_yaml_comparison),
    OPTIONAL_LIST(low, cp_suite_yaml_comparison),
    OPTIONAL_LIST(high, cp_suite_yaml_comparison),
    OPTIONAL_TEXT(relative, cp_suite_yaml_comparison),
    OPTIONAL_TEXT(car, cp_suite_yaml_comparison),
    OPTIONAL_MAPPING(bar, cp_suite_yaml_comparison, BAR_FIELDS),
    CYAML_FIELD_END};
static const cyaml_schema_value_t COMPARISON_VALUE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cp_suite_yaml_comparison, COMPARISON_FIELDS)};

static const cyaml_schema_field_t BARRIER_FIELDS[] = {
    TEXT(width_m, cp_suite_yaml_barrier),
    TEXT(depth_m, cp_suite_yaml_barrier),
    TEXT(corner_radius_m, cp_suite_yaml_barrier),
    OPTIONAL_TEXT(mass_kg, cp_suite_yaml_barrier),
    OPTIONAL_TEXT(yaw_inertia_kg_m2, cp_suite_yaml_barrier),
    OPTIONAL_TEXT(face_m, cp_suite_yaml_barrier),
    OPTIONAL_TEXT(face_kn, cp_suite_yaml_barrier),
    OPTIONAL_TEXT(face_bumper_m, cp_suite_yaml_barrier),
    OPTIONAL_TEXT(face_bumper_kn, cp_suite_yaml_barrier),
    CYAML_FIELD_END};

static const cyaml_schema_field_t TABLE_FIELDS[] = {
    TEXT(form, cp_suite_yaml_table), OPTIONAL_TEXT(file, cp_suite_yaml_table),
    OPTIONAL_TEXT(references_file, cp_suite_yaml_table),
    OPTIONAL_LIST(rows_with, cp_suite_yaml_table), CYAML_FIELD_END};

static const cyaml_schema_field_t SWEEP_FIELDS[] = {
    TEXT(from_1, cp_suite_yaml_sweep), TEXT(to_1, cp_suite_yaml_sweep),
    TEXT(count, cp_suite_yaml_sweep), CYAML_FIELD_END};

static const cyaml_schema_field_t PLACES_FIELDS[] = {
    TEXT(from_mm, cp_suite_yaml_places), TEXT(to_mm, cp_suite_yaml_places),
    TEXT(count, cp_suite_yaml_places), CYAML_FIELD_END};

static const cyaml_schema_field_t CLASS_FIELDS[] = {
    CYAML_FIELD_STRING_PTR("class", CYAML_FLAG_POINTER, cp_suite_yaml_class, name, 0,
                           CYAML_UNLIMITED),
    TEXT(title, cp_suite_yaml_class),
    OPTIONAL_TEXT(note, cp_suite_yaml_class),
    OPTIONAL_LIST(vehicles, cp_suite_yaml_class),
    OPTIONAL_MAPPING(table, cp_suite_yaml_class, TABLE_FIELDS),
    OPTIONAL_LIST(speeds_km_h, cp_suite_yaml_class),
    OPTIONAL_LIST(opponent_speeds_km_h, cp_suite_yaml_class),
    OPTIONAL_LIST(overlaps_1, cp_suite_yaml_class),
    OPTIONAL_MAPPING(overlap_sweep, cp_suite_yaml_class, SWEEP_FIELDS),
    OPTIONAL_LIST(sides, cp_suite_yaml_class),
    OPTIONAL_LIST(angles_deg, cp_suite_yaml_class),
    OPTIONAL_TEXT(struck, cp_suite_yaml_class),
    OPTIONAL_LIST(struck_speeds_km_h, cp_suite_yaml_class),
    OPTIONAL_LIST(at_mm, cp_suite_yaml_class),
    OPTIONAL_MAPPING(at_sweep, cp_suite_yaml_class, PLACES_FIELDS),
    OPTIONAL_LIST(struck_forces_1, cp_suite_yaml_class),
    OPTIONAL_MAPPING(barrier, cp_suite_yaml_class, BARRIER_FIELDS),
    OPTIONAL_LIST(against, cp_suite_yaml_class),
    CYAML_FIELD_SEQUENCE("compare", CYAML_FLAG_POINTER, cp_suite_yaml_class, compare,
                         &COMPARISON_VALUE, 1, CP_SUITE_COMPARISONS_MAX),
    CYAML_FIELD_END};
static const cyaml_schema_value_t CLASS_VALUE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cp_suite_yaml_class, CLASS_FIELDS)};

static const cyaml_schema_field_t SUITE_FIELDS[] = {
    TEXT(suite, cp_suite_yaml_suite),
    OPTIONAL_TEXT(description, cp_suite_yaml_suite),
    OPTIONAL_TEXT(quantiles, cp_suite_yaml_suite),
    CYAML_FIELD_SEQUENCE("vehicles", CYAML_FLAG_POINTER, cp_suite_yaml_suite, vehicles, &WORD_VALUE,
                         1, CP_SUITE_LIST_MAX),
    CYAML_FIELD_SEQUENCE("classes", CYAML_FLAG_POINTER, cp_suite_yaml_suite, classes, &CLASS_VALUE,
                         1, CP_SUITE_LIST_MAX),
    CYAML_FIELD_END};
const cyaml_schema_value_t CP_SUITE_YAML_VALUE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, cp_suite_yaml_suite, SUITE_FIELDS)};
