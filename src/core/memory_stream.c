/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE // fopencookie
#include "core/memory_stream.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

typedef struct memory_stream {
    char **content; /* where both go in the end */
    size_t *size;
    char *text;
    size_t used;
    size_t room;
    bool failed; /* a piece is missing */
} memory_stream;

// Room for so many more bytes and a zero.
static bool grow(memory_stream *stream, size_t more)
{
    size_t wanted = stream->used + more + 1;
    if (wanted <= stream->room)
        return true;
    size_t room = wanted > 2 * stream->room ? wanted : 2 * stream->room;
    char *larger = realloc(stream->text, room);
    if (larger == NULL)
        return false;
    stream->text = larger;
    stream->room = room;
    return true;
}

static ssize_t take(void *cookie, const char *bytes, size_t size)
{
    memory_stream *stream = cookie;
    if (stream->failed || !grow(stream, size)) {
        stream->failed = true;
        errno = ENOMEM;
        return 0;
    }
    memcpy(stream->text + stream->used, bytes, size);
    stream->used += size;
    return (ssize_t)size;
}

static int finish(void *cookie)
{
    memory_stream *stream = cookie;
    bool failed = stream->failed || !grow(stream, 0);
    if (failed) {
        free(stream->text);
        errno = ENOMEM;
    } else {
        stream->text[stream->used] = '\0';
        *stream->content = stream->text;
        *stream->size = stream->used;
    }
    free(stream);
    return failed ? EOF : 0;
}

FILE *cp_memory_stream(char **content, size_t *size)
{
    const cookie_io_functions_t functions = {.write = take, .close = finish};
    memory_stream *stream = calloc(1, sizeof *stream);
    *content = NULL;
    *size = 0;
    if (stream == NULL)
        return NULL;
    *stream = (memory_stream){.content = content, .size = size};
    FILE *file = fopencookie(stream, "w", functions);
    if (file == NULL)
        free(stream);
    return file;
}
