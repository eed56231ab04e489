/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_STUDY_SCHEMA_H
#define STUDY_STUDY_SCHEMA_H

#include "study/assessment_section.h"
#include "study/fleet_section.h"
#include "study/sweep_section.h"

/* A study file as libcyaml reads it, before anything is checked or converted: everything a string,
 * NULL where a key is not there. */

typedef struct cp_raw_share {
    char *type;
    char *penetration_1;
} cp_raw_share;

typedef struct cp_raw_control {
    char *name;
    char *library; /* of a function from one, */
    char *as;      /* its name in tables, */
    char *data;    /* and a file for it */
    cp_raw_share *equipment;
    unsigned equipment_count;
} cp_raw_control;

typedef struct cp_raw_counterfactual {
    char *checkpoint_interval_s;
    char *checkpoints;
    char *time_series_s;
    char *horizon_s;
} cp_raw_counterfactual;

typedef struct cp_raw_after_crash {
    char *stay_s;
} cp_raw_after_crash;

typedef struct cp_raw_background {
    char *duration_s;
    char *seeds;
} cp_raw_background;

typedef struct cp_raw_scenario {
    char *name;
    char *sumocfg;
    char **sumo_options;
    unsigned sumo_options_count;
    cp_raw_control *driver_errors;
    unsigned driver_errors_count;
} cp_raw_scenario;

typedef struct cp_raw_variant {
    char *name;
    cp_raw_control *functions;
    unsigned functions_count;
} cp_raw_variant;

typedef struct cp_raw_vehicle_type {
    char *type;
    char *model;
} cp_raw_vehicle_type;

typedef struct cp_raw_vehicles {
    char *standard;
    char *fleet;
    cp_raw_vehicle_type *types;
    unsigned types_count;
    cp_market_entry *market;
    unsigned market_count;
} cp_raw_vehicles;

typedef struct cp_raw_study {
    char *study;
    char *question;
    char *design;
    char *baseline;
    char *seed;
    char *replications;
    char *duration_s;
    char *warmup_s;
    char *step_length_s;
    char *history_s;
    cp_raw_after_crash *after_crash;
    cp_raw_background *background;
    cp_assessment_section *assessment;
    cp_raw_scenario *scenarios;
    unsigned scenarios_count;
    cp_raw_variant *variants;
    unsigned variants_count;
    cp_raw_vehicles *vehicles;
    cp_raw_counterfactual *counterfactual;
    cp_sweep_entry *sweep;
    unsigned sweep_count;
} cp_raw_study;

extern const cyaml_schema_value_t CP_RAW_STUDY;

#endif
