/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_SUMO_CONFIGURATION_H
#define STUDY_SUMO_CONFIGURATION_H

#include "core/error.h"
#include "traffic/sumo_options.h"

/* The options a scenario gives SUMO: those of its .sumocfg, as SUMO reads it (an option's value
 * stands in its attribute value or v, or is its text), and the further words of sumo_options, which
 * come before them. */

/* A setting as it was given. */
typedef struct cp_sumo_setting {
    char *name;                   /* as written, without dashes */
    char *value;                  /* "true" for a switch without one */
    const cp_sumo_option *option; /* NULL: SUMO 1.15 has none of that name */
    size_t line;                  /* in the .sumocfg; 0: one of sumo_options */
    size_t word;                  /* of sumo_options: place of the first of its words; */
    size_t word_count;            /* and how many they are, 1 or 2 */
} cp_sumo_setting;

typedef struct cp_sumo_configuration {
    char *path; /* of the .sumocfg */
    cp_sumo_setting *setting;
    size_t count;
} cp_sumo_configuration;

/* Zero-initialise; the caller destroys, after a failure too. Errors: CP_BAD_INPUT for a .sumocfg
 * that cannot be read, is no XML or takes text from other files, and for words that are no option
 * with a value; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_sumo_configuration_read(const char *sumocfg_path, char *const *words,
                                                   size_t word_count,
                                                   cp_sumo_configuration *configuration,
                                                   cp_error *error);
void cp_sumo_configuration_destroy(cp_sumo_configuration *configuration);

/* The setting that holds for an option, by its first name: that of sumo_options, else that of the
 * .sumocfg; NULL without one. */
const cp_sumo_setting *cp_sumo_configuration_find(const cp_sumo_configuration *configuration,
                                                  const char *option);

/* Where a setting stands, for messages: "x.sumocfg:7: option" or "sumo_options: option". */
void cp_sumo_setting_place(const cp_sumo_configuration *configuration,
                           const cp_sumo_setting *setting, char *place, size_t size);

/* Whether a scenario may run for duration_s (traffic/sumo_options.h). Error: CP_BAD_INPUT with the
 * option and why not. */
CP_MUST_CHECK cp_status cp_sumo_configuration_check(const cp_sumo_configuration *configuration,
                                                    double duration_s, cp_error *error);

/* Seconds from the beginning to the end that the options set; INFINITY without an end. */
double cp_sumo_configuration_length_s(const cp_sumo_configuration *configuration);

/* Log a warning for every setting that is replaced by another value, and for every option that SUMO
 * 1.15 does not have. */
void cp_sumo_configuration_tell(const cp_sumo_configuration *configuration);

#endif
