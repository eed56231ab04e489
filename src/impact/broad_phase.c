/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/broad_phase.h"

#include "impact/array.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* A little more than a car and its way in a step, so most boxes lie in one to four cells. */
#define CELL_M 10.0
#define FARTHEST_M 1e9

static const char *const WHAT = "broad phase of contact detection";

static int32_t cell_of(double coordinate_m)
{
    return (int32_t)floor(coordinate_m / CELL_M);
}

static bool is_usable(const cp_box *box)
{
    // Comparisons with NAN are false.
    return box->min_x_m > -FARTHEST_M && box->max_x_m < FARTHEST_M && box->min_y_m > -FARTHEST_M &&
           box->max_y_m < FARTHEST_M && box->min_x_m <= box->max_x_m &&
           box->min_y_m <= box->max_y_m;
}

static bool boxes_overlap(const cp_box *a, const cp_box *b)
{
    return a->min_x_m <= b->max_x_m && b->min_x_m <= a->max_x_m && a->min_y_m <= b->max_y_m &&
           b->min_y_m <= a->max_y_m;
}

// List every box in every cell it touches.
static cp_status list_entries(cp_broad_phase *phase, const cp_box *boxes, size_t count,
                              size_t *entry_count, cp_error *error)
{
    size_t used = 0;
    for (size_t k = 0; k < count; k++) {
        if (!is_usable(&boxes[k]))
            continue;
        int32_t x0 = cell_of(boxes[k].min_x_m), x1 = cell_of(boxes[k].max_x_m);
        int32_t y0 = cell_of(boxes[k].min_y_m), y1 = cell_of(boxes[k].max_y_m);
        size_t cells = (size_t)(x1 - x0 + 1) * (size_t)(y1 - y0 + 1);
        cp_status status =
            cp_array_reserve(phase->entry, phase->entry_capacity, used + cells, WHAT, error);
        if (status != CP_OK)
            return status;
        for (int32_t x = x0; x <= x1; x++)
            for (int32_t y = y0; y <= y1; y++)
                phase->entry[used++] = (cp_grid_entry){x, y, (uint32_t)k};
    }
    *entry_count = used;
    return CP_OK;
}

static size_t bucket_of(const cp_grid_entry *entry, size_t bucket_count)
{
    uint64_t mixed = (uint64_t)(uint32_t)entry->cell_x * UINT64_C(0x9e3779b97f4a7c15) ^
                     (uint64_t)(uint32_t)entry->cell_y * UINT64_C(0xc2b2ae3d27d4eb4f);
    return (size_t)((mixed ^ mixed >> 32) * UINT64_C(0xbf58476d1ce4e5b9) >> 32) &
           (bucket_count - 1);
}

// Counting sort of the entries by bucket; within a bucket they keep the order of the boxes.
static cp_status sort_entries(cp_broad_phase *phase, size_t entry_count, size_t *bucket_count,
                              cp_error *error)
{
    size_t buckets = 64;
    while (buckets < 2 * entry_count)
        buckets *= 2;
    cp_status status =
        cp_array_reserve(phase->sorted, phase->sorted_capacity, entry_count, WHAT, error);
    if (status == CP_OK)
        status =
            cp_array_reserve(phase->bucket_begin, phase->bucket_capacity, buckets + 1, WHAT, error);
    if (status != CP_OK)
        return status;

    // Count, turn counts into ends, then fill from the back, which leaves the beginnings.
    memset(phase->bucket_begin, 0, (buckets + 1) * sizeof *phase->bucket_begin);
    for (size_t k = 0; k < entry_count; k++)
        phase->bucket_begin[bucket_of(&phase->entry[k], buckets)]++;
    for (size_t k = 1; k <= buckets; k++)
        phase->bucket_begin[k] += phase->bucket_begin[k - 1];
    for (size_t k = entry_count; k-- > 0;)
        phase->sorted[--phase->bucket_begin[bucket_of(&phase->entry[k], buckets)]] =
            phase->entry[k];
    *bucket_count = buckets;
    return CP_OK;
}

// A pair shares several cells: it is reported in the one with the lower corner of its overlap.
static bool is_home_cell(const cp_grid_entry *entry, const cp_box *a, const cp_box *b)
{
    return entry->cell_x == cell_of(fmax(a->min_x_m, b->min_x_m)) &&
           entry->cell_y == cell_of(fmax(a->min_y_m, b->min_y_m));
}

static cp_status pair_up(cp_broad_phase *phase, const cp_box *boxes, size_t begin, size_t end,
                         size_t *pair_count, cp_error *error)
{
    for (size_t i = begin; i < end; i++)
        for (size_t j = i + 1; j < end; j++) {
            const cp_grid_entry *one = &phase->sorted[i], *other = &phase->sorted[j];
            if (one->cell_x != other->cell_x || one->cell_y != other->cell_y)
                continue;
            const cp_box *a = &boxes[one->box], *b = &boxes[other->box];
            if (!boxes_overlap(a, b) || !is_home_cell(one, a, b))
                continue;
            cp_status status =
                cp_array_reserve(phase->pair, phase->pair_capacity, *pair_count + 1, WHAT, error);
            if (status != CP_OK)
                return status;
            phase->pair[(*pair_count)++] = (cp_box_pair){one->box, other->box};
        }
    return CP_OK;
}

cp_status cp_broad_phase_pairs(cp_broad_phase *phase, const cp_box *boxes, size_t count,
                               const cp_box_pair **pairs, size_t *pair_count, cp_error *error)
{
    size_t entry_count = 0, bucket_count = 0;
    *pair_count = 0;
    cp_status status = list_entries(phase, boxes, count, &entry_count, error);
    if (status == CP_OK)
        status = sort_entries(phase, entry_count, &bucket_count, error);
    for (size_t k = 0; k < bucket_count && status == CP_OK; k++)
        status = pair_up(phase, boxes, phase->bucket_begin[k], phase->bucket_begin[k + 1],
                         pair_count, error);
    *pairs = phase->pair;
    return status;
}

void cp_broad_phase_destroy(cp_broad_phase *phase)
{
    free(phase->entry);
    free(phase->sorted);
    free(phase->bucket_begin);
    free(phase->pair);
    *phase = (cp_broad_phase){0};
}
