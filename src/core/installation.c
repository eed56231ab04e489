/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/installation.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

// Folders as seen from that of the program; CMake gives those of the installation.
static const char *const FOLDER[] = {
    [CP_INSTALLED_PROGRAM] = ".",
    [CP_INSTALLED_WORKER] = CRASHPULSE_WORKER_FOLDER,
    [CP_INSTALLED_LIBRARY] = CRASHPULSE_LIBRARY_FOLDER,
    [CP_INSTALLED_DATA] = CRASHPULSE_DATA_FOLDER,
};

cp_status cp_installation_program(char *path, size_t size, cp_error *error)
{
    ssize_t length = readlink("/proc/self/exe", path, size);
    if (length < 0)
        return cp_fail(error, CP_IO_FAILED, "/proc/self/exe: %s", strerror(errno));
    if ((size_t)length >= size)
        return cp_fail(error, CP_IO_FAILED, "/proc/self/exe: the path is too long");
    path[length] = '\0';
    return CP_OK;
}

cp_status cp_installation_find(cp_installed_place place, const char *name, char *path, size_t size,
                               cp_error *error)
{
    char folder[PATH_MAX];
    cp_status status = cp_installation_program(folder, sizeof folder, error);
    if (status != CP_OK)
        return status;
    char *slash = strrchr(folder, '/');
    *(slash != NULL ? slash : folder) = '\0';

    // Beside the executable first: a build folder never takes the parts of another installation.
    int length = snprintf(path, size, "%s/%s", folder, name);
    if (length >= 0 && (size_t)length < size && access(path, F_OK) == 0)
        return CP_OK;
    length = snprintf(path, size, "%s/%s/%s", folder, FOLDER[place], name);
    if (length < 0 || (size_t)length >= size)
        return cp_fail(error, CP_IO_FAILED, "%s: the path is too long", name);
    return CP_OK;
}
