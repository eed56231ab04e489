/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_RNG_H
#define CORE_RNG_H

#include <stdint.h>

/* Counter-based random numbers: a draw is a pure function of what it is for, never of call order.
 *
 *   cp_rng_key key = cp_rng_key_seed(study_seed);
 *   key = cp_rng_key_number(key, replication_seed);
 *   key = cp_rng_key_text(key, "failed_to_see");      model name
 *   key = cp_rng_key_text(key, ego_id);               vehicle ids
 *   double u = cp_rng_uniform(key, occasion);         occasion number
 *
 * so adding a vehicle, a variant or halving the step changes no other draw. */
typedef struct cp_rng_key {
    uint64_t value;
} cp_rng_key;

cp_rng_key cp_rng_key_seed(uint64_t seed);
cp_rng_key cp_rng_key_number(cp_rng_key key, uint64_t number);
/* The text's length takes part: ("ab","c") and ("a","bc") differ. */
cp_rng_key cp_rng_key_text(cp_rng_key key, const char *text);

/* 64 random bits of occasion number counter. */
uint64_t cp_rng_bits(cp_rng_key key, uint64_t counter);
/* Uniform in [0, 1) with 53 bits. */
double cp_rng_uniform(cp_rng_key key, uint64_t counter);
/* Exponential with mean mean (same unit out). */
double cp_rng_exponential(cp_rng_key key, uint64_t counter, double mean);
/* Standard normal (uses draws 2*counter and 2*counter+1 of a derived key). */
double cp_rng_normal(cp_rng_key key, uint64_t counter);

#endif
