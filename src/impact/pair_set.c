/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/pair_set.h"

#include <stdlib.h>
#include <string.h>

// The smaller number is the upper half, so the entry is never 0: two different numbers.
static uint64_t entry_of(uint32_t one, uint32_t other)
{
    uint32_t low = one < other ? one : other, high = one < other ? other : one;
    return (uint64_t)low << 32 | high;
}

// Slot that holds the entry, or the free one where it belongs.
static size_t slot_of(const uint64_t *slot, size_t slot_count, uint64_t entry)
{
    // Fibonacci hashing; slot_count is a power of two.
    size_t k = (size_t)((entry * UINT64_C(0x9e3779b97f4a7c15)) >> 32) & (slot_count - 1);
    while (slot[k] != 0 && slot[k] != entry)
        k = (k + 1) & (slot_count - 1);
    return k;
}

bool cp_pair_set_contains(const cp_pair_set *set, uint32_t one, uint32_t other)
{
    if (set->slot_count == 0)
        return false;
    uint64_t entry = entry_of(one, other);
    return set->slot[slot_of(set->slot, set->slot_count, entry)] == entry;
}

static cp_status grow(cp_pair_set *set, cp_error *error)
{
    size_t slot_count = set->slot_count == 0 ? 64 : 2 * set->slot_count;
    uint64_t *slot = calloc(slot_count, sizeof *slot);
    if (slot == NULL)
        return cp_fail_memory(error, "pairs of vehicles in contact");
    for (size_t k = 0; k < set->slot_count; k++)
        if (set->slot[k] != 0)
            slot[slot_of(slot, slot_count, set->slot[k])] = set->slot[k];
    free(set->slot);
    set->slot = slot;
    set->slot_count = slot_count;
    return CP_OK;
}

cp_status cp_pair_set_add(cp_pair_set *set, uint32_t one, uint32_t other, cp_error *error)
{
    // At most half full.
    if (2 * (set->pair_count + 1) > set->slot_count) {
        cp_status status = grow(set, error);
        if (status != CP_OK)
            return status;
    }
    uint64_t entry = entry_of(one, other);
    size_t k = slot_of(set->slot, set->slot_count, entry);
    set->pair_count += set->slot[k] == 0;
    set->slot[k] = entry;
    return CP_OK;
}

void cp_pair_set_clear(cp_pair_set *set)
{
    if (set->pair_count > 0)
        memset(set->slot, 0, set->slot_count * sizeof *set->slot);
    set->pair_count = 0;
}

void cp_pair_set_destroy(cp_pair_set *set)
{
    free(set->slot);
    *set = (cp_pair_set){0};
}
