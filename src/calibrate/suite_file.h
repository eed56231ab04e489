/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_SUITE_FILE_H
#define CALIBRATE_SUITE_FILE_H

#include "calibrate/suite.h"
#include "core/error.h"

/* Read path. Errors: CP_BAD_INPUT with file, line and field. The caller destroys, also after an
 * error. */
CP_MUST_CHECK cp_status cp_suite_load(const char *path, cp_suite *suite, cp_error *error);

#endif
