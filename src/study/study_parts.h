/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_STUDY_PARTS_H
#define STUDY_STUDY_PARTS_H

#include "study/study_file.h"

/* Copies of a study's scenarios and variants, for those that a sweep has several of. */

/* Everything copied; the caller destroys the copy, also after an error. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_study_scenario_copy(const cp_study_scenario *scenario,
                                               cp_study_scenario *copy, cp_error *error);
CP_MUST_CHECK cp_status cp_study_variant_copy(const cp_study_variant *variant,
                                              cp_study_variant *copy, cp_error *error);

/* Release what they own. */
void cp_study_scenario_destroy(cp_study_scenario *scenario);
void cp_study_variant_destroy(cp_study_variant *variant);

#endif
