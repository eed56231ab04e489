/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_PLAN_ROWS_H
#define STORE_PLAN_ROWS_H

#include "core/hash.h"
#include "store/store.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A planned study as rows of the database. Texts are owned by whoever fills the rows; columns are
 * described in db/schema. */

typedef struct cp_study_row {
    char *name;
    char *question; /* NULL when the study asks none */
    const char *design;
    uint64_t seed;
    size_t replications;
    double duration_s;
    double warmup_s;
    double step_length_s;
    double stay_s;
    double history_s;
    char *vehicles; /* JSON */
    char *yaml;
    char hash[CP_HASH_TEXT_SIZE];
} cp_study_row;

typedef struct cp_scenario_row {
    char *name;
    char *sumocfg;
    char *sumo_options;  /* JSON */
    char *files;         /* JSON */
    char *driver_errors; /* JSON */
} cp_scenario_row;

typedef struct cp_variant_row {
    char *name;
    bool is_baseline;
    char *functions; /* JSON */
} cp_variant_row;

/* A swept parameter of a scenario or variant at its value. */
typedef struct cp_sweep_row {
    bool of_scenario;
    size_t owner;    /* index into the scenarios or variants */
    char *base;      /* name in the study file */
    char *parameter; /* key path */
    double value;
} cp_sweep_row;

typedef struct cp_vehicle_model_row {
    char *name;
    char hash[CP_HASH_TEXT_SIZE];
    char *yaml;
} cp_vehicle_model_row;

typedef struct cp_replication_row {
    int64_t id;      /* cp_replication_row_id */
    size_t scenario; /* index into the scenarios */
    size_t variant;
    size_t number; /* from 0 */
    uint64_t seed;
    char configuration_hash[CP_HASH_TEXT_SIZE];
} cp_replication_row;

/* A run of a scenario's network without driver errors or functions, for it and all other scenarios
 * that start SUMO alike (same .sumocfg, options and files); the first of them has it. */
typedef struct cp_background_plan_row {
    size_t scenario; /* index into the scenarios */
    uint64_t seed;
    double duration_s;
    char configuration_hash[CP_HASH_TEXT_SIZE];
} cp_background_plan_row;

typedef struct cp_plan_rows {
    cp_study_row study;
    cp_scenario_row *scenario;
    size_t scenario_count;
    cp_variant_row *variant;
    size_t variant_count;
    cp_sweep_row *sweep;
    size_t sweep_count;
    cp_vehicle_model_row *vehicle_model;
    size_t vehicle_model_count;
    cp_replication_row *replication;
    size_t replication_count;
    cp_background_plan_row *background;
    size_t background_count;
} cp_plan_rows;

/* Row id of a replication from its natural key. sweep is "": names of swept scenarios and variants
 * hold their values. */
int64_t cp_replication_row_id(const char *scenario, const char *variant, const char *sweep,
                              uint64_t seed);

/* Bring the database to this plan, all or nothing: new rows are added, replications that are
 * neither planned any more nor done are dropped. Errors: CP_BAD_INPUT when the database holds
 * another study, or finished or running replications that this plan does not have or configures
 * otherwise (the difference is named); CP_STORE_FAILED on a collision of row ids. */
CP_MUST_CHECK cp_status cp_plan_rows_write(cp_store *store, const cp_plan_rows *rows,
                                           cp_error *error);

/* What the database knows of a planned replication. */
typedef enum cp_planned_state {
    CP_PLANNED_UNKNOWN, /* the database is not of this study or could not be read */
    CP_PLANNED_NEW,     /* nothing yet */
    CP_PLANNED_WAITING,
    CP_PLANNED_RUNNING,
    CP_PLANNED_DONE,
    CP_PLANNED_FAILED /* will be tried again */
} cp_planned_state;

/* Hold this plan against the database and change nothing: state has one entry for each of
 * rows->replication; dropped: replications there that cp_plan_rows_write would remove. Errors: as
 * cp_plan_rows_write; the states are filled in for contradictions too. */
CP_MUST_CHECK cp_status cp_plan_rows_compare(cp_store *store, const cp_plan_rows *rows,
                                             cp_planned_state *state, size_t *dropped,
                                             cp_error *error);

#endif
