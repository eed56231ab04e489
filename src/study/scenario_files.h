/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_SCENARIO_FILES_H
#define STUDY_SCENARIO_FILES_H

#include "core/error.h"

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

/* What a scenario consists of on disk: the .sumocfg, every file that it or the scenario's further
 * options name for SUMO to read (networks, routes, additional and weight files, edge filters), and
 * every file that those include (<include href>, the file of a rerouter, variable speed sign or
 * calibrator, XML entities), each with a hash, so that results are known to belong to one state of
 * them. As SUMO has it, lists are split at commas, %20 in a name of the .sumocfg is a blank,
 * ${NAME} a variable of the environment; names in a .sumocfg are seen from it, those in an included
 * file from that, those among the options from the working folder. */

typedef struct cp_scenario_inputs {
    const char *sumocfg_path;
    char *const *words; /* the study's sumo_options */
    size_t word_count;
} cp_scenario_inputs;

/* JSON object {file as written: SHA-256}, sorted by name; the caller frees. A file that another one
 * includes goes by its name as seen from the .sumocfg, one among the options by "sumo_options: "
 * and its name. Files that are not there are left out (SUMO will say so). XML comments take no part
 * in the hash: netconvert writes the date into one. Errors: CP_BAD_INPUT when the .sumocfg cannot
 * be read or words are no options; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_scenario_files_json(const cp_scenario_inputs *inputs, char **json,
                                               cp_error *error);

/* The vehicle models that vehicle types of a scenario name: every value of a
 * <param key="crashpulse.model" value="..."/> in its input files, in the order of the files; one
 * named twice comes twice. in_file is the .sumocfg: paths are seen from it. visit may fail, which
 * ends it. Errors: as above, and those of visit. */
typedef cp_status cp_scenario_model_visit(const char *name, const char *in_file, void *context,
                                          cp_error *error);
CP_MUST_CHECK cp_status cp_scenario_models(const cp_scenario_inputs *inputs,
                                           cp_scenario_model_visit *visit, void *context,
                                           cp_error *error);

/* Into the object types {id: true} every vehicle type, and distribution of them, of the scenario's
 * input files. All of them are parsed for it, which takes seconds for a whole city. Errors: as
 * above. */
CP_MUST_CHECK cp_status cp_scenario_types_add(const cp_scenario_inputs *inputs, json_t *types,
                                              cp_error *error);

/* What the networks among a scenario's files give drivers occasion for. */
typedef struct cp_scenario_occasions {
    bool has_lights;   /* traffic lights */
    bool has_opposite; /* lanes beside which the oncoming one may be used for overtaking */
} cp_scenario_occasions;

/* Errors: as above. */
CP_MUST_CHECK cp_status cp_scenario_occasions_find(const cp_scenario_inputs *inputs,
                                                   cp_scenario_occasions *occasions,
                                                   cp_error *error);

#endif
