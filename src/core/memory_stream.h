/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_MEMORY_STREAM_H
#define CORE_MEMORY_STREAM_H

#include <stddef.h>
#include <stdio.h>

/* As open_memstream, with an error that is one: where memory is gone, ferror and fclose say so. The
 * C library's own then leaves out a piece, or gives nothing at all, without a word. After a good
 * fclose, and not before, *content holds the text, zero-terminated, and *size its length without
 * the zero; the caller frees it. After a bad one they are NULL and 0. NULL when there is no memory
 * for the stream. */
FILE *cp_memory_stream(char **content, size_t *size);

#endif
