/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ASSESS_CONFIGURATIONS_H
#define ASSESS_CONFIGURATIONS_H

#include "assess/listed.h"
#include "exchange/configurations_csv.h"
#include "run/fleet.h"

/* A list of configurations through the same path as collisions.h, in its order; no exposure. A
 * row's vehicle files are the fleet's types of that name. Two that miss each other or begin inside
 * each other are a bad row (listed.h). Between cp_crash_library_begin and _end. Errors:
 * CP_BAD_INPUT when not one row is right; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_assess_configurations(const cp_configuration_list *list,
                                                 const char *list_path, const cp_fleet *fleet,
                                                 cp_assessment_keep keep, bool strict,
                                                 cp_result_rows *results,
                                                 cp_assessment_count *count, cp_error *error);

#endif
