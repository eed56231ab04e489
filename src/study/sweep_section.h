/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_SWEEP_SECTION_H
#define STUDY_SWEEP_SECTION_H

#include "core/yaml_file.h"
#include "study/study.h"

/* Section sweep of a study file: parameters that take several values.
 *
 *   sweep:
 *     - {parameter: variants.aeb.aeb.ttc_s, values: [0.8, 1.2, 1.6]}
 *     - {parameter: scenarios.left_turn.failed_to_see.probability_1, from: 0.1, to: 0.5, steps: 5}
 *     - {parameter: scenarios.left_turn.sumo_options.scale, values: [0.5, 1]}
 *     - {parameter: variants.aeb.aeb.equipment.van, values: [0, 0.5]}   # penetration by type
 *
 * The name of the function or driver error may be left out where only one has the parameter. A
 * scenario or variant with swept parameters stands in the study once for each combination of
 * values, named "aeb@ttc_s=0.8". */

/* One entry as libcyaml reads it. */
typedef struct cp_sweep_entry {
    char *parameter;
    char **values;
    unsigned values_count;
    char *from;
    char *to;
    char *steps;
} cp_sweep_entry;

extern const cyaml_schema_value_t CP_SWEEP_ENTRY;

#define CP_SWEEP_POINTS_MAX 1000    /* of one scenario or variant */
#define CP_SWEEP_NAME_CHARACTERS 96 /* names become part of file names */

/* Put the swept scenarios and variants in place of those in the study. Errors: CP_BAD_INPUT for a
 * parameter that is not there or is the baseline's, a value out of range or repeated, too many
 * combinations; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_sweep_expand(const cp_yaml_file *file, const cp_sweep_entry *entries,
                                        size_t count, cp_study *study, cp_error *error);

#endif
