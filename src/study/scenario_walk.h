/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_SCENARIO_WALK_H
#define STUDY_SCENARIO_WALK_H

#include "study/input_file.h"
#include "study/sumo_configuration.h"

/* Every file that SUMO reads for a scenario (study/scenario_files.h), one after the other. */

/* What is done with each, once: what was found in it, its name for people. Anything but CP_OK ends
 * the walk. */
typedef cp_status cp_scenario_visit(const cp_input_file *file, const char *name, void *context,
                                    cp_error *error);

/* The files that the options name, and those that these include; files that are not there are left
 * out. search: what is looked for in them. Errors: CP_NO_MEMORY, and those of visit. */
CP_MUST_CHECK cp_status cp_scenario_walk(const cp_sumo_configuration *configuration,
                                         const cp_input_search *search, cp_scenario_visit *visit,
                                         void *context, cp_error *error);

#endif
