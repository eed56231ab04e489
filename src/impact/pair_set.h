/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef IMPACT_PAIR_SET_H
#define IMPACT_PAIR_SET_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The unordered pairs of vehicle numbers seen so far. Zero-initialise, destroy. */
typedef struct cp_pair_set {
    uint64_t *slot; /* 0 = free; open addressing */
    size_t slot_count;
    size_t pair_count;
} cp_pair_set;

bool cp_pair_set_contains(const cp_pair_set *set, uint32_t one, uint32_t other);
/* Adding a pair again is fine; one and other differ. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_pair_set_add(cp_pair_set *set, uint32_t one, uint32_t other,
                                        cp_error *error);
void cp_pair_set_clear(cp_pair_set *set); /* forget all, keep the memory */
void cp_pair_set_destroy(cp_pair_set *set);

#endif
