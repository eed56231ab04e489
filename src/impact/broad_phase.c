/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/broad_phase.h"

#include "core/array.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* A little more than a car and its way in a step, so most boxes lie in one to four cells. */
#define CELL_M 10.0
#define FARTHEST_M 1e9
#define NO_ENTRY UINT32_MAX

static const char *const WHAT = "broad phase of contact detection";

static int32_t cell_of(double coordinate_m)
{
    double cells = coordinate_m * (1.0 / CELL_M);
    int32_t cell = (int32_t)cells; // towards 0
    return cell - (cells < cell);
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

static uint32_t bucket_of(int32_t cell_x, int32_t cell_y, size_t bucket_count)
{
    uint64_t mixed = (uint64_t)(uint32_t)cell_x * UINT64_C(0x9e3779b97f4a7c15) ^
                     (uint64_t)(uint32_t)cell_y * UINT64_C(0xc2b2ae3d27d4eb4f);
    return (uint32_t)((mixed ^ mixed >> 32) * UINT64_C(0xbf58476d1ce4e5b9) >> 32) &
           (uint32_t)(bucket_count - 1);
}

// Empty buckets: some two to four a box, so that a bucket seldom holds more than one cell.
static cp_status empty_buckets(cp_broad_phase *phase, size_t count, size_t *bucket_count,
                               cp_error *error)
{
    size_t buckets = 64;
    while (buckets < 2 * count)
        buckets *= 2;
    cp_status status =
        cp_array_reserve(phase->latest, phase->bucket_capacity, buckets, WHAT, error);
    if (status != CP_OK)
        return status;
    memset(phase->latest, 0xff, buckets * sizeof *phase->latest);
    *bucket_count = buckets;
    return CP_OK;
}

// A pair shares several cells: it is reported in the one with the lower corner of its overlap.
static bool is_home_cell(const cp_grid_entry *entry, const cp_box *a, const cp_box *b)
{
    return entry->cell_x == cell_of(fmax(a->min_x_m, b->min_x_m)) &&
           entry->cell_y == cell_of(fmax(a->min_y_m, b->min_y_m));
}

// Pairs of a box with those that came into its cell before it.
static cp_status pair_up(cp_broad_phase *phase, const cp_box *boxes, const cp_grid_entry *entry,
                         size_t *pair_count, cp_error *error)
{
    const cp_box *box = &boxes[entry->box];
    for (uint32_t k = entry->earlier; k != NO_ENTRY; k = phase->entry[k].earlier) {
        const cp_grid_entry *other = &phase->entry[k];
        const cp_box *other_box = &boxes[other->box];
        if (other->cell_x != entry->cell_x || other->cell_y != entry->cell_y ||
            !boxes_overlap(box, other_box) || !is_home_cell(entry, box, other_box))
            continue;
        cp_status status =
            cp_array_reserve(phase->pair, phase->pair_capacity, *pair_count + 1, WHAT, error);
        if (status != CP_OK)
            return status;
        phase->pair[(*pair_count)++] = (cp_box_pair){other->box, entry->box};
    }
    return CP_OK;
}

// Into every cell it touches, where those that came before are met.
static cp_status enter(cp_broad_phase *phase, const cp_box *boxes, size_t k, size_t bucket_count,
                       size_t *entry_count, size_t *pair_count, cp_error *error)
{
    int32_t x0 = cell_of(boxes[k].min_x_m), x1 = cell_of(boxes[k].max_x_m);
    int32_t y0 = cell_of(boxes[k].min_y_m), y1 = cell_of(boxes[k].max_y_m);
    size_t cells = (size_t)(x1 - x0 + 1) * (size_t)(y1 - y0 + 1);
    cp_status status =
        cp_array_reserve(phase->entry, phase->entry_capacity, *entry_count + cells, WHAT, error);
    for (int32_t x = x0; x <= x1 && status == CP_OK; x++)
        for (int32_t y = y0; y <= y1 && status == CP_OK; y++) {
            uint32_t *latest = &phase->latest[bucket_of(x, y, bucket_count)];
            cp_grid_entry *entry = &phase->entry[*entry_count];
            *entry = (cp_grid_entry){x, y, (uint32_t)k, *latest};
            *latest = (uint32_t)(*entry_count)++;
            status = pair_up(phase, boxes, entry, pair_count, error);
        }
    return status;
}

cp_status cp_broad_phase_pairs(cp_broad_phase *phase, const cp_box *boxes, size_t count,
                               const cp_box_pair **pairs, size_t *pair_count, cp_error *error)
{
    size_t entry_count = 0, bucket_count = 0;
    *pair_count = 0;
    cp_status status = empty_buckets(phase, count, &bucket_count, error);
    for (size_t k = 0; k < count && status == CP_OK; k++)
        if (is_usable(&boxes[k]))
            status = enter(phase, boxes, k, bucket_count, &entry_count, pair_count, error);
    *pairs = phase->pair;
    return status;
}

void cp_broad_phase_destroy(cp_broad_phase *phase)
{
    free(phase->entry);
    free(phase->latest);
    free(phase->pair);
    *phase = (cp_broad_phase){0};
}
