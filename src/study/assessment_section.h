/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_ASSESSMENT_SECTION_H
#define STUDY_ASSESSMENT_SECTION_H

#include "core/yaml_file.h"
#include "store/assessment_items.h"

/* Section assessment of a study file: what of an assessment only a person can say. All of it is
 * optional; reports print what is missing as missing.
 *
 *   assessment:
 *     target_population: "belted drivers of passenger cars in frontal crashes between two cars"
 *     target_market: "EU-27, 2030, AEB in 60 % of cars"
 *     baseline: "cars without AEB, traffic of 2020"
 *
 * Its text is kept in the database with the study file; nothing that is simulated depends on it, so
 * it may be written, or changed, after the study has run. */

/* The section as libcyaml reads it, by cp_assessment_item; NULL: not said. */
typedef struct cp_assessment_section {
    char *text[CP_ASSESSMENT_ITEM_COUNT];
} cp_assessment_section;

extern const cyaml_schema_field_t CP_ASSESSMENT_FIELDS[];

#define CP_ASSESSMENT_CHARACTERS_MAX 4000 /* of one item */

/* Check that what is said says something, and mark it. section: NULL when the file has none.
 * Errors: CP_BAD_INPUT for a text of blanks, or one too long. */
CP_MUST_CHECK cp_status cp_assessment_take(const cp_yaml_file *file,
                                           const cp_assessment_section *section,
                                           bool said[CP_ASSESSMENT_ITEM_COUNT], cp_error *error);

#endif
