/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_SUITE_CASES_H
#define CALIBRATE_SUITE_CASES_H

#include "calibrate/suite_case.h"

/* Cases of a class for a vehicle. references: folder of the reference tables; a table that is not
 * there leaves no case and says so in skipped. Errors: CP_BAD_INPUT from a table or an opponent,
 * CP_NO_MEMORY. The caller destroys, also after an error. */
CP_MUST_CHECK cp_status cp_suite_cases_of(const cp_suite *suite, const cp_suite_class *class,
                                          const cp_vehicle_model *vehicle, const char *references,
                                          cp_suite_cases *cases, cp_error *error);

#endif
