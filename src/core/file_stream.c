/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/file_stream.h"

#include "core/file.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>
#include <unistd.h>

cp_status cp_file_stream_begin(const char *path, cp_file_stream *stream, cp_error *error)
{
    cp_error own = {0};
    *stream = (cp_file_stream){.path = path};
    cp_status status = cp_file_check_target(path, error);
    if (status != CP_OK)
        return status;
    int descriptor = cp_file_create_neighbour(path, stream->temporary, &own);
    if (descriptor < 0)
        return cp_fail(error, own.status, "%s", own.text);
    stream->file = fdopen(descriptor, "wb");
    if (stream->file != NULL)
        return CP_OK;
    close(descriptor);
    unlink(stream->temporary);
    return cp_fail_memory(error, path);
}

cp_status cp_file_stream_commit(cp_file_stream *stream, cp_error *error)
{
    errno = 0;
    bool good =
        ferror(stream->file) == 0 && fflush(stream->file) == 0 && fsync(fileno(stream->file)) == 0;
    int why = errno;
    if (fclose(stream->file) != 0 && good) {
        good = false;
        why = errno;
    }
    stream->file = NULL;
    if (good && rename(stream->temporary, stream->path) != 0) {
        good = false;
        why = errno;
    }
    if (good)
        return CP_OK;
    unlink(stream->temporary);
    return cp_fail(error, CP_IO_FAILED, "%s: cannot be written: %s", stream->path,
                   strerror(why != 0 ? why : EIO));
}

void cp_file_stream_abandon(cp_file_stream *stream)
{
    if (stream->file == NULL)
        return;
    fclose(stream->file);
    unlink(stream->temporary);
    stream->file = NULL;
}
