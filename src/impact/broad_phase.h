/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef IMPACT_BROAD_PHASE_H
#define IMPACT_BROAD_PHASE_H

#include "core/error.h"

#include <stddef.h>
#include <stdint.h>

/* Which of many axis-parallel boxes overlap, in time linear in their number: a uniform grid, its
 * cells hashed into buckets. Boxes are expected to be a few cells large at most. */

typedef struct cp_box {
    double min_x_m, min_y_m, max_x_m, max_y_m;
} cp_box;

/* Indices of two boxes, first < second. */
typedef struct cp_box_pair {
    uint32_t first;
    uint32_t second;
} cp_box_pair;

/* A box's presence in one cell. */
typedef struct cp_grid_entry {
    int32_t cell_x;
    int32_t cell_y;
    uint32_t box;
    uint32_t earlier; /* the entry before it in its bucket; UINT32_MAX: none */
} cp_grid_entry;

/* Working memory, kept from call to call. Zero-initialise, destroy. */
typedef struct cp_broad_phase {
    cp_grid_entry *entry; /* in the order of the boxes */
    size_t entry_capacity;
    uint32_t *latest; /* of every bucket, the entry that came last; UINT32_MAX: none */
    size_t bucket_capacity;
    cp_box_pair *pair;
    size_t pair_capacity;
} cp_broad_phase;

/* Every pair of overlapping boxes (touching counts), each once, in an order that depends on the
 * boxes only. The array is the broad phase's, valid until the next call. A box with a coordinate
 * that is not finite, or beyond 1e9 m, overlaps nothing. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_broad_phase_pairs(cp_broad_phase *phase, const cp_box *boxes,
                                             size_t count, const cp_box_pair **pairs,
                                             size_t *pair_count, cp_error *error);
void cp_broad_phase_destroy(cp_broad_phase *phase);

#endif
