/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/rng.h"

#include "core/units.h"

#include <math.h>
#include <string.h>

// Finaliser of SplitMix64 (Steele, Lea, Flood 2014): a bijection that spreads every bit.
static uint64_t mix(uint64_t z)
{
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

static const uint64_t GOLDEN_GAMMA = UINT64_C(0x9e3779b97f4a7c15);

cp_rng_key cp_rng_key_seed(uint64_t seed)
{
    return cp_rng_key_number((cp_rng_key){UINT64_C(0x243f6a8885a308d3)}, seed);
}

cp_rng_key cp_rng_key_number(cp_rng_key key, uint64_t number)
{
    return (cp_rng_key){mix(mix(key.value + GOLDEN_GAMMA) ^ mix(number * 2 + GOLDEN_GAMMA + 1))};
}

cp_rng_key cp_rng_key_text(cp_rng_key key, const char *text)
{
    // Eight bytes at a time, little end first, then the length.
    size_t length = strlen(text);
    for (size_t start = 0; start < length; start += 8) {
        uint64_t word = 0;
        for (size_t k = 0; k < 8 && start + k < length; k++)
            word |= (uint64_t)(unsigned char)text[start + k] << (8 * k);
        key = cp_rng_key_number(key, word);
    }
    return cp_rng_key_number(key, ~(uint64_t)length);
}

uint64_t cp_rng_bits(cp_rng_key key, uint64_t counter)
{
    return cp_rng_key_number(key, counter).value;
}

double cp_rng_uniform(cp_rng_key key, uint64_t counter)
{
    return (double)(cp_rng_bits(key, counter) >> 11) * 0x1p-53;
}

double cp_rng_exponential(cp_rng_key key, uint64_t counter, double mean)
{
    return -mean * log1p(-cp_rng_uniform(key, counter));
}

double cp_rng_normal(cp_rng_key key, uint64_t counter)
{
    // Box and Muller 1958; 1 - u keeps the logarithm's argument above zero.
    cp_rng_key pair = cp_rng_key_number(key, UINT64_C(0x6e6f726d616c));
    double u = cp_rng_uniform(pair, 2 * counter);
    double v = cp_rng_uniform(pair, 2 * counter + 1);
    return sqrt(-2.0 * log1p(-u)) * cos(2.0 * CP_PI * v);
}
