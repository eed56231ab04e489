/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_TYPE_MAPPING_H
#define STUDY_TYPE_MAPPING_H

#include "study/study.h"

/* Whether every vehicle type that the study maps to a model exists in some scenario, or is one that
 * SUMO has by itself: a mapping of any other does nothing, and its cars crash as something else.
 * Errors: CP_BAD_INPUT with line and the types there are; those of cp_scenario_types_add. */
CP_MUST_CHECK cp_status cp_study_check_types(const cp_study *study, cp_error *error);

#endif
