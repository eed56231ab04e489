/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_RECENT_ROWS_H
#define CORE_RECENT_ROWS_H

#include "core/error.h"

#include <stddef.h>
#include <stdint.h>

#define CP_NO_ROW UINT32_MAX

/* Rows of things that are numbered upwards as they come and that go again, mostly in that order:
 * vehicles by number. Takes room for the numbers between the lowest and the highest that have a
 * row, not for all there ever were. Zero-initialise, destroy. */
typedef struct cp_recent_rows {
    uint32_t *row; /* of number first and those after it; CP_NO_ROW: none */
    size_t room;
    uint32_t first;
} cp_recent_rows;

/* Row of a number, CP_NO_ROW when it has none. */
static inline uint32_t cp_recent_rows_get(const cp_recent_rows *rows, uint32_t number)
{
    return number >= rows->first && number - rows->first < rows->room
               ? rows->row[number - rows->first]
               : CP_NO_ROW;
}

/* Give a number a row below CP_NO_ROW. Error: CP_NO_MEMORY, never for one that has a row. */
CP_MUST_CHECK cp_status cp_recent_rows_set(cp_recent_rows *rows, uint32_t number, uint32_t row,
                                           cp_error *error);
void cp_recent_rows_clear(cp_recent_rows *rows, uint32_t number);
void cp_recent_rows_destroy(cp_recent_rows *rows);

#endif
