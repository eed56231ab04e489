/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_POOLED_H
#define STATS_POOLED_H

#include "stats/bootstrap.h"
#include "stats/describe.h"
#include "stats/sample.h"

#include <stdint.h>

/* Two samples in one ascending order, so that one walk gives every figure of a resample.
 *
 * Where their clusters come from several strata (scenarios), each sample is weighted so that both
 * have the same mix of strata: n_a n_b / (n_a + n_b) for a stratum with n_a and n_b observations,
 * none for one that either sample lacks. Unlike strata then make no difference where there is none
 * within them. With one stratum every observation counts once. */
typedef struct cp_pooled {
    const cp_sample *sample[2]; /* borrowed */
    size_t count;
    double *value;
    uint32_t *cluster;    /* numbered through: those of sample 0, then those of sample 1 */
    unsigned char *group; /* 0 or 1: the sample a value came from */
    double *size;         /* of each cluster, censored ones included */
    size_t strata;
    size_t *stratum;  /* of each cluster */
    double *factor;   /* room for the weight of an observation of each stratum of each sample */
    double *times;    /* room for how much an observation of each cluster counts */
    double lowest[2]; /* smallest value of each sample that is not censored; NAN without */
} cp_pooled;

/* stratum_a, stratum_b: of each cluster, NULL: one for all. The caller destroys. Error:
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_pooled_create(const cp_sample *a, const cp_sample *b,
                                         const size_t *stratum_a, const size_t *stratum_b,
                                         cp_pooled *pooled, cp_error *error);
/* A zero-initialised one is fine too. */
void cp_pooled_destroy(cp_pooled *pooled);

/* Figures of either sample in a resample, by what CP_POOLED_... names. */
enum {
    CP_POOLED_MEAN, /* NAN when an observation is censored */
    CP_POOLED_MEDIAN,
    CP_POOLED_P90,
    CP_POOLED_COUNT
};

/* How sample b differs from sample a: NAN where a figure does not exist, +-INFINITY where censoring
 * leaves it open. weight_a, weight_b: how often each cluster of a sample occurs; NULL: once. Uses
 * the room of pooled. */
void cp_pooled_differences(const cp_pooled *pooled, const unsigned *weight_a,
                           const unsigned *weight_b, double difference[CP_POOLED_COUNT]);

/* The same figures of sample 0 or 1 as observed; censoring leaves a mean known from above only, as
 * censored observations lie below every value. */
cp_estimate cp_pooled_estimate(const cp_pooled *pooled, int sample, int figure);

/* Observations of a sample in strata where the other has some too. */
size_t cp_pooled_compared(const cp_pooled *pooled, int sample);

/* Largest distance of the two distribution functions, of a resample from which the difference of
 * the functions as observed is taken when centred; NAN when a group has no observation. */
double cp_pooled_distance(const cp_pooled *pooled, const unsigned *weight_a,
                          const unsigned *weight_b, const double *centre);

/* The difference of the two functions as observed after each value, written to centre[0 ... count -
 * 1]. */
void cp_pooled_centre(const cp_pooled *pooled, double *centre);

#endif
