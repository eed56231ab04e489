/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_INSTALLATION_H
#define CORE_INSTALLATION_H

#include "core/error.h"

#include <stddef.h>

/* Where the parts of the program lie, seen from the running executable (/proc/self/exe), so that an
 * installation can be moved as a whole. In a build folder everything lies beside the executable;
 * installed, it lies in folders of its own, whose places relative to the program's folder are fixed
 * when the program is configured (GNUInstallDirs). */

typedef enum cp_installed_place {
    CP_INSTALLED_PROGRAM, /* beside the executable, nowhere else */
    CP_INSTALLED_WORKER,  /* programs that crashpulse starts */
    CP_INSTALLED_LIBRARY, /* libraries that are loaded by name */
    CP_INSTALLED_DATA     /* sumo_scenarios, db */
} cp_installed_place;

/* Path of the part called name: beside the executable, else in its installed folder; where it is in
 * neither, *path is the installed one. Errors: CP_IO_FAILED when the executable's own path cannot
 * be read, or size is too small. */
CP_MUST_CHECK cp_status cp_installation_find(cp_installed_place place, const char *name, char *path,
                                             size_t size, cp_error *error);

/* Path of the running executable. Errors: as above. */
CP_MUST_CHECK cp_status cp_installation_program(char *path, size_t size, cp_error *error);

#endif
