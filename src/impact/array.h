/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef IMPACT_ARRAY_H
#define IMPACT_ARRAY_H

#include "core/error.h"

#include <stddef.h>

/* Make room for `needed` elements in a growing array, at least doubling it, so that a step loop
 * stops allocating once it is warm. array: the variable that holds the array (NULL at first),
 * capacity: the one that counts it. The array's owner frees it; on CP_NO_MEMORY ("out of memory:
 * what") it is as it was. */
#define cp_array_reserve(array, capacity, needed, what, error)                                     \
    cp_array_grow(&(array), sizeof *(array), &(capacity), (needed), (what), (error))

/* The function behind it: array points to the pointer variable. */
CP_MUST_CHECK cp_status cp_array_grow(void *array, size_t element_size, size_t *capacity,
                                      size_t needed, const char *what, cp_error *error);

#endif
