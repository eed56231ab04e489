/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/array.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

// Give the array that a variable points to room for so many elements. The variable is a pointer of
// any type: its bytes are copied, not read as another type. NULL: memory is gone, nothing changed.
static void *resize(void *array, size_t element_size, size_t room)
{
    void *held;
    memcpy(&held, array, sizeof held);
    void *grown = room <= SIZE_MAX / element_size ? realloc(held, room * element_size) : NULL;
    if (grown != NULL)
        memcpy(array, &grown, sizeof grown);
    return grown;
}

cp_status cp_array_grow(void *array, size_t element_size, size_t *capacity, size_t needed,
                        const char *what, cp_error *error)
{
    if (needed <= *capacity)
        return CP_OK;
    size_t larger = *capacity < 32 ? 64 : 2 * *capacity;
    if (larger < needed)
        larger = needed;
    if (resize(array, element_size, larger) == NULL)
        return cp_fail_memory(error, what);
    *capacity = larger;
    return CP_OK;
}

void *cp_array_add_element(void *array, size_t element_size, size_t *count)
{
    void *elements = NULL;
    if (*count > SIZE_MAX / 2)
        return NULL;
    // Full at none and at every power of two.
    if ((*count & (*count - 1)) == 0)
        elements = resize(array, element_size, *count == 0 ? 1 : 2 * *count);
    else
        memcpy(&elements, array, sizeof elements);
    if (elements == NULL)
        return NULL;
    void *added = (char *)elements + (*count)++ * element_size;
    memset(added, 0, element_size);
    return added;
}
