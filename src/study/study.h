/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_STUDY_H
#define STUDY_STUDY_H

#include "core/error.h"
#include "store/assessment_items.h"
#include "study/scenario_files.h"
#include "study/study_parts.h"

#include <stddef.h>
#include <stdint.h>

/* A study as its YAML file describes it, checked and with defaults filled in. Constant once loaded.
 * Paths are resolved as seen from the study file. */

/* How the seeds of the variants relate. X(name, text in file and database). */
#define CP_STUDY_DESIGNS(X)                                                                        \
    X(CP_DESIGN_PAIRED_SEEDS, "paired_seeds")                                                      \
    X(CP_DESIGN_INDEPENDENT, "independent")                                                        \
    X(CP_DESIGN_COUNTERFACTUAL, "counterfactual")

typedef enum cp_study_design {
#define CP_STUDY_DESIGN_NAME(name, text) name,
    CP_STUDY_DESIGNS(CP_STUDY_DESIGN_NAME)
#undef CP_STUDY_DESIGN_NAME
} cp_study_design;

const char *cp_study_design_text(cp_study_design design);
/* By its text; false when there is none. */
bool cp_study_design_find(const char *text, cp_study_design *design);

/* The surrogate model that vehicles of one SUMO vehicle type crash as. */
typedef struct cp_study_vehicle {
    char *type;       /* NULL: every car not named */
    char *model_path; /* resolved; NULL when a name is given instead, or nothing */
    char *model_name; /* of a shipped vehicle; else NULL */
    size_t line;      /* in the study file */
} cp_study_vehicle;

/* A share of a vehicle class among the vehicles of a SUMO vehicle type (study/fleet_section.h). */
typedef struct cp_study_market {
    char *type;
    char *vehicle_class;
    double share_1; /* [0, 1] */
    size_t line;    /* in the study file */
} cp_study_market;

/* How counterfactual pairs are made; the design's own section, all of it optional. */
typedef struct cp_study_counterfactual {
    double checkpoint_interval_s; /* default 2; [0.5, 60] */
    size_t checkpoints;           /* kept at a time; default 20; 1 ... 200 */
    double time_series_s;         /* stored before and after each contact; default 0; [0, 60] */
    double horizon_s;             /* how long after the baseline's contact a branch goes on; default
                                     CP_STUDY_HORIZON_S; [1, 120] */
} cp_study_counterfactual;

#define CP_STUDY_HORIZON_S 10.0

typedef struct cp_study {
    char *path;
    char *content; /* of the file */
    char *name;
    char *question; /* NULL when none */
    cp_study_design design;
    uint64_t seed;        /* 0 ... 2^53 */
    size_t replications;  /* per scenario and variant, 1 ... 1 000 000 */
    double duration_s;    /* simulated time of a replication, (0, 1e6] */
    double warmup_s;      /* default 0; not counted; < duration_s */
    double step_length_s; /* default 0.05; [0.001, 1], whole milliseconds */
    double stay_s;        /* crashed cars stand on the road this long; default 0: they leave it at
                             once; [0, 86400] */
    double history_s;     /* kept of both cars before each crash; default 0; [0, 60] */
    size_t background_seeds; /* of these runs a network, each with the traffic of another of the
                                baseline's replications; default: 3, or as many as these */
    double background_s; /* simulated without driver errors, per network; default: duration_s; 0:
                            not at all, else > warmup_s */
    bool said[CP_ASSESSMENT_ITEM_COUNT]; /* items that its assessment section has */
    cp_study_counterfactual counterfactual;
    cp_study_scenario *scenarios;
    size_t scenario_count;
    cp_study_variant *variants;
    size_t variant_count;
    cp_study_vehicle *vehicles; /* [0] is the default, which may name no model */
    size_t vehicle_count;
    bool has_fleet; /* cars are drawn from vehicle classes */
    cp_study_market *market;
    size_t market_count;
} cp_study;

/* A zero-initialised one is fine too. */
void cp_study_destroy(cp_study *study);

/* Index of the baseline among the variants. */
size_t cp_study_baseline(const cp_study *study);

/* Whether SUMO is started alike for both: same .sumocfg, same options. */
bool cp_study_scenarios_start_alike(const cp_study_scenario *one, const cp_study_scenario *other);

/* What it consists of on disk; borrowed. */
cp_scenario_inputs cp_study_scenario_inputs(const cp_study_scenario *scenario);

/* Log what becomes of options that the scenarios set (sumo_configuration.h), once for scenarios
 * that start alike. */
CP_MUST_CHECK cp_status cp_study_tell_options(const cp_study *study, cp_error *error);

/* By name; NULL when there is none. */
const cp_study_scenario *cp_study_find_scenario(const cp_study *study, const char *name);

/* A function of the study that comes from a library, for k = 0, 1, ... each file once; NULL: no
 * more. variant: the first that has it. */
const cp_library *cp_study_library(const cp_study *study, size_t k,
                                   const cp_study_variant **variant);

#endif
