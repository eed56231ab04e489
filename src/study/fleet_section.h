/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_FLEET_SECTION_H
#define STUDY_FLEET_SECTION_H

#include "core/yaml_file.h"
#include "study/study.h"

/* Fleet and market of the section vehicles of a study file: every car is drawn from a vehicle
 * class.
 *
 *   vehicles:
 *     fleet: default                # the classes of crash/vehicle_choice.h; no other is known
 *     market:                       # optional: shares of classes among vehicles of a SUMO type
 *       - {type: car, class: small_car, share_1: 0.3}
 *       - {type: car, class: suv, share_1: 0.7}
 *
 * The shares of a type sum up to 1. Types that the market does not name get their class by vClass
 * and size. */

/* A row of the market as libcyaml reads it. */
typedef struct cp_market_entry {
    char *type;
    char *vehicle_class;
    char *share_1;
} cp_market_entry;

extern const cyaml_schema_value_t CP_MARKET_ENTRY;

/* Fill study->has_fleet and study->market. fleet may be NULL: none. Errors: CP_BAD_INPUT for
 * another fleet than default, a market without one, a repeated row, a share outside (0, 1], shares
 * of a type that do not sum up to 1; CP_NO_MEMORY. Whether classes and types exist is seen where
 * they are known: run/fleet.h, study/type_mapping.h. */
CP_MUST_CHECK cp_status cp_fleet_section_take(const cp_yaml_file *file, const char *fleet,
                                              const cp_market_entry *entries, size_t count,
                                              cp_study *study, cp_error *error);

#endif
