/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_MEMORY_H
#define CORE_MEMORY_H

#include <stddef.h>

/* Memory for libraries that lose something, or crash, when they get none: the physics engine's
 * constructors, fields of a JSON value. Where there is none the process ends at once with a message
 * and the exit code of CP_NO_MEMORY; nothing half made is written. Our own code returns
 * CP_NO_MEMORY instead. */

#ifdef __cplusplus
extern "C" {
#endif

/* malloc and realloc that come back with memory or not at all; what: who asked, for the message. */
void *cp_memory_or_end(size_t size, const char *what);
void *cp_memory_again_or_end(void *memory, size_t size, const char *what);

/* cp_memory_or_end for JSON values, as json_set_alloc_funcs takes it. */
void *cp_memory_for_json(size_t size);

#ifdef __cplusplus
}
#endif

#endif
