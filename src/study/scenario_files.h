/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_SCENARIO_FILES_H
#define STUDY_SCENARIO_FILES_H

#include "core/error.h"

/* What a scenario consists of on disk: the .sumocfg and the networks, routes and additional files
 * it names, each with a hash, so that results are known to belong to one state of them. */

/* JSON object {file as written: SHA-256}, sorted by name; the caller frees. Files that the .sumocfg
 * names but that are not there are left out (SUMO will say so). XML comments take no part in the
 * hash: netconvert writes the date into one. Errors: CP_BAD_INPUT when sumocfg_path cannot be read;
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_scenario_files_json(const char *sumocfg_path, char **json,
                                               cp_error *error);

/* Why no scenario may begin with a state that SUMO saved (option load-state): SUMO 1.15 does not
 * put the traffic back as it was, cars collide that otherwise do not (left_turn without driver
 * errors, from a state of its 20th second), alike for every seed; and one that was overtaking on an
 * opposite lane makes SUMO itself crash (head_on_overtaking, 60th second; plain sumo too). A text
 * "must not ...". */
extern const char CP_SCENARIO_NO_STATE[];

/* CP_BAD_INPUT when the .sumocfg loads a state, or cannot be read; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_scenario_loads_no_state(const char *sumocfg_path, cp_error *error);

/* The vehicle models that vehicle types of a scenario name: every value of a
 * <param key="crashpulse.model" value="..."/> in its input files (uncompressed ones), in the order
 * of the files; one named twice comes twice. in_file is sumocfg_path: paths are seen from it. visit
 * may fail, which ends it. Errors: as above, and those of visit. */
typedef cp_status cp_scenario_model_visit(const char *name, const char *in_file, void *context,
                                          cp_error *error);
CP_MUST_CHECK cp_status cp_scenario_models(const char *sumocfg_path, cp_scenario_model_visit *visit,
                                           void *context, cp_error *error);

#endif
