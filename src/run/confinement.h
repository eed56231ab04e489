/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_CONFINEMENT_H
#define RUN_CONFINEMENT_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>

/* What a process that reads the files of strangers with other people's code (SUMO) may still do.
 * Linux holds it to that, and all that it forks: Landlock (since Linux 5.13) for files, a filter of
 * system calls (seccomp) for connections. Neither needs rights nor can be undone. */

/* Whether this system can keep a process to folders. */
bool cp_confinement_has_folders(void);

/* From here on this process writes, makes, renames and deletes files only in these folders and
 * below them, apart from /dev/null and what it has open, and opens no socket. A folder that is not
 * there is left out; without Landlock only sockets are refused. Errors: CP_IO_FAILED. */
CP_MUST_CHECK cp_status cp_confine(const char *const *folders, size_t count, cp_error *error);

#endif
