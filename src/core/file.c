/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

cp_status cp_file_read(const char *path, char **content, size_t *size, cp_error *error)
{
    FILE *file = fopen(path, "rb");
    struct stat entry;
    if (file == NULL || fstat(fileno(file), &entry) != 0 || S_ISDIR(entry.st_mode)) {
        const char *reason = file == NULL ? strerror(errno) : "is a directory";
        if (file != NULL)
            fclose(file);
        else if (errno == ENOMEM)
            return cp_fail_memory(error, path);
        return cp_fail(error, CP_BAD_INPUT, "%s: cannot be read: %s", path, reason);
    }

    // Grow by doubling: works for pipes too, which have no size.
    size_t capacity = 65536, used = 0;
    char *buffer = malloc(capacity + 1);
    while (buffer != NULL) {
        used += fread(buffer + used, 1, capacity - used, file);
        if (used < capacity)
            break;
        capacity *= 2;
        char *larger = realloc(buffer, capacity + 1);
        if (larger == NULL)
            free(buffer);
        buffer = larger;
    }
    int failed = ferror(file);
    fclose(file);
    if (buffer == NULL)
        return cp_fail_memory(error, path);
    if (failed) {
        free(buffer);
        return cp_fail(error, CP_BAD_INPUT, "%s: cannot be read", path);
    }
    buffer[used] = '\0';
    *content = buffer;
    *size = used;
    return CP_OK;
}

static const char *kind_of(mode_t mode)
{
    return S_ISDIR(mode)    ? "a folder"
           : S_ISLNK(mode)  ? "a symbolic link; name the file it leads to"
           : S_ISFIFO(mode) ? "a pipe"
           : S_ISSOCK(mode) ? "a socket"
                            : "a device";
}

cp_status cp_file_check_target(const char *path, cp_error *error)
{
    struct stat entry;
    if (lstat(path, &entry) != 0 || S_ISREG(entry.st_mode))
        return CP_OK;
    return cp_fail(error, CP_BAD_INPUT, "%s: is not replaced: it is %s", path,
                   kind_of(entry.st_mode));
}

// A new file beside path that nobody can have put there; its name goes to temporary.
static int create_neighbour(const char *path, char temporary[4096], cp_error *error)
{
    uint64_t number = 0;
    if (getrandom(&number, sizeof number, 0) != (ssize_t)sizeof number ||
        snprintf(temporary, 4096, "%s.%016llx.part", path, (unsigned long long)number) >= 4096) {
        cp_fail(error, CP_BAD_INPUT, "%.200s...: the path is too long", path);
        return -1;
    }
    int file = open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0)
        cp_fail(error, CP_IO_FAILED, "%s: cannot be written: %s", path, strerror(errno));
    return file;
}

static bool write_all(int file, const char *content, size_t size)
{
    while (size > 0) {
        ssize_t written = write(file, content, size);
        if (written < 0 && errno != EINTR)
            return false;
        content += written > 0 ? written : 0;
        size -= written > 0 ? (size_t)written : 0;
    }
    return fsync(file) == 0;
}

cp_status cp_file_write(const char *path, const void *content, size_t size, cp_error *error)
{
    char temporary[4096];
    cp_error own = {0};
    cp_status status = cp_file_check_target(path, error);
    if (status != CP_OK)
        return status;
    int file = create_neighbour(path, temporary, &own);
    if (file < 0)
        return cp_fail(error, own.status, "%s", own.text);
    bool good = write_all(file, content, size);
    int why = good ? 0 : errno;
    if (close(file) != 0 && good) {
        good = false;
        why = errno;
    }
    if (good && rename(temporary, path) != 0) {
        good = false;
        why = errno;
    }
    if (good)
        return CP_OK;
    unlink(temporary);
    return cp_fail(error, CP_IO_FAILED, "%s: cannot be written: %s", path, strerror(why));
}

char *cp_file_beside(const char *base, const char *path)
{
    const char *slash = strrchr(base, '/');
    if (path[0] == '/' || slash == NULL)
        return strdup(path);
    size_t folder = (size_t)(slash - base) + 1;
    char *joined = malloc(folder + strlen(path) + 1);
    if (joined == NULL)
        return NULL;
    memcpy(joined, base, folder);
    strcpy(joined + folder, path);
    return joined;
}
