/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/output_files.h"

#include "core/file.h"

#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Folder of a path, "." for a bare name, and the name itself.
static bool split(const char *path, char folder[PATH_MAX], const char **name)
{
    const char *slash = strrchr(path, '/');
    size_t length = slash == NULL ? 0 : slash == path ? 1 : (size_t)(slash - path);
    *name = slash != NULL ? slash + 1 : path;
    if (length >= PATH_MAX)
        return false;
    snprintf(folder, PATH_MAX, "%.*s", slash != NULL ? (int)length : 1, slash != NULL ? path : ".");
    return true;
}

// The same file, or the same place for a file that is not there yet.
static bool is_same(const char *one, const char *other)
{
    struct stat entry[2], folder[2];
    const char *const path[2] = {one, other};
    if (stat(one, &entry[0]) == 0 && stat(other, &entry[1]) == 0)
        return entry[0].st_dev == entry[1].st_dev && entry[0].st_ino == entry[1].st_ino;
    const char *name[2];
    for (int k = 0; k < 2; k++) {
        char text[PATH_MAX];
        if (!split(path[k], text, &name[k]) || stat(text, &folder[k]) != 0)
            return false;
    }
    return folder[0].st_dev == folder[1].st_dev && folder[0].st_ino == folder[1].st_ino &&
           strcmp(name[0], name[1]) == 0;
}

// Whether an output is an input, or what SQLite keeps beside one.
static bool is_input(const char *output, const char *input)
{
    static const char *const BESIDE[] = {"", "-wal", "-shm", "-journal"};
    for (size_t k = 0; k < sizeof BESIDE / sizeof *BESIDE; k++) {
        char path[PATH_MAX + 16];
        if (snprintf(path, sizeof path, "%s%s", input, BESIDE[k]) < PATH_MAX &&
            is_same(output, path))
            return true;
    }
    return false;
}

static cp_status check_folder(const char *path, cp_error *error)
{
    char folder[PATH_MAX];
    const char *name;
    struct stat entry;
    if (!split(path, folder, &name))
        return cp_fail(error, CP_BAD_INPUT, "%.200s...: the path is too long", path);
    if (*name == '\0')
        return cp_fail(error, CP_BAD_INPUT, "%s: is a folder, not a file", path);
    if (stat(folder, &entry) != 0 || access(folder, W_OK | X_OK) != 0)
        return cp_fail(error, CP_IO_FAILED, "%s: cannot be written: %s", path, strerror(errno));
    return CP_OK;
}

cp_status cp_output_files_check(const char *const outputs[], size_t output_count,
                                const char *const inputs[], size_t input_count, cp_error *error)
{
    for (size_t k = 0; k < output_count; k++) {
        const char *output = outputs[k];
        if (output == NULL)
            continue;
        cp_status status = cp_file_check_target(output, error);
        if (status == CP_OK)
            status = check_folder(output, error);
        if (status != CP_OK)
            return status;
        for (size_t i = 0; i < input_count; i++)
            if (inputs[i] != NULL && is_input(output, inputs[i]))
                return cp_fail(error, CP_BAD_INPUT,
                               "%s: would be replaced by the result, but is read too: %s", output,
                               inputs[i]);
        for (size_t i = 0; i < k; i++)
            if (outputs[i] != NULL && is_same(output, outputs[i]))
                return cp_fail(error, CP_BAD_INPUT, "%s: is named for two results", output);
    }
    return CP_OK;
}

bool cp_path_has_parent_step(const char *path)
{
    for (const char *at = path; at != NULL; at = strchr(at, '/')) {
        at += *at == '/';
        if (strncmp(at, "..", 2) == 0 && (at[2] == '/' || at[2] == '\0'))
            return true;
    }
    return false;
}

cp_status cp_output_file_check_below(const char *base, const char *path, cp_error *error)
{
    if (path[0] == '\0' || path[0] == '/' || cp_path_has_parent_step(path))
        return cp_fail(error, CP_BAD_INPUT,
                       "must be a file beside %s or in a folder below, found '%s'", base, path);
    char text[PATH_MAX], home[PATH_MAX], folder[PATH_MAX];
    const char *name;
    char *joined = cp_file_beside(base, path);
    if (joined == NULL)
        return cp_fail_memory(error, path);
    bool known = split(base, text, &name) && realpath(text, home) != NULL &&
                 split(joined, text, &name) && realpath(text, folder) != NULL;
    free(joined);
    if (!known)
        return cp_fail(error, CP_BAD_INPUT, "must be in a folder that is there, found '%s'", path);
    size_t length = strlen(home);
    bool below = strncmp(home, folder, length) == 0 &&
                 (folder[length] == '/' || folder[length] == '\0' || strcmp(home, "/") == 0);
    return below ? CP_OK
                 : cp_fail(error, CP_BAD_INPUT,
                           "must stay in the folder of %s, found '%s' that "
                           "leads to %s",
                           base, path, folder);
}
