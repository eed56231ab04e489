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

#define SIZE_MAX_BYTES ((size_t)2 << 30)

static const char *kind_of(mode_t mode)
{
    return S_ISDIR(mode)    ? "a folder"
           : S_ISLNK(mode)  ? "a symbolic link; name the file it leads to"
           : S_ISFIFO(mode) ? "a pipe"
           : S_ISSOCK(mode) ? "a socket"
                            : "a device";
}

// A pipe that a shell hands over, as in `crash <(command)`.
static bool is_handed_over(const char *path, mode_t mode)
{
    return S_ISFIFO(mode) && (strcmp(path, "/dev/stdin") == 0 || strncmp(path, "/dev/fd/", 8) == 0);
}

cp_status cp_file_open(const char *path, FILE **file, cp_error *error)
{
    // Not waiting for whoever might write into a pipe.
    int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat entry = {0};
    *file = NULL;
    bool found = descriptor >= 0 && fstat(descriptor, &entry) == 0;
    bool right = found && (S_ISREG(entry.st_mode) || is_handed_over(path, entry.st_mode));
    if (right && fcntl(descriptor, F_SETFL, 0) == 0)
        *file = fdopen(descriptor, "rb");
    if (*file != NULL)
        return CP_OK;
    int why = errno;
    if (descriptor >= 0)
        close(descriptor);
    if (found && !right)
        return cp_fail(error, CP_BAD_INPUT, "%s: cannot be read: it is %s, not a file", path,
                       kind_of(entry.st_mode));
    if (why == ENOMEM)
        return cp_fail_memory(error, path);
    return cp_fail(error, CP_BAD_INPUT, "%s: cannot be read: %s", path, strerror(why));
}

// All that comes, in a buffer that grows by doubling: pipes have no size. NULL: no memory.
static char *read_all(FILE *file, size_t *used)
{
    size_t capacity = 65536;
    char *buffer = malloc(capacity + 1);
    *used = 0;
    while (buffer != NULL) {
        *used += fread(buffer + *used, 1, capacity - *used, file);
        if (*used < capacity || *used > SIZE_MAX_BYTES)
            break;
        capacity *= 2;
        char *larger = realloc(buffer, capacity + 1);
        if (larger == NULL)
            free(buffer);
        buffer = larger;
    }
    return buffer;
}

cp_status cp_file_read(const char *path, char **content, size_t *size, cp_error *error)
{
    FILE *file;
    cp_status status = cp_file_open(path, &file, error);
    if (status != CP_OK)
        return status;
    struct stat entry;
    bool large = fstat(fileno(file), &entry) == 0 && (size_t)entry.st_size > SIZE_MAX_BYTES;
    size_t used = 0;
    char *buffer = large ? NULL : read_all(file, &used);
    int failed = ferror(file), why = errno;
    fclose(file);
    if (large || used > SIZE_MAX_BYTES) {
        free(buffer);
        return cp_fail(error, CP_BAD_INPUT, "%s: is larger than 2 GiB", path);
    }
    if (buffer == NULL)
        return cp_fail_memory(error, path);
    if (failed) {
        free(buffer);
        return cp_fail(error, CP_IO_FAILED, "%s: cannot be read: %s", path, strerror(why));
    }
    buffer[used] = '\0';
    *content = buffer;
    *size = used;
    return CP_OK;
}

cp_status cp_file_check_text(const char *name, const char *content, size_t size, cp_error *error)
{
    if (size >= 2 && (memcmp(content, "\xff\xfe", 2) == 0 || memcmp(content, "\xfe\xff", 2) == 0))
        return cp_fail(error, CP_BAD_INPUT, "%s:1: is UTF-16 text; save it as UTF-8", name);
    const char *zero = size > 0 ? memchr(content, '\0', size) : NULL;
    if (zero == NULL)
        return CP_OK;
    size_t line = 1;
    for (const char *c = content; c < zero; c++)
        line += *c == '\n';
    return cp_fail(error, CP_BAD_INPUT,
                   "%s:%zu: holds a zero byte, behind which nothing would be read", name, line);
}

cp_status cp_file_read_text(const char *path, char **content, size_t *size, cp_error *error)
{
    cp_status status = cp_file_read(path, content, size, error);
    if (status != CP_OK)
        return status;
    status = cp_file_check_text(path, *content, *size, error);
    if (status != CP_OK) {
        free(*content);
        *content = NULL;
        return status;
    }
    if (*size >= 3 && memcmp(*content, "\xef\xbb\xbf", 3) == 0) {
        *size -= 3;
        memmove(*content, *content + 3, *size + 1);
    }
    return CP_OK;
}

cp_status cp_file_check_target(const char *path, cp_error *error)
{
    struct stat entry;
    if (lstat(path, &entry) != 0 || S_ISREG(entry.st_mode))
        return CP_OK;
    return cp_fail(error, CP_BAD_INPUT, "%s: is not replaced: it is %s", path,
                   kind_of(entry.st_mode));
}

int cp_file_create_neighbour(const char *path, char temporary[4096], cp_error *error)
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
    int file = cp_file_create_neighbour(path, temporary, &own);
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
