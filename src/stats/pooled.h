/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_POOLED_H
#define STATS_POOLED_H

#include "stats/sample.h"

/* Two samples in one ascending order, so that one walk gives every figure of a resample or of a
 * relabelling. */
typedef struct cp_pooled {
    const cp_sample *sample[2]; /* borrowed */
    size_t count;
    double *value;
    size_t *cluster;      /* numbered through: those of sample 0, then those of sample 1 */
    unsigned char *group; /* 0 or 1: the sample a value came from */
    double *sum;          /* of each cluster's values that are not censored */
    double *finite;       /* how many these are */
    double *size;         /* of each cluster, censored ones included */
} cp_pooled;

/* The caller destroys. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_pooled_create(const cp_sample *a, const cp_sample *b, cp_pooled *pooled,
                                         cp_error *error);
/* A zero-initialised one is fine too. */
void cp_pooled_destroy(cp_pooled *pooled);

/* How the second sample differs from the first in a resample, by what CP_POOLED_... names. NAN
 * where a figure does not exist, +-INFINITY where censoring leaves it open. */
enum {
    CP_POOLED_MEAN, /* b - a, of the values */
    CP_POOLED_MEDIAN,
    CP_POOLED_P90,
    CP_POOLED_CLIFFS_DELTA,
    CP_POOLED_COUNT
};

/* weight_a, weight_b: how often each cluster of a sample occurs; NULL: once. */
void cp_pooled_differences(const cp_pooled *pooled, const unsigned *weight_a,
                           const unsigned *weight_b, double difference[CP_POOLED_COUNT]);

/* Rank statistics of a labelling: label[c] is the group cluster c belongs to now. */
typedef struct cp_pooled_ranks {
    double u;     /* Mann-Whitney U of group 1: pairs in which it is higher, ties counted half */
    double shift; /* |U / (n0 n1) - 1/2|: how far from no difference */
    double ks;    /* largest distance of the two distribution functions */
} cp_pooled_ranks;

/* All NAN when a group has no observation. */
cp_pooled_ranks cp_pooled_rank(const cp_pooled *pooled, const unsigned char *label);

#endif
