/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_LIBRARY_SECTION_H
#define STUDY_LIBRARY_SECTION_H

#include "core/yaml_file.h"
#include "study/study.h"

/* The keys of `function: plugin` that name files: library (needed), as (its name in tables;
 * default: what the file is called, without lib and .so), data. Values as written, NULL when not
 * given; paths are seen from the study file. Only the files' hashes are taken, nothing is loaded.
 * Errors: CP_BAD_INPUT with the place, also for these keys at another function. */
CP_MUST_CHECK cp_status cp_library_section_read(const cp_yaml_file *file, const char *entry_path,
                                                const char *function, const char *library,
                                                const char *as, const char *data,
                                                cp_control_settings *settings, cp_error *error);

/* A library that no file describes: its path as seen from here, named as by default. The caller
 * destroys *library. Errors: CP_BAD_INPUT for a file that cannot be read or makes no name. */
CP_MUST_CHECK cp_status cp_library_from_file(const char *path, cp_library **library,
                                             cp_error *error);

#endif
