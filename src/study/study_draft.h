/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_STUDY_DRAFT_H
#define STUDY_STUDY_DRAFT_H

#include "study/network_survey.h"

#include <stdio.h>

/* The first study file of somebody's own network: what 'crashpulse init' writes. */

/* What is proposed, each from the network and its configuration. */
typedef struct cp_study_draft {
    double duration_s;    /* from begin to end, or to the last departure and 300 s more, at most an
                             hour; 900 where neither is known */
    double warmup_s;      /* what a car at 30 km/h takes across the network, at most a third of the
                             duration; whole 10 s */
    double step_length_s; /* the configuration's, at most 0.1, in whole milliseconds */
    bool fits_junctions;  /* drivers must give way: failed_to_see, misjudged_gap */
    bool fits_lights;     /* red_light */
    bool fits_overtaking; /* risky_overtaking */
    bool fits_drift;      /* roads have an oncoming lane: lane_drift */
} cp_study_draft;

/* longest_s: of the duration, in place of an hour; 0: an hour. */
cp_study_draft cp_study_draft_of(const cp_sumo_configuration *configuration,
                                 const cp_network_survey *survey, double longest_s);

/* Write it as a study file with comments. name: of study and scenario, letters, digits, '_', '-',
 * '.'; sumocfg: as the study file is to name it. */
void cp_study_draft_write(const cp_study_draft *draft, const cp_network_survey *survey,
                          const char *name, const char *sumocfg, FILE *file);

#endif
