/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_CONTROL_SECTION_H
#define STUDY_CONTROL_SECTION_H

#include "control/control.h"
#include "core/yaml_file.h"

/* One entry of driver_errors or functions in a study file: the name of a control and a mapping
 * `parameters` whose keys are those of the control's table. libcyaml cannot map keys it does not
 * know beforehand, so the mapping is read from the key paths of the loaded file. */

/* Read the entry at key path entry_path (e.g. "variants[1].functions[0]"); name_key is the key that
 * holds the control's name, name its value. Parameters not given keep their defaults. Errors:
 * CP_BAD_INPUT for an unknown control, an unknown or repeated parameter, a value out of range. */
CP_MUST_CHECK cp_status cp_control_section_read(const cp_yaml_file *file, cp_control_kind kind,
                                                const char *entry_path, const char *name_key,
                                                const char *name, cp_control_settings *settings,
                                                cp_error *error);

#endif
