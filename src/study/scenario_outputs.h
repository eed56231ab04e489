/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_SCENARIO_OUTPUTS_H
#define STUDY_SCENARIO_OUTPUTS_H

#include "core/error.h"
#include "study/scenario_files.h"

#include <stddef.h>

/* What a scenario asks SUMO to write, and with whom it asks it to speak: options that name outputs
 * (of the .sumocfg and of sumo_options), and what the files that SUMO reads name (detectors, edge
 * data, timed events, calibrators, parameters of devices and traffic lights, document types). Its
 * output folder is that of the .sumocfg, with what is below: a scenario writes nowhere else and
 * opens no connection, unless whoever runs it allows it. The worker is held to that by the system
 * too (run/confinement.h). */

typedef struct cp_scenario_output {
    char *place; /* "x.sumocfg:7: summary-output", "sumo_options: log", "d.add.xml:3: <e1 file>" */
    char *name;  /* as written */
    const char *why; /* why it is refused; NULL: it is not; static text */
} cp_scenario_output;

typedef struct cp_scenario_outputs {
    cp_scenario_output *output;
    size_t count;
} cp_scenario_outputs;

/* In the order in which SUMO is given them; the caller destroys, after a failure too. Errors:
 * CP_BAD_INPUT for a .sumocfg that cannot be read; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_scenario_outputs_find(const cp_scenario_inputs *inputs,
                                                 cp_scenario_outputs *outputs, cp_error *error);
void cp_scenario_outputs_destroy(cp_scenario_outputs *outputs);

/* CP_BAD_INPUT with the first that is refused, and the flag that allows it; else as above. */
CP_MUST_CHECK cp_status cp_scenario_outputs_check(const cp_scenario_inputs *inputs,
                                                  cp_error *error);

#endif
