/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_SUITE_CASE_H
#define CALIBRATE_SUITE_CASE_H

#include "calibrate/suite_row.h"

/* The cases of a class for one vehicle, and what is simulated for one of them. */

/* How many cars of a case a quantity is taken of: 1 or 2. */
int cp_suite_case_cars(const cp_suite_class *class, const cp_suite_comparison *comparison);

/* Cases of a class for a vehicle. references: folder of the reference tables; a table that is not
 * there leaves no case and says so in skipped. Errors: CP_BAD_INPUT from a table or an opponent,
 * CP_NO_MEMORY. The caller destroys, also after an error. */
CP_MUST_CHECK cp_status cp_suite_cases_of(const cp_suite *suite, const cp_suite_class *class,
                                          const cp_vehicle_model *vehicle, const char *references,
                                          cp_suite_cases *cases, cp_error *error);
void cp_suite_cases_destroy(cp_suite_cases *cases);

/* Simulate a case at offset number index. wall (when the case is of a pair and has a barrier too)
 * is the first car against that; zeroed otherwise. The caller destroys both results. */
CP_MUST_CHECK cp_status cp_suite_case_simulate(const cp_suite_case *row, size_t index,
                                               cp_crash_result *result, cp_crash_result *wall,
                                               cp_error *error);

#endif
