/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/fit_schema.h"

#define TEXT(key, type)                                                                            \
    CYAML_FIELD_STRING_PTR(#key, CYAML_FLAG_POINTER, type, key, 0, CYAML_UNLIMITED)
#define OPTIONAL_TEXT(key, type)                                                                   \
    CYAML_FIELD_STRING_PTR(#key, CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, type, key, 0,           \
                           CYAML_UNLIMITED)

static const cyaml_schema_field_t UNKNOWN_FIELDS[] = {TEXT(name, cp_yaml_unknown),
                                                      TEXT(min, cp_yaml_unknown),
                                                      TEXT(max, cp_yaml_unknown), CYAML_FIELD_END};
static const cyaml_schema_value_t UNKNOWN_VALUE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cp_yaml_unknown, UNKNOWN_FIELDS)};

static const cyaml_schema_field_t RANGE_FIELDS[] = {
    TEXT(speed_min_km_h, cp_yaml_range), TEXT(speed_max_km_h, cp_yaml_range),
    TEXT(offset_max_mm, cp_yaml_range),  TEXT(angle_max_deg, cp_yaml_range),
    TEXT(reason, cp_yaml_range),         CYAML_FIELD_END};

static const cyaml_schema_field_t BOUNDS_FIELDS[] = {TEXT(min, cp_yaml_bounds),
                                                     TEXT(max, cp_yaml_bounds), CYAML_FIELD_END};

#define OPTIONAL_BOUNDS(key)                                                                       \
    CYAML_FIELD_MAPPING_PTR(#key, CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_yaml_plausible,     \
                            key, BOUNDS_FIELDS)

static const cyaml_schema_field_t PLAUSIBLE_FIELDS[] = {TEXT(speed_km_h, cp_yaml_plausible),
                                                        OPTIONAL_TEXT(offset_mm, cp_yaml_plausible),
                                                        OPTIONAL_TEXT(angle_deg, cp_yaml_plausible),
                                                        OPTIONAL_BOUNDS(t_v0_ms),
                                                        OPTIONAL_BOUNDS(crush_mm),
                                                        OPTIONAL_BOUNDS(peak_g),
                                                        OPTIONAL_BOUNDS(rebound_m_s),
                                                        TEXT(source, cp_yaml_plausible),
                                                        CYAML_FIELD_END};

static const cyaml_schema_value_t WORD_VALUE = {
    CYAML_VALUE_STRING(CYAML_FLAG_POINTER, char, 0, CYAML_UNLIMITED)};

static const cyaml_schema_field_t FIT_FIELDS[] = {
    TEXT(fit, cp_yaml_fit),
    OPTIONAL_TEXT(description, cp_yaml_fit),
    TEXT(base, cp_yaml_fit),
    OPTIONAL_TEXT(objective, cp_yaml_fit),
    OPTIONAL_TEXT(reference, cp_yaml_fit),
    CYAML_FIELD_SEQUENCE("pulses", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_yaml_fit, pulses,
                         &CP_YAML_PULSE_VALUE, 1, CYAML_UNLIMITED),
    CYAML_FIELD_MAPPING_PTR("calibrated", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_yaml_fit,
                            calibrated, RANGE_FIELDS),
    TEXT(output, cp_yaml_fit),
    OPTIONAL_TEXT(algorithm, cp_yaml_fit),
    TEXT(seed, cp_yaml_fit),
    OPTIONAL_TEXT(population, cp_yaml_fit),
    OPTIONAL_TEXT(generations, cp_yaml_fit),
    OPTIONAL_TEXT(global_time_step_s, cp_yaml_fit),
    OPTIONAL_TEXT(local_time_step_s, cp_yaml_fit),
    OPTIONAL_TEXT(local_evaluations, cp_yaml_fit),
    OPTIONAL_TEXT(starts, cp_yaml_fit),
    OPTIONAL_TEXT(offspring, cp_yaml_fit),
    OPTIONAL_TEXT(slope_evaluations, cp_yaml_fit),
    OPTIONAL_TEXT(soft_g, cp_yaml_fit),
    OPTIONAL_TEXT(prior_g, cp_yaml_fit),
    OPTIONAL_TEXT(folds, cp_yaml_fit),
    OPTIONAL_TEXT(neighbour_folds, cp_yaml_fit),
    CYAML_FIELD_SEQUENCE("leave_out", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_yaml_fit,
                         leave_out, &WORD_VALUE, 1, 3),
    CYAML_FIELD_MAPPING_PTR("plausible", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_yaml_fit,
                            plausible, PLAUSIBLE_FIELDS),
    CYAML_FIELD_SEQUENCE("targets", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_yaml_fit, targets,
                         &CP_YAML_TARGET_VALUE, 1, CP_TARGETS_MAX),
    OPTIONAL_TEXT(ensemble, cp_yaml_fit),
    OPTIONAL_TEXT(ensemble_within_1, cp_yaml_fit),
    OPTIONAL_TEXT(threads, cp_yaml_fit),
    CYAML_FIELD_SEQUENCE("unknowns", CYAML_FLAG_POINTER, cp_yaml_fit, unknowns, &UNKNOWN_VALUE, 1,
                         CP_UNKNOWNS_MAX),
    CYAML_FIELD_END};
const cyaml_schema_value_t CP_YAML_FIT_VALUE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, cp_yaml_fit, FIT_FIELDS)};
