/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/array.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

cp_status cp_array_grow(void *array, size_t element_size, size_t *capacity, size_t needed,
                        const char *what, cp_error *error)
{
    if (needed <= *capacity)
        return CP_OK;
    size_t larger = *capacity < 32 ? 64 : 2 * *capacity;
    if (larger < needed)
        larger = needed;
    if (larger > SIZE_MAX / element_size)
        return cp_fail_memory(error, what);

    // The variable is a pointer of any type: its bytes are copied, not read as another type.
    void *held;
    memcpy(&held, array, sizeof held);
    void *grown = realloc(held, larger * element_size);
    if (grown == NULL)
        return cp_fail_memory(error, what);
    memcpy(array, &grown, sizeof grown);
    *capacity = larger;
    return CP_OK;
}
