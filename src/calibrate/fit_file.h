/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_FIT_FILE_H
#define CALIBRATE_FIT_FILE_H

#include "calibrate/fit.h"
#include "core/error.h"

/* Load and check a fit file. output_path: where to, NULL: where the file says, which must lie in
 * its own folder or below. What will be written is looked at (output_files.h), so that a long fit
 * does not end in vain. Errors: CP_BAD_INPUT with file, line and field; CP_IO_FAILED where nothing
 * can be written. The caller destroys. */
CP_MUST_CHECK cp_status cp_fit_load(const char *path, const char *output_path, cp_fit *fit,
                                    cp_error *error);

#endif
