/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
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

cp_status cp_file_write(const char *path, const void *content, size_t size, cp_error *error)
{
    char temporary[4096];
    int length = snprintf(temporary, sizeof temporary, "%s.tmp%ld", path, (long)getpid());
    if (length < 0 || (size_t)length >= sizeof temporary)
        return cp_fail(error, CP_BAD_INPUT, "%s: path too long", path);
    FILE *file = fopen(temporary, "wb");
    if (file == NULL)
        return cp_fail(error, CP_IO_FAILED, "%s: cannot be written: %s", path, strerror(errno));
    int bad = fwrite(content, 1, size, file) != size;
    bad |= fclose(file) != 0;
    if (bad || rename(temporary, path) != 0) {
        cp_fail(error, CP_IO_FAILED, "%s: cannot be written: %s", path, strerror(errno));
        unlink(temporary);
        return CP_IO_FAILED;
    }
    return CP_OK;
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
