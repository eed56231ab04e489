/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/memory.h"

#include "core/log.h"
#include "core/status.h"

#include <stdlib.h>
#include <unistd.h>

static void *memory_or_end(void *memory, const char *what)
{
    if (memory == NULL) {
        cp_log_error("out of memory: %s", what);
        _exit(cp_status_exit_code(CP_NO_MEMORY));
    }
    return memory;
}

void *cp_memory_or_end(size_t size, const char *what)
{
    return memory_or_end(malloc(size > 0 ? size : 1), what);
}

void *cp_memory_again_or_end(void *memory, size_t size, const char *what)
{
    return memory_or_end(realloc(memory, size > 0 ? size : 1), what);
}

void *cp_memory_for_json(size_t size)
{
    return cp_memory_or_end(size, "a result");
}
