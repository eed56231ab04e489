/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_PERMUTATION_H
#define STATS_PERMUTATION_H

#include "stats/bootstrap.h"

/* Relabelling whole clusters (replications) between two groups, as if the variant did not matter.
 * Clusters are numbered through: those of group 0 first, then those of group 1. */
typedef struct cp_permutation {
    const cp_resampling *resampling; /* borrowed: counts, strata, pairing, seed */
    size_t cluster_count;            /* of both groups */
    unsigned char *label;            /* of each cluster: the group it belongs to now */
    size_t *member;                  /* clusters ordered by stratum */
    size_t *end;                     /* of each place: where its stratum ends */
} cp_permutation;

/* Starts with the labels as observed. The caller destroys. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_permutation_create(const cp_resampling *resampling,
                                              cp_permutation *permutation, cp_error *error);
/* A zero-initialised one is fine too. */
void cp_permutation_destroy(cp_permutation *permutation);

/* Relabel: permutation number 0 is the labels as observed, every other number a random one that
 * depends on seed and number only. */
void cp_permutation_set(cp_permutation *permutation, size_t number);

#endif
