/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_STUDY_PARTS_H
#define STUDY_STUDY_PARTS_H

#include "control/control.h"
#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>

/* Scenarios and variants of a study, and copies of them for those that a sweep has several of. */

/* One parameter of a sweep at one of its values (study/sweep_section.h). */
typedef struct cp_study_swept {
    char *parameter; /* key path in full: "variants.aeb.aeb.ttc_s" */
    double value;
} cp_study_swept;

typedef struct cp_study_scenario {
    char *name; /* letters, digits, '_', '-', '.'; at most 64; unique; with swept
                   parameters "base@parameter=value" */
    char *base; /* name in the study file */
    cp_study_swept *swept;
    size_t swept_count;
    char *sumocfg;       /* as written */
    char *sumocfg_path;  /* resolved */
    char **sumo_options; /* further SUMO words */
    size_t sumo_option_count;
    cp_control_settings *driver_errors;
    size_t driver_error_count;
} cp_study_scenario;

typedef struct cp_study_variant {
    char *name; /* like a scenario's */
    char *base;
    cp_study_swept *swept;
    size_t swept_count;
    bool is_baseline;
    cp_control_settings *functions;
    size_t function_count;
} cp_study_variant;

/* Everything copied; the caller destroys the copy, also after an error. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_study_scenario_copy(const cp_study_scenario *scenario,
                                               cp_study_scenario *copy, cp_error *error);
CP_MUST_CHECK cp_status cp_study_variant_copy(const cp_study_variant *variant,
                                              cp_study_variant *copy, cp_error *error);

/* Release what they own. */
void cp_study_scenario_destroy(cp_study_scenario *scenario);
void cp_study_variant_destroy(cp_study_variant *variant);

#endif
