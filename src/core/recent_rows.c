/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/recent_rows.h"

#include <stdlib.h>
#include <string.h>

static void fill_none(uint32_t *row, size_t count)
{
    memset(row, 0xff, count * sizeof *row);
}

// Numbers at the beginning that have no row any more.
static size_t leading_none(const cp_recent_rows *rows)
{
    size_t count = 0;
    while (count < rows->room && rows->row[count] == CP_NO_ROW)
        count++;
    return count;
}

static void drop_leading(cp_recent_rows *rows, size_t count)
{
    memmove(rows->row, rows->row + count, (rows->room - count) * sizeof *rows->row);
    fill_none(rows->row + rows->room - count, count);
    rows->first += (uint32_t)count;
}

static cp_status grow(cp_recent_rows *rows, size_t room, size_t in_front, cp_error *error)
{
    uint32_t *row = malloc(room * sizeof *row);
    if (row == NULL)
        return cp_fail_memory(error, "rows by number");
    fill_none(row, room);
    if (rows->room > 0)
        memcpy(row + in_front, rows->row, rows->room * sizeof *row);
    free(rows->row);
    rows->row = row;
    rows->room = room;
    rows->first -= (uint32_t)in_front;
    return CP_OK;
}

// Make the window hold number: behind its end those in front that have gone make room, if they are
// half of it, before it grows.
static cp_status cover(cp_recent_rows *rows, uint32_t number, cp_error *error)
{
    const size_t least = 64;
    size_t gone = leading_none(rows);
    if (gone == rows->room)
        rows->first = number; // nobody has a row
    if (rows->room == 0)
        return grow(rows, least, 0, error);
    if (number < rows->first) {
        size_t missing = rows->first - number;
        size_t in_front = missing > rows->room ? missing : rows->room;
        return grow(rows, rows->room + in_front, in_front < rows->first ? in_front : rows->first,
                    error);
    }
    if (number - rows->first < rows->room)
        return CP_OK;
    if (gone >= rows->room / 2 && number - rows->first - gone < rows->room) {
        drop_leading(rows, gone);
        return CP_OK;
    }
    size_t needed = (size_t)(number - rows->first) + 1, doubled = 2 * rows->room;
    return grow(rows, needed > doubled ? needed : doubled, 0, error);
}

cp_status cp_recent_rows_set(cp_recent_rows *rows, uint32_t number, uint32_t row, cp_error *error)
{
    if (number < rows->first || number - rows->first >= rows->room) {
        cp_status status = cover(rows, number, error);
        if (status != CP_OK)
            return status;
    }
    rows->row[number - rows->first] = row;
    return CP_OK;
}

void cp_recent_rows_clear(cp_recent_rows *rows, uint32_t number)
{
    if (cp_recent_rows_get(rows, number) != CP_NO_ROW)
        rows->row[number - rows->first] = CP_NO_ROW;
}

void cp_recent_rows_destroy(cp_recent_rows *rows)
{
    free(rows->row);
    *rows = (cp_recent_rows){0};
}
