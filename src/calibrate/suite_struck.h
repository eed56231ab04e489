/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_SUITE_STRUCK_H
#define CALIBRATE_SUITE_STRUCK_H

#include "calibrate/suite_case.h"

/* Cases in which the judged vehicle is struck on a side or its rear. */

/* Every opponent with every speed, place, side, angle and factor on the struck structure's forces.
 * Errors: CP_BAD_INPUT from an opponent, CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_suite_struck_listed(const cp_suite *suite, const cp_suite_class *class,
                                               const cp_vehicle_model *vehicle,
                                               cp_suite_cases *cases, cp_error *error);

/* Row k of a table of form reconstructed_struck: a real crash of two cars, of which the first was
 * struck on its side or rear by the second's front; both have the judged car's structures. Where is
 * not known: 20, 60 and 100 % of its front within the side from either end and the middle of it,
 * overlaps of the rear of 20 to 100 % on either side.
 * *use: whether the class has the row's side among rows_with. */
CP_MUST_CHECK cp_status cp_suite_struck_case(const cp_csv_table *table, size_t k,
                                             const cp_suite_class *class, cp_suite_case *row,
                                             bool *use, cp_error *error);

#endif
