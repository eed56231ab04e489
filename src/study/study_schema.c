/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/study_schema.h"

#define TEXT(key, structure, member)                                                               \
    CYAML_FIELD_STRING_PTR(key, CYAML_FLAG_POINTER, structure, member, 1, CYAML_UNLIMITED)
#define TEXT_OPTIONAL(key, structure, member)                                                      \
    CYAML_FIELD_STRING_PTR(key, CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, structure, member, 1,    \
                           CYAML_UNLIMITED)
#define LIST(key, structure, member, entry)                                                        \
    CYAML_FIELD_SEQUENCE(key, CYAML_FLAG_POINTER, structure, member, &entry, 1, CYAML_UNLIMITED)
#define LIST_OPTIONAL(key, structure, member, entry)                                               \
    CYAML_FIELD_SEQUENCE(key, CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, structure, member, &entry, \
                         0, CYAML_UNLIMITED)

// The free keys of parameters are read from the key paths (control_section.c).
static const cyaml_schema_field_t DRIVER_ERROR_FIELDS[] = {
    TEXT("model", cp_raw_control, name), CYAML_FIELD_IGNORE("parameters", CYAML_FLAG_OPTIONAL),
    CYAML_FIELD_END};
static const cyaml_schema_value_t DRIVER_ERROR = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cp_raw_control, DRIVER_ERROR_FIELDS)};

static const cyaml_schema_field_t SHARE_FIELDS[] = {
    TEXT("type", cp_raw_share, type), TEXT("penetration_1", cp_raw_share, penetration_1),
    CYAML_FIELD_END};
static const cyaml_schema_value_t SHARE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cp_raw_share, SHARE_FIELDS)};

static const cyaml_schema_field_t FUNCTION_FIELDS[] = {
    TEXT("function", cp_raw_control, name),
    CYAML_FIELD_IGNORE("parameters", CYAML_FLAG_OPTIONAL),
    TEXT_OPTIONAL("library", cp_raw_control, library),
    TEXT_OPTIONAL("as", cp_raw_control, as),
    TEXT_OPTIONAL("data", cp_raw_control, data),
    LIST_OPTIONAL("equipment", cp_raw_control, equipment, SHARE),
    CYAML_FIELD_END};
static const cyaml_schema_value_t FUNCTION = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cp_raw_control, FUNCTION_FIELDS)};

static const cyaml_schema_value_t WORD = {
    CYAML_VALUE_STRING(CYAML_FLAG_POINTER, char *, 0, CYAML_UNLIMITED)};

static const cyaml_schema_field_t SCENARIO_FIELDS[] = {
    TEXT("name", cp_raw_scenario, name), TEXT("sumocfg", cp_raw_scenario, sumocfg),
    LIST_OPTIONAL("sumo_options", cp_raw_scenario, sumo_options, WORD),
    LIST_OPTIONAL("driver_errors", cp_raw_scenario, driver_errors, DRIVER_ERROR), CYAML_FIELD_END};
static const cyaml_schema_value_t SCENARIO = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cp_raw_scenario, SCENARIO_FIELDS)};

static const cyaml_schema_field_t VARIANT_FIELDS[] = {
    TEXT("name", cp_raw_variant, name),
    LIST_OPTIONAL("functions", cp_raw_variant, functions, FUNCTION), CYAML_FIELD_END};
static const cyaml_schema_value_t VARIANT = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cp_raw_variant, VARIANT_FIELDS)};

static const cyaml_schema_field_t VEHICLE_TYPE_FIELDS[] = {
    TEXT("type", cp_raw_vehicle_type, type), TEXT("model", cp_raw_vehicle_type, model),
    CYAML_FIELD_END};
static const cyaml_schema_value_t VEHICLE_TYPE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cp_raw_vehicle_type, VEHICLE_TYPE_FIELDS)};

static const cyaml_schema_field_t VEHICLES_FIELDS[] = {
    TEXT_OPTIONAL("default", cp_raw_vehicles, standard),
    TEXT_OPTIONAL("fleet", cp_raw_vehicles, fleet),
    LIST_OPTIONAL("types", cp_raw_vehicles, types, VEHICLE_TYPE),
    LIST_OPTIONAL("market", cp_raw_vehicles, market, CP_MARKET_ENTRY), CYAML_FIELD_END};

static const cyaml_schema_field_t COUNTERFACTUAL_FIELDS[] = {
    TEXT_OPTIONAL("checkpoint_interval_s", cp_raw_counterfactual, checkpoint_interval_s),
    TEXT_OPTIONAL("checkpoints", cp_raw_counterfactual, checkpoints),
    TEXT_OPTIONAL("time_series_s", cp_raw_counterfactual, time_series_s),
    TEXT_OPTIONAL("horizon_s", cp_raw_counterfactual, horizon_s), CYAML_FIELD_END};

static const cyaml_schema_field_t AFTER_CRASH_FIELDS[] = {
    TEXT("stay_s", cp_raw_after_crash, stay_s), CYAML_FIELD_END};

static const cyaml_schema_field_t BACKGROUND_FIELDS[] = {
    TEXT_OPTIONAL("duration_s", cp_raw_background, duration_s),
    TEXT_OPTIONAL("seeds", cp_raw_background, seeds), CYAML_FIELD_END};

static const cyaml_schema_field_t STUDY_FIELDS[] = {
    TEXT("study", cp_raw_study, study),
    TEXT_OPTIONAL("question", cp_raw_study, question),
    TEXT("design", cp_raw_study, design),
    TEXT_OPTIONAL("baseline", cp_raw_study, baseline),
    TEXT("seed", cp_raw_study, seed),
    TEXT("replications", cp_raw_study, replications),
    TEXT("duration_s", cp_raw_study, duration_s),
    TEXT_OPTIONAL("warmup_s", cp_raw_study, warmup_s),
    TEXT_OPTIONAL("step_length_s", cp_raw_study, step_length_s),
    TEXT_OPTIONAL("history_s", cp_raw_study, history_s),
    CYAML_FIELD_MAPPING_PTR("after_crash", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_raw_study,
                            after_crash, AFTER_CRASH_FIELDS),
    CYAML_FIELD_MAPPING_PTR("background", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_raw_study,
                            background, BACKGROUND_FIELDS),
    CYAML_FIELD_MAPPING_PTR("assessment", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_raw_study,
                            assessment, CP_ASSESSMENT_FIELDS),
    LIST("scenarios", cp_raw_study, scenarios, SCENARIO),
    LIST("variants", cp_raw_study, variants, VARIANT),
    CYAML_FIELD_MAPPING_PTR("vehicles", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_raw_study,
                            vehicles, VEHICLES_FIELDS),
    CYAML_FIELD_MAPPING_PTR("counterfactual", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL,
                            cp_raw_study, counterfactual, COUNTERFACTUAL_FIELDS),
    LIST_OPTIONAL("sweep", cp_raw_study, sweep, CP_SWEEP_ENTRY),
    CYAML_FIELD_END};
const cyaml_schema_value_t CP_RAW_STUDY = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, cp_raw_study, STUDY_FIELDS)};
