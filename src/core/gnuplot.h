/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_GNUPLOT_H
#define CORE_GNUPLOT_H

#include "core/error.h"

#include <stddef.h>

/* Draw a figure by gnuplot, in a folder of its own where all files have names of ours: the script
 * (its parts one after the other) reads "data" and sets its output to "figure", which then becomes
 * the file path. Errors: CP_BAD_INPUT gnuplot is missing; CP_RUN_FAILED it failed; CP_IO_FAILED,
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_gnuplot_draw(const char *const *script, size_t parts, const char *data,
                                        const char *path, cp_error *error);

#endif
