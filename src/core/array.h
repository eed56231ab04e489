/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_ARRAY_H
#define CORE_ARRAY_H

#include "core/error.h"

#include <stddef.h>

/* Growing arrays: the one way in which they grow. The owner frees an array; NULL is an empty one.
 * Elements may move whenever one is added. */

/* Make room for `needed` elements, at least doubling it, so that a step loop stops allocating once
 * it is warm. array: the variable that holds the array (NULL at first), capacity: the one that
 * counts its room. On CP_NO_MEMORY ("out of memory: what") both are as they were. */
#define cp_array_reserve(array, capacity, needed, what, error)                                     \
    cp_array_grow(&(array), sizeof *(array), &(capacity), (needed), (what), (error))

/* One more element, zeroed, at the end of an array that has a count and no capacity beside it; room
 * doubles at powers of two, so such an array grows by this only. Returns its address; NULL when
 * memory is gone, with array and count as they were. */
#define cp_array_add(array, count) cp_array_add_element(&(array), sizeof *(array), &(count))

/* The functions behind them: array points to the pointer variable. */
CP_MUST_CHECK cp_status cp_array_grow(void *array, size_t element_size, size_t *capacity,
                                      size_t needed, const char *what, cp_error *error);
void *cp_array_add_element(void *array, size_t element_size, size_t *count);

#endif
