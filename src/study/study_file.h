/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_STUDY_FILE_H
#define STUDY_STUDY_FILE_H

#include "study/study.h"

/* Load and check. Errors: CP_BAD_INPUT "file:line: key must be ..., found ..."; CP_NO_MEMORY. After
 * an error the study is destroyed already. */
CP_MUST_CHECK cp_status cp_study_load(const char *path, cp_study *study, cp_error *error);

#endif
