/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE // syncfs

#include "core/output_folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

cp_status cp_output_folder_begin(const char *path, cp_output_folder *folder, cp_error *error)
{
    struct stat entry;
    *folder = (cp_output_folder){.path = path};
    size_t length = strlen(path);
    if (lstat(path, &entry) == 0)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: is there already: name a folder that is not, or remove it", path);
    if (length == 0 || path[length - 1] == '/')
        return cp_fail(error, CP_BAD_INPUT, "%s: must be a name without '/' at its end", path);
    if (length + 8 > sizeof folder->temporary)
        return cp_fail(error, CP_BAD_INPUT, "%.200s...: the path is too long", path);
    snprintf(folder->temporary, sizeof folder->temporary, "%s.XXXXXX", path);
    if (mkdtemp(folder->temporary) != NULL)
        return CP_OK;
    int why = errno;
    folder->temporary[0] = '\0';
    return cp_fail(error, CP_IO_FAILED, "%s: cannot be created: %s", path, strerror(why));
}

cp_status cp_output_folder_create(const char *path, FILE **file, cp_error *error)
{
    int descriptor = open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor < 0)
        return cp_fail(error, CP_IO_FAILED, "%s: cannot be written: %s", path, strerror(errno));
    *file = fdopen(descriptor, "wb");
    if (*file != NULL)
        return CP_OK;
    close(descriptor);
    return cp_fail_memory(error, path);
}

cp_status cp_output_folder_close(const char *path, FILE *file, cp_error *error)
{
    errno = 0;
    bool good = fflush(file) == 0 && ferror(file) == 0;
    int why = errno;
    if (fclose(file) != 0 && good) {
        good = false;
        why = errno;
    }
    return good ? CP_OK
                : cp_fail(error, CP_IO_FAILED, "%s: cannot be written: %s", path,
                          strerror(why != 0 ? why : EIO));
}

// Everything of the folder's disk on it.
static bool is_on_disk(const char *path)
{
    int descriptor = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0)
        return false;
    bool good = syncfs(descriptor) == 0;
    int why = errno;
    close(descriptor);
    errno = why;
    return good;
}

cp_status cp_output_folder_commit(cp_output_folder *folder, cp_error *error)
{
    // With the rights that a new folder has.
    mode_t mask = umask(0);
    umask(mask);
    if (is_on_disk(folder->temporary) && chmod(folder->temporary, 0777 & ~mask) == 0 &&
        rename(folder->temporary, folder->path) == 0) {
        folder->temporary[0] = '\0';
        return CP_OK;
    }
    int why = errno;
    cp_output_folder_abandon(folder);
    return cp_fail(error, CP_IO_FAILED, "%s: cannot be created: %s", folder->path, strerror(why));
}

// Everything below a folder of ours, links not followed; depth: levels that we write.
static void remove_below(int parent, const char *name, int depth)
{
    int descriptor = openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    DIR *directory = descriptor >= 0 ? fdopendir(descriptor) : NULL;
    if (directory == NULL) {
        if (descriptor >= 0)
            close(descriptor);
        return;
    }
    for (struct dirent *entry = readdir(directory); entry != NULL; entry = readdir(directory)) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0)
            continue;
        if (unlinkat(descriptor, entry->d_name, 0) != 0 && depth > 0)
            remove_below(descriptor, entry->d_name, depth - 1);
    }
    closedir(directory);
    unlinkat(parent, name, AT_REMOVEDIR);
}

void cp_output_folder_abandon(cp_output_folder *folder)
{
    enum { LEVELS = 4 };
    if (folder->temporary[0] != '\0')
        remove_below(AT_FDCWD, folder->temporary, LEVELS);
    folder->temporary[0] = '\0';
}
