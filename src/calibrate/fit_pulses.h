/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_FIT_PULSES_H
#define CALIBRATE_FIT_PULSES_H

#include "calibrate/fit.h"
#include "core/yaml_file.h"

/* The section "pulses" of a fit file. */
typedef struct cp_yaml_pulse {
    char *speed_km_h;
    char *offset_mm;
    char *angle_deg;
    char *file;
    char *ev5;
    char **channels;
    unsigned channels_count;
    char *until_s;
    char *weight;
} cp_yaml_pulse;

/* How libcyaml is to read one entry of the section. */
extern const cyaml_schema_value_t CP_YAML_PULSE_VALUE;

/* Load the pulses count entries name, as seen from the folder of the fit file, and derive from
 * them the conditions and hash of fit->reference. On an error what fit holds is still to be
 * destroyed. Errors: CP_BAD_INPUT with file, line and field; those of the pulses' files. */
CP_MUST_CHECK cp_status cp_fit_pulses_load(const cp_yaml_file *file, const cp_yaml_pulse *entries,
                                           size_t count, cp_fit *fit, cp_error *error);

#endif
